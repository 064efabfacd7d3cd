"""What a section lets local authorities do is written as if it bound everybody already.

Why:
    "A local authority may, by ordinance, declare 25 mph" binds nobody until one has done so and put up the sign. The paper reads
    CVC 22358.4 as a rule of its own. The section's part in it is `delegates`; the limit is the local authority's.

Fails:
    text: (a) A local authority may, by ordinance, declare a prima facie limit of 25 mph within 1,000 feet of a school.
    condition: {text: "Within 1,000 feet of a school.", when: school.distance <= 1000 ft}
    attributes: {max_speed: 25 mph}
    force: prima_facie

Passes:
    text: (a) A local authority may, by ordinance, declare a prima facie limit of 25 mph within 1,000 feet of a school.
    condition: {text: "Within 1,000 feet of a school.", when: school.distance <= 1000 ft}
    attributes: {max_speed: 25 mph}
    force: prima_facie
    requires_sign: sign.speed_limit
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level, Place
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.view import View, view_of
from regdb_compiler.resolve import Resolved

CODE, NAME = "R620", "delegation-as-rule"
LEVEL: Level = "error"
_BY_ACT = re.compile(
    r"\b(?:local authorit(?:y|ies)|cit(?:y|ies)(?: (?:or|and) count(?:y|ies))?|count(?:y|ies))\b[^.;]{0,120}?\bmay\b[^.;]{0,60}?"
    r"\b(?:by (?:ordinance|resolution|local act|rule)|declare|adopt|establish|determine)"
    r"|\bby ordinance or resolution,? (?:determine|declare|adopt|establish)",
    re.IGNORECASE,
)


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such prohibition of a code that is not local: it asks for no sign, no posted number and no local act."""
    view = view_of(build)
    for rule in view.first:
        entry = rule.entry
        if entry.jurisdiction.is_local or entry.doc.legality or not rule.limits or entry.doc.requires_sign or _asks_for_act(view, rule):
            continue
        where = _delegated(view, rule) or _said(view, entry)
        if where is not None:
            message = f"{entry.id} binds by itself what the section only lets local authorities do"
            help_ = "write it under `delegates`; here ask for the local act's fact, or `requires_sign`"
            related = ((where, "the delegation"),)
            yield Diagnostic(CODE, NAME, LEVEL, message, entry.place("id"), help=help_, related=related, law=str(entry.citation))


def _asks_for_act(view: View, rule: Resolved) -> bool:
    """Whether the rule hangs on a sign, a posted number or a local act."""
    facts = view.rule_facts(rule)
    return any(name.startswith(("sign.", "posted.")) or "local" in name or name.endswith("_act") for name in facts)


def _delegated(view: View, rule: Resolved) -> Place | None:
    """Where the version delegates this very matter: the same attribute, and the passage of the rule itself says so or there is no other."""
    entry = rule.entry
    attributes = {limit.attribute for limit in rule.limits}
    for position, doc in enumerate(entry.version.doc.delegates):
        passage = view.passage(entry)
        if doc.attribute in attributes and ("local authorit" in passage.lower() or len(view.passages(entry.version)) == 1):
            return entry.version.place("delegates", position)
    return None


def _said(view: View, entry: RegulationEntry) -> Place | None:
    """Where words of the rule, or the only passage it can rest on, say that a local authority may."""
    for path, text in ((("condition", "text"), entry.doc.condition.text), (("quote",), entry.doc.quote)):
        if _BY_ACT.search(text):
            return entry.place(*path)
    return entry.version.place("text") if _BY_ACT.search(view.passage(entry)) else None
