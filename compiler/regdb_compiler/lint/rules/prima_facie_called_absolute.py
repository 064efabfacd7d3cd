"""A limit that the law's words call prima facie is marked absolute, or the reverse.

Why:
    A prima facie limit can be rebutted, an absolute one cannot. A planner obeys both; a report that names the wrong kind is wrong law.

Fails:
    quote: the prima facie speed limit is 25 miles per hour
    attributes: {max_speed: 25 mph}
    force: absolute

Passes:
    quote: the prima facie speed limit is 25 miles per hour
    attributes: {max_speed: 25 mph}
    force: prima_facie
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.view import View, view_of

CODE, NAME = "R314", "prima-facie-called-absolute"
LEVEL: Level = "error"
_PRIMA_FACIE = re.compile(r"(?<!not )(?<!no )\bprima[ -]facie\b", re.IGNORECASE)
_ABSOLUTE = re.compile(r"(?<!not )\babsolute\b|\birrebuttable\b|\bmaximum speed limit\b", re.IGNORECASE)

STEMS = ("prima", "absolute", "rebuttable", "maximum speed limit")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each limit whose own words, title or passage name the other kind."""
    view = view_of(build)
    for rule in view.first:
        entry, force = rule.entry, rule.entry.doc.force or "absolute"
        if not rule.limits or force not in {"absolute", "prima_facie"}:
            continue
        said = _said(view, entry)
        if said and said != force:
            place = entry.place("force") if entry.doc.force else entry.key_place("attributes")
            written = f"`force` is {force}" if entry.doc.force else "without `force` it is compiled as absolute"
            message = f"the words call this limit {said.replace('_', ' ')}, but {written}"
            yield Diagnostic(CODE, NAME, LEVEL, message, place, note=f"force: {said}", law=str(entry.citation))


def _said(view: View, entry: RegulationEntry) -> str:
    """The kind that the words name: the regulation's own first, then the title's, then those of its passage; empty for none or both."""
    doc = entry.doc
    own = f"{doc.condition.text} {doc.result} {doc.quote}"
    for text in (own, entry.section.doc.title, view.passage(entry)):
        low = text.lower()
        if not any(stem in low for stem in STEMS):
            continue
        prima_facie, absolute = _PRIMA_FACIE.search(text), _ABSOLUTE.search(text)
        if prima_facie and absolute:
            return ""
        if prima_facie or absolute:
            return "prima_facie" if prima_facie else "absolute"
    return ""
