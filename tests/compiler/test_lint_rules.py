"""Every lint rule is registered, has a whole page, and its page's examples do what they say."""

from pathlib import Path

import pytest
from regdb_compiler.driver import build
from regdb_compiler.lint import rules
from regdb_compiler.lint.catalogue import READING_RULES, catalogue
from regdb_compiler.lint.example import build_example, find_in_example, read_example
from regdb_compiler.lint.reading_examples import READING_EXAMPLES
from regdb_compiler.lint.registry import MODULES, shipped_rules
from regdb_compiler.lint.rule import Rule
from regdb_compiler.lint.run import find, lint
from regdb_compiler.lint.view import view_of

RULES = shipped_rules()
HARD_TO_SHOW = {"R002", "R010", "R110", "R412", "R420", "R903", "R905"}


def ids(rule: Rule) -> str:
    return rule.name


def test_no_rule_is_forgotten() -> None:
    files = {path.stem for path in Path(rules.__file__).parent.glob("*.py")} - {"__init__"}
    assert files == {module.__name__.rpartition(".")[2] for module in MODULES}


def test_a_rule_is_called_like_its_file() -> None:
    for rule in RULES:
        assert rule.origin.rpartition(".")[2].replace("_", "-") == rule.name


def test_codes_and_names_are_given_once() -> None:
    listed = catalogue(RULES)
    assert len({item.code for item in listed}) == len({item.name for item in listed}) == len(listed)
    assert len(listed) == len(RULES) + len(READING_RULES)


def test_rules_stand_in_the_registry_by_code() -> None:
    codes = [rule.code for rule in RULES]
    assert codes == sorted(codes)


def test_there_are_enough_rules_and_safe_fixes() -> None:
    assert len(RULES) >= 45
    assert len([rule for rule in RULES if rule.page.fix_kind == "safe"]) >= 8


@pytest.mark.parametrize("rule", RULES, ids=ids)
def test_a_page_is_whole(rule: Rule) -> None:
    page = rule.page
    assert page.summary.endswith(".")
    assert page.why
    assert page.fails
    assert page.passes
    assert bool(page.fix) == bool(page.fix_kind)
    assert all(len(line) <= 140 for line in rule.text.splitlines())


@pytest.mark.parametrize("rule", RULES, ids=ids)
def test_what_fails_fails(rule: Rule, tmp_path: Path) -> None:
    found = find_in_example(rule, rule.page.fails, tmp_path)
    assert found
    assert {(item.code, item.name, item.level) for item in found} == {(rule.code, rule.name, rule.level)}
    kinds = {item.fix.kind for item in found if item.fix is not None}
    assert kinds == ({rule.page.fix_kind} if rule.page.fix_kind else set())


@pytest.mark.parametrize("rule", RULES, ids=ids)
def test_what_passes_passes(rule: Rule, tmp_path: Path) -> None:
    assert find_in_example(rule, rule.page.passes, tmp_path) == []
    assert [item for item in build(tmp_path / "codes").diagnostics if item.level == "error"] == []


def test_the_small_world_is_clean(tmp_path: Path) -> None:
    clean = build_example({"append": ""}, tmp_path)
    found = lint(clean, rules=RULES)
    assert {(item.code, item.message) for item in found} == {("R923", "the file names no schema")}


@pytest.mark.parametrize("code", sorted(READING_EXAMPLES))
def test_what_reading_reports_is_reported(code: str, tmp_path: Path) -> None:
    found = lint(build_example(read_example(READING_EXAMPLES[code]), tmp_path), rules=())
    assert code in {item.code for item in found}


def test_what_reading_reports_has_an_example_wherever_one_can_be_shown() -> None:
    assert {code for code, _, _ in READING_RULES} - set(READING_EXAMPLES) == HARD_TO_SHOW


def test_levels_of_what_reading_reports_are_told_right(tmp_path: Path) -> None:
    levels = {item.code: item.level for item in catalogue(())}
    for code, example in READING_EXAMPLES.items():
        for item in lint(build_example(read_example(example), tmp_path / code), rules=()):
            assert levels[item.code] == item.level


def test_findings_stand_in_the_example(tmp_path: Path) -> None:
    for rule in RULES:
        example = build_example(read_example(rule.page.fails), tmp_path / rule.name)
        for item in find(example, [rule]):
            lines = example.corpus.texts[item.place.path].split("\n")
            assert 1 <= item.place.line <= len(lines)
            assert item.place.column <= len(lines[item.place.line - 1]) + 1


def test_the_view_is_made_once_for_a_build(tmp_path: Path) -> None:
    clean = build_example({"append": ""}, tmp_path)
    assert view_of(clean) is view_of(clean)
