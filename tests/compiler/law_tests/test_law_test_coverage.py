"""Coverage: what passed tests have shown of rules, branches and states, and where the rest stands."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from regdb_compiler.driver import Build
from regdb_compiler.law_tests.coverage import Coverage, cover
from regdb_compiler.law_tests.coverage_text import coverage_text
from regdb_compiler.law_tests.judge import judge_tests
from regdb_compiler.law_tests.to_json import coverage_data

Builder = Callable[..., Build]


def covered(found: Build) -> Coverage:
    return cover(found, tuple(judge_tests(found, found.law_tests)))


def missing(found: Coverage, name: str) -> set[str]:
    """What no test has shown of a regulation, of a version in force now."""
    return {item.what for row, item in found.uncovered if row.regulation.id == name and row.regulation.until is None}


def test_what_is_shown_and_what_is_not(built: Builder) -> None:
    found = covered(built())
    assert {name: missing(found, name) for name in ("sc-10-a", "sc-10-b", "sc-11-a", "sc-12-a", "tc-1-a")} == {
        "sc-10-a": set(),
        "sc-10-b": {"when never false: stopped", "unless never true: sign.no_turn"},
        "sc-11-a": set(),
        "sc-12-a": set(),
        "tc-1-a": {"never fails to hold", "when never false: school", "never below max_speed: 20 mph"},
    }


def test_a_version_that_nothing_could_displace_is_not_asked_for_it(built: Builder) -> None:
    old = next(row for row in covered(built()).rows if row.regulation.id == "sc-11-a" and row.regulation.until is not None)
    assert {item.what for item in old.items if item.kind == "rule"} == {"never holds", "never broken"}


@pytest.mark.parametrize(
    ("change", "name", "what"),
    [
        (("sc/10.yaml", "{name: at green, scene: {signal.color: green}", "{name: at green, scene: {signal.color: red, officer: true}"),
         "sc-10-a", "when never false: signal.color == red"),
        (("sc/11.yaml", "{name: at the limit, plan: {speed: 40 mph}", "{name: at the limit, plan: {speed: 39 mph}"),
         "sc-11-a", "never at max_speed: 40 mph"),
        (("sc/10.yaml", "plan: {current: stop, next: go_straight}", "plan: {current: stop, next: turn_right}"),
         "sc-10-a", "never tested: intersection_handling -> go_straight"),
    ],
)  # fmt: skip
def test_a_test_less_shows_less(built: Builder, change: tuple[str, str, str], name: str, what: str) -> None:
    assert what not in missing(covered(built()), name)
    assert what in missing(covered(built(change)), name)


def test_a_failed_test_shows_nothing(built: Builder) -> None:
    found = built(("sc/11.yaml", "plan: {speed: 40 mph}, expect: legal", "plan: {speed: 40 mph}, expect: illegal"))
    assert "never at max_speed: 40 mph" in missing(covered(found), "sc-11-a")


def test_places_are_those_of_the_literals(built: Builder) -> None:
    found = built()
    items = {item.what: item for row in covered(found).rows if row.regulation.id == "sc-10-b" for item in row.items}
    place = items["unless never true: sign.no_turn"].place
    line = found.corpus.texts[place.path].split("\n")[place.line - 1]
    assert line[place.column - 1 : place.end_column - 1] == "sign.no_turn"


def test_counts_add_up(built: Builder) -> None:
    found = covered(built())
    done, everything = found.count()
    assert done == sum(found.count(code, kind)[0] for code in found.codes for kind in ("rule", "branch", "state"))
    assert everything - done == len(found.uncovered)
    assert found.percent == pytest.approx(100 * done / everything)
    data = coverage_data(found)
    assert len(data["uncovered"]) == len(found.uncovered)
    assert set(data["codes"]) == {"sc", "tc"}


def test_without_anything_to_cover_all_is_covered() -> None:
    assert Coverage(()).percent == 100.0
    assert coverage_text(Coverage(())).startswith("code")


def test_the_table_fits_80_columns_and_names_places(built: Builder) -> None:
    text = coverage_text(covered(built()))
    assert all(len(line) <= 80 for line in text.splitlines())
    assert "codes/sc/10.yaml:29: sc-10-b: unless never true: sign.no_turn" in text
