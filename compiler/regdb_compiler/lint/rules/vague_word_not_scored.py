"""The quote or the condition's words leave something to judgement, but the vagueness is 0.

Why:
    Open texture is declared: what is reasonable, safe or practicable is decided by an interpretation, and a report lists where.

Fails:
    condition: {text: A lane change cannot be made with reasonable safety.}

Passes:
    condition: {text: A lane change cannot be made with reasonable safety.}
    vagueness: {score: 2, because: '"reasonable safety" is a judgement'}
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R701", "vague-word-not-scored"
LEVEL: Level = "warning"
_VAGUE = re.compile(r"\b(?:un)?(?:reasonabl[ey]|safe(?:ly)?|practicabl[ey]|due care|prudent|due regard|caution)\b", re.IGNORECASE)

STEMS = ("reasonab", "safe", "practicab", "due care", "prudent", "due regard", "caution")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each regulation, at its first vague word."""
    for entry in build.corpus.regulations:
        doc = entry.doc
        if doc.vagueness.score:
            continue
        for path, text in ((("condition", "text"), doc.condition.text), (("quote",), doc.quote)):
            low = text.lower()
            match = _VAGUE.search(text) if any(stem in low for stem in STEMS) else None
            if match:
                message = f"`{match[0]}` is a judgement, but the vagueness is 0"
                place = entry.text_place(match.start(), match.end(), *path)
                help_ = "vagueness: {score: 1, because: ...}"
                yield Diagnostic(CODE, NAME, LEVEL, message, place, help=help_, law=str(entry.citation))
                break
