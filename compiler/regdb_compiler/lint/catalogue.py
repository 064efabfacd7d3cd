"""Everything `regdb` can find: the lint rules with their pages, and what reading and resolving report, with pages of the same form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

from regdb_compiler.authority import AUTHORITY_RULES
from regdb_compiler.baseline import BASELINE_RULES
from regdb_compiler.definitions import DEFINITION_RULES
from regdb_compiler.diagnostics import Level, RuleText
from regdb_compiler.law_tests.read import LAW_TEST_RULES
from regdb_compiler.lint.page import Page
from regdb_compiler.lint.reading_examples import READING_EXAMPLES
from regdb_compiler.lint.registry import all_rules
from regdb_compiler.lint.rule import Rule
from regdb_compiler.parse import PARSE_RULES
from regdb_compiler.parse_condition import CONDITION_RULES
from regdb_compiler.precedence import PRECEDENCE_RULES
from regdb_compiler.read_corpus import CORPUS_RULES
from regdb_compiler.read_fusion import FUSION_RULES
from regdb_compiler.read_interpretations import INTERPRETATION_RULES
from regdb_compiler.read_vocabulary import VOCABULARY_RULES
from regdb_compiler.resolve import RESOLVE_RULES
from regdb_compiler.source import SOURCE_RULES
from regdb_compiler.suppression import SUPPRESSION_RULES
from regdb_compiler.timeline import TIMELINE_RULES

READING_RULES: tuple[RuleText, ...] = (
    *SOURCE_RULES, *PARSE_RULES, *CONDITION_RULES, *CORPUS_RULES, *VOCABULARY_RULES, *FUSION_RULES, *INTERPRETATION_RULES, *DEFINITION_RULES,
    *RESOLVE_RULES, *TIMELINE_RULES, *PRECEDENCE_RULES, *AUTHORITY_RULES, *LAW_TEST_RULES, *SUPPRESSION_RULES, *BASELINE_RULES,
)  # fmt: skip
"""What is no lint rule but reported beside them: it stops compiling, unless it is about comments, the baseline or a gap."""

MILDER: dict[str, Level] = {"R505": "warning", "R901": "warning", "R902": "warning", "R903": "info", "R904": "warning"}
FIXED: dict[str, str] = {"R013": "safe", "R902": "safe"}
FAMILIES = {
    "R0": "syntax and schema", "R1": "identity, citation, source", "R2": "text and annotation", "R3": "quantities",
    "R4": "facts and states", "R5": "time", "R6": "authority, exceptions, overrides", "R7": "vagueness and review",
    "R8": "tests and coverage", "R9": "hygiene",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Listed:
    """One thing that can be found. `origin` is the module that finds it, `is_lint` whether that is a lint rule."""

    code: str
    name: str
    level: Level
    page: Page
    origin: str
    is_lint: bool

    @property
    def family(self) -> str:
        return FAMILIES.get(self.code[:2], "other packages")


def catalogue(rules: Sequence[Rule] | None = None) -> tuple[Listed, ...]:
    """All of them by code. Raises RuleError when an installed package's rule is none."""
    lint = [Listed(r.code, r.name, r.level, r.page, r.origin, is_lint=True) for r in (all_rules() if rules is None else rules)]
    return tuple(sorted((*map(_reading, READING_RULES), *lint), key=lambda item: item.code))


def _reading(rule: RuleText) -> Listed:
    code, name, sentence = rule
    example = READING_EXAMPLES.get(code, "")
    level: Level = MILDER.get(code, "error")
    assert level in get_args(Level)
    why = "Reported while the codes are read and resolved."
    if level == "error":
        why += " What has this error is not compiled."
    return Listed(code, name, level, Page(sentence, why, example.strip("\n"), "", "", FIXED.get(code, "")), _origin(rule), is_lint=False)


def _origin(rule: RuleText) -> str:
    tables = {"source": SOURCE_RULES, "parse": PARSE_RULES, "parse_condition": CONDITION_RULES, "corpus": CORPUS_RULES,
              "read_vocabulary": VOCABULARY_RULES, "read_fusion": FUSION_RULES,
              "read_interpretations": INTERPRETATION_RULES, "definitions": DEFINITION_RULES,
              "resolve": RESOLVE_RULES, "timeline": TIMELINE_RULES,
              "precedence": PRECEDENCE_RULES, "authority": AUTHORITY_RULES, "law_tests.read": LAW_TEST_RULES, "suppression": SUPPRESSION_RULES,
              "baseline": BASELINE_RULES}  # fmt: skip
    return "regdb_compiler." + next(name for name, table in tables.items() if rule in table)
