"""Which rules are wanted: codes, names, and families or any beginning of a code (`R6`, `R31`)."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.lint.rule import Rule


class UnknownRuleError(ValueError):
    """A word that selects no rule; the message names the nearest."""


@dataclass(frozen=True, slots=True)
class Selection:
    """Rules selected (all, when none are named) and not ignored."""

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()

    @property
    def is_everything(self) -> bool:
        return not self.select and not self.ignore

    def takes(self, code: str, name: str) -> bool:
        """Whether findings of a rule are wanted."""
        wanted = not self.select or any(_means(word, code, name) for word in self.select)
        return wanted and not any(_means(word, code, name) for word in self.ignore)

    def always(self, finding: Diagnostic) -> bool:
        """What cannot be read is told whatever was selected: nothing else can be trusted then."""
        return finding.level == "error" and finding.code.startswith("R0")

    def of(self, rules: Iterable[Rule]) -> tuple[Rule, ...]:
        return tuple(rule for rule in rules if self.takes(rule.code, rule.name))

    def check(self, known: Iterable[tuple[str, str]]) -> None:
        """Raises UnknownRuleError for the first word that means none of the known (code, name)."""
        pairs = tuple(known)
        for word in (*self.select, *self.ignore):
            if not any(_means(word, code, name) for code, name in pairs):
                raise UnknownRuleError(f"no lint rule is called `{word}`{nearest(word, pairs)}")


def _means(word: str, code: str, name: str) -> bool:
    return word.lower() == name or (code.startswith(word.upper()) and word.isalnum())


def nearest(word: str, known: Iterable[tuple[str, str]]) -> str:
    """`; did you mean ...?` with the nearest codes or names, or nothing."""
    words = {text.lower(): text for pair in known for text in pair}
    near = [words[found] for found in difflib.get_close_matches(word.lower(), words, 3, 0.6)]
    return f"; did you mean {' or '.join(near)}?" if near else "; `regdb rule` lists them"
