"""A condition negates a negation.

Why:
    `not not x` is `x`. A reader counts the negations and may count wrongly.

Fails:
    condition: {when: not not children.present}

Passes:
    condition: {when: children.present}

Fix (safe):
    Takes both out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.edits import replace_words

CODE, NAME = "R441", "double-negation"
LEVEL: Level = "warning"
_DOUBLE = re.compile(r"(?<![\w.])not\s+not\s+(?!not\b)")
_INSIDE = re.compile(r"(?<![\w.])not\s*\(\s*not\s+(?P<inner>[\w.]+)\s*\)")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each pair of negations without anything between them."""
    for entry in build.corpus.regulations:
        for key, text in (("when", entry.doc.condition.when), ("unless", entry.doc.condition.unless)):
            if text.count("not") < 2:
                continue
            for match in (_DOUBLE.search(text), _INSIDE.search(text)):
                if match:
                    inner = match.groupdict().get("inner", "")
                    edit = replace_words(entry.field("condition", key), match.start(), match.end(), inner)
                    fix = Fix("safe", "take both negations out", (edit,)) if edit else None
                    place = entry.text_place(match.start(), match.end(), "condition", key)
                    yield Diagnostic(CODE, NAME, LEVEL, "two negations cancel out", place, law=str(entry.citation), fix=fix)
