"""The cases of every lint rule: what fails, what passes, and what the fix makes of what fails."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.driver import build as read
from regdb_compiler.fixes import apply_fixes
from regdb_compiler.lint.example import Example, build_example, read_example, write_example
from regdb_compiler.lint.registry import shipped_rules
from regdb_compiler.lint.rule import Rule

FOLDER = Path(__file__).parent / "lint_cases"
RULES = {rule.name: rule for rule in shipped_rules()}


def cases(part: str) -> Iterator[Any]:
    for path in sorted(FOLDER.glob("*.yaml")):
        for position, example in enumerate(read_example(path.read_text("utf-8"))[part]):
            yield pytest.param(RULES[path.stem], example, id=f"{path.stem}-{position + 1}")


def fixes() -> Iterator[Any]:
    for path in sorted(FOLDER.glob("*.yaml")):
        told = read_example(path.read_text("utf-8"))
        for position, after in enumerate(told.get("fixed", ())):
            yield pytest.param(RULES[path.stem], told["fails"][position], after, id=f"{path.stem}-{position + 1}")


def found(rule: Rule, example: Example, folder: Path) -> list[Diagnostic]:
    return list(rule.check(build_example(example, folder)))


def test_every_rule_has_cases() -> None:
    assert {path.stem for path in FOLDER.glob("*.yaml")} == set(RULES)


def test_every_fixable_rule_has_a_fixed_case() -> None:
    for name, rule in RULES.items():
        told = read_example((FOLDER / f"{name}.yaml").read_text("utf-8"))
        assert set(told) <= {"fails", "passes", "fixed"}
        assert bool(told.get("fixed")) == (rule.page.fix_kind in {"safe", "unsafe"})


@pytest.mark.parametrize(("rule", "example"), list(cases("fails")))
def test_fails(rule: Rule, example: Example, tmp_path: Path) -> None:
    assert {item.code for item in found(rule, example, tmp_path)} == {rule.code}


@pytest.mark.parametrize(("rule", "example"), list(cases("passes")))
def test_passes(rule: Rule, example: Example, tmp_path: Path) -> None:
    assert found(rule, example, tmp_path) == []


@pytest.mark.parametrize(("rule", "before", "after"), list(fixes()))
def test_fixed(rule: Rule, before: Example, after: Example, tmp_path: Path) -> None:
    build = build_example(before, tmp_path / "before")
    result = apply_fixes(rule.check(build), build.corpus.texts, ("safe", "unsafe"))
    assert result.applied
    write_example(after, tmp_path / "after")
    for path, text in result.texts.items():
        assert content(text) == content((tmp_path / "after" / path).read_text("utf-8"))
        (tmp_path / "before" / path).write_text(text, "utf-8", newline="")
    assert [item for item in rule.check(read(tmp_path / "before" / "codes")) if item.fix is not None] == []


def content(text: str) -> Any:
    """What a reader of YAML sees, and the comment at the end."""
    comment = text[text.rindex("#") :] if "\n#" in text else ""
    return yaml.load(text, Loader=yaml.BaseLoader), comment if "yaml-language" not in comment else ""
