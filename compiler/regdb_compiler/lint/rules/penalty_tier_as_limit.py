"""The threshold of an aggravated offence is written as if it were a speed limit.

Why:
    "Over 100 mph" is punished harder than over 65. Read as a limit it calls 99 mph lawful. Table I of the paper has such a row
    (CVC 22348(b)). A penalty tier is no limit to plan by and never loosens one.

Fails:
    condition: {text: Driving over 100 mph is an infraction punishable by a fine., when: null}
    attributes: {max_speed: 100 mph, road_type: highway}
    force: absolute

Passes:
    condition: {text: Driving over 100 mph is an infraction punishable by a fine., when: null}
    attributes: {max_speed: 100 mph, road_type: highway}
    force: penalty_tier

Fix (legal):
    Marks the limit `force: penalty_tier`. It changes what binds a plan, so a person decides.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb.units import to_si
from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.entries import RegulationEntry
from regdb_compiler.lint.edits import insert_key_after
from regdb_compiler.lint.view import View, view_of
from regdb_compiler.resolve import constant_of

CODE, NAME = "R313", "penalty-tier-as-limit"
LEVEL: Level = "error"
HIGHEST_SIGNED = to_si(85, "mph")  # the highest limit on any road of the United States (Texas SH 130)
_PUNISHES = re.compile(r"\bguilty\b|\bfined?\b|\bmisdemeanor\b|\binfraction\b|\bpunish|\bexceeds 100\b|\bsuspension of\b", re.IGNORECASE)


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such limit: its words punish, or it lies far above every absolute limit of its code."""
    view = view_of(build)
    highest = _highest(view)
    for rule in view.first:
        entry = rule.entry
        for limit in rule.limits:
            bound = constant_of(limit.bound)
            if limit.attribute != "max_speed" or entry.doc.force in {"penalty_tier", "advisory"} or bound is None:
                continue
            others = [value for value, owner in highest.get(entry.jurisdiction.id, ()) if owner != entry.id]
            word = _PUNISHES.search(f"{entry.doc.condition.text} {entry.doc.result} {entry.doc.quote}")
            if word or (bound > HIGHEST_SIGNED and all(bound > other for other in others)):
                why = f"the words punish (`{word[0]}`)" if word else "no road is signed so, and every absolute limit of the code is lower"
                yield _finding(entry, limit.text, why)
                break


def _highest(view: View) -> dict[str, list[tuple[float, str]]]:
    """Jurisdiction -> its two highest absolute speed limits of different regulations, with their ids."""
    found: dict[str, dict[str, float]] = {}
    for rule in view.first:
        for limit in rule.limits:
            bound = constant_of(limit.bound)
            if limit.attribute == "max_speed" and bound is not None and rule.entry.doc.force in {None, "absolute"}:
                held = found.setdefault(rule.entry.jurisdiction.id, {})
                held[rule.id] = max(bound, held.get(rule.id, 0.0))
    return {place: sorted(((bound, name) for name, bound in held.items()), reverse=True)[:2] for place, held in found.items()}


def _finding(entry: RegulationEntry, text: str, why: str) -> Diagnostic:
    place = entry.place("attributes", "max_speed")
    message = f"{text} is the threshold of an aggravated offence, not a limit: {why}"
    if entry.doc.force is None:
        edit = insert_key_after(entry.node, "attributes", "force: penalty_tier")
    else:
        edit = Edit(entry.place("force"), "penalty_tier")
    fix = Fix("legal", "mark it `force: penalty_tier`", (edit,)) if edit else None
    help_ = "mark it `force: penalty_tier`; the limit itself is another rule"
    return Diagnostic(CODE, NAME, LEVEL, message, place, help=help_, law=str(entry.citation), fix=fix)
