"""Findings are selected, allowed by comments and baselines, judged on a day; rules of other packages run beside ours."""

import datetime
import types
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest
from regdb_compiler import baseline
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.driver import Build
from regdb_compiler.lint.example import build_example, read_example
from regdb_compiler.lint.registry import all_rules, shipped_rules
from regdb_compiler.lint.rule import Rule, RuleError, rule_of
from regdb_compiler.lint.run import RuleFailureError, costs, find, lint
from regdb_compiler.lint.selection import Selection, UnknownRuleError

WRONG = """
attributes: {max_speed: 25 mph}
condition: {when: children.present == true and not not sign.school}
"""


def wrong(folder: Path, **more: Any) -> Build:
    return build_example({**read_example(WRONG), **more}, folder)


def codes(found: tuple[Diagnostic, ...]) -> set[str]:
    return {item.code for item in found}


def foreign(check: Any, code: str = "ACME101", name: str = "acme-offence") -> types.ModuleType:
    module = types.ModuleType("acme_rules", "A rule of another package.")
    module.CODE, module.NAME, module.LEVEL, module.check = code, name, "warning", check  # type: ignore[attr-defined]
    return module


def one_finding(build: Build) -> Iterator[Diagnostic]:
    yield Diagnostic("ACME101", "acme-offence", "warning", f"{len(build.corpus.sections)} sections", Place("codes/st/100.yaml", 1, 1, 1, 2))


def test_codes_names_and_families_select(tmp_path: Path) -> None:
    build = wrong(tmp_path)
    assert {"R310", "R441", "R442"} <= codes(lint(build))
    assert codes(lint(build, ["R310"])) == {"R310"}
    assert codes(lint(build, ["limit-without-force"])) == {"R310"}
    assert codes(lint(build, ["R4"])) == {"R441", "R442"}
    assert codes(lint(build, ["R4", "R310"], ["double-negation"])) == {"R310", "R442"}
    assert not codes(lint(build, (), ["R4"])) & {"R441", "R442"}


def test_what_cannot_be_read_is_always_told(tmp_path: Path) -> None:
    build = build_example({"legallity": "false"}, tmp_path)
    assert codes(lint(build, ["R9"], ["R013"])) >= {"R013"}


def test_a_rule_that_is_not_there_is_named_with_its_nearest() -> None:
    known = [(rule.code, rule.name) for rule in shipped_rules()]
    with pytest.raises(UnknownRuleError, match="limit-without-force"):
        Selection(("limit-without-forse",)).check(known)
    with pytest.raises(UnknownRuleError, match="regdb rule"):
        Selection((), ("zzz",)).check(known)
    Selection(("R3", "r310", "double-negation"), ("R44",)).check(known)


def test_comments_allow_findings_of_rules(tmp_path: Path) -> None:
    build = wrong(tmp_path, append="# regdb: allow-file R310, double-negation -- as an example\n")
    assert not codes(lint(build)) & {"R310", "R441", "R902"}
    unused = wrong(tmp_path / "unused", append="# regdb: allow-file R112 -- there is none\n")
    assert "R902" in codes(lint(unused))
    assert "R902" not in codes(lint(unused, ["R4"]))


def test_a_baseline_lets_known_findings_be(tmp_path: Path) -> None:
    build = wrong(tmp_path)
    path = tmp_path / "baseline.json"
    baseline.write(path, lint(build), build.corpus.texts)
    assert lint(build, baseline=baseline.read(path)) == ()


def test_rules_about_time_judge_on_the_day_asked_for(tmp_path: Path) -> None:
    build = build_example(read_example("versions: [{effective: 2030-01-01}]"), tmp_path)
    assert codes(lint(build, ["R510"], today=datetime.date(2029, 12, 31))) == {"R510"}
    assert codes(lint(build, ["R510"], today=datetime.date(2030, 1, 1))) == set()
    assert codes(lint(build, ["R119"], today=datetime.date(2030, 1, 1))) == {"R119"}


def test_the_order_of_rules_changes_nothing(tmp_path: Path) -> None:
    build = wrong(tmp_path)
    assert find(build, shipped_rules()) == find(build, tuple(reversed(shipped_rules())))


def test_another_packages_rule_runs_beside_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EntryPoint, "load", lambda _: foreign(one_finding))
    rules = all_rules([EntryPoint("acme", "acme_rules", "regdb.lint_rules")])
    assert [rule.code for rule in rules][-1] == "ACME101"
    assert "ACME101" in codes(lint(wrong(tmp_path), rules=rules))


def test_another_package_cannot_take_a_code(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EntryPoint, "load", lambda _: [foreign(one_finding, "R310")])
    with pytest.raises(RuleError, match="R310"):
        all_rules([EntryPoint("acme", "acme_rules", "regdb.lint_rules")])


def test_a_package_that_cannot_be_loaded_is_named() -> None:
    with pytest.raises(RuleError, match="acme"):
        all_rules([EntryPoint("acme", "no_such_module_of_acme", "regdb.lint_rules")])


@pytest.mark.parametrize(
    ("missing", "told"), [("CODE", "CODE"), ("NAME", "NAME"), ("LEVEL", "LEVEL"), ("check", "check")]
)
def test_a_module_that_is_no_rule_says_what_it_lacks(missing: str, told: str) -> None:
    module = foreign(one_finding)
    delattr(module, missing)
    with pytest.raises(RuleError, match=told):
        rule_of(module)


def test_a_rule_that_fails_is_named(tmp_path: Path) -> None:
    def broken(build: Build) -> Iterator[Diagnostic]:
        raise KeyError(build.corpus.root.name)
        yield

    with pytest.raises(RuleFailureError, match="ACME101 acme-offence"):
        lint(wrong(tmp_path), rules=[rule_of(foreign(broken))])


def test_costs_name_every_rule_dearest_first(tmp_path: Path) -> None:
    build = wrong(tmp_path)
    found = costs(build, shipped_rules())
    assert {rule for _, rule in found} == set(shipped_rules())
    assert [seconds for seconds, _ in found] == sorted((seconds for seconds, _ in found), reverse=True)


def test_rules_are_values() -> None:
    assert all(isinstance(rule, Rule) and rule.page.summary for rule in all_rules(()))
