"""A verdict and its explanation as a person reads them: ASCII, 80 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from typing import Any

from regdb.explanation import Evidence, Explanation, RuleReason, show_bound
from regdb.meaning import LimitInForce
from regdb.regulation import Regulation
from regdb.truth import spell
from regdb_runtime.commands.asking import Asked
from regdb_runtime.verdict import Verdict, reason_data

WIDTH = 80
MOST = 10
"""Items of one list that are shown unless all are asked for."""
_PLAIN = str.maketrans(
    {"\u2018": "'", "\u2019": "'", "\u201c": '"', "\u201d": '"', "\u2013": "-", "\u2014": "-", "\u2026": "...", "\u00a7": "sec.", "\u00a0": " "}
)
_FORCE = {"prima_facie": "prima facie", "basic": "basic speed law", "penalty_tier": "penalty tier"}


Part = list[list[str]]
"""One part of the answer: its items, each some lines."""


def verdict_text(asked: Asked, *, everything: bool = False) -> str:
    """The verdict, the rules that decided it, limits in force, what is unknown and what was assumed; long lists are cut."""
    verdict = asked.verdict
    most = None if everything else MOST
    deciding = [list(_rule(rule)) for rule in verdict.deciding]
    lines = [*_head(asked), *_part(_ROLE[verdict.verdict], deciding, most)]
    lines += [*_limits(verdict, most), *_missing(verdict, most), *_assumed(verdict, most), *_errors(verdict)]
    return _plain([*lines, "", "Not legal advice."])


def explanation_text(asked: Asked, *, everything: bool = False) -> str:
    """The verdict taken apart: because, unless, unknown, near misses, smallest change; long lists are cut."""
    verdict, why = asked.verdict, asked.verdict.explain()
    most = None if everything else MOST
    lines = [*_head(asked), *_reasons("Because:", why.because, most)]
    lines += _reasons("Unless (exceptions that did not help):", why.unless, most)
    lines += [*_missing(verdict, most), *_reasons("Near misses:", why.near_misses, most), *_turn(why, most)]
    lines += [*_limits(verdict, most), *_assumed(verdict, most), *_errors(verdict)]
    return _plain([*lines, "", "Not legal advice."])


def _part(title: str, items: Part, most: int | None) -> Iterator[str]:
    """A title with its items, at most so many; how many more there are is said."""
    if items:
        yield ""
        yield title
    for item in items[:most]:
        yield from item
    if most is not None and len(items) > most:
        yield f"  ... and {len(items) - most} more (--all shows them)"


def _head(asked: Asked) -> Iterator[str]:
    verdict = asked.verdict
    loaded = {rule.jurisdiction for rule in asked.view.rules}
    names = [item.name for item in asked.database.tree.path(verdict.place) if item.id in loaded]
    law = f"{'model code' if verdict.model else 'law of'} {', '.join(names)}" if names else "no law of this place is in the database"
    today = " (today)" if asked.today else ""
    yield from _wrap(f"{verdict.verdict.upper()} in {verdict.place} on {verdict.date}{today} ({law})")
    yield f"  {verdict.plan.current} -> {verdict.plan.next}"
    if verdict.model:
        yield from _wrap("A model code has force only where a legislature has enacted it.", 2)


_ROLE = {
    "illegal": "Broken:",
    "unknown": "May be broken, depending on what is unknown:",
    "legal": "Allowed by these exceptions:",
}


def _rule(rule: Regulation) -> Iterator[str]:
    yield from _wrap(f"{rule.citation}{f', {rule.title}' if rule.title else ''} [{rule.id}]", 2)
    if rule.quote:
        yield from _wrap(f'"{rule.quote}"', 6)
    if rule.result:
        yield from _wrap(f"=> {rule.result}", 6)
    if rule.vagueness >= 3:
        yield from _wrap(f"(vague {rule.vagueness}/5{f': {rule.vague_because}' if rule.vague_because else ''})", 6)


def _limits(verdict: Verdict, most: int | None) -> Iterator[str]:
    binding = {id(item) for item in verdict.combined.values()}
    several = len(verdict.limits) > 1
    held = [_wrap(_limit(item) + (" <- binds" if several and id(item) in binding else ""), 2) for item in verdict.limits]
    yield from _part("Limits in force:", held, most)
    yield from _part("Limits that may be in force:", [_wrap(_limit(item), 2) for item in verdict.possible], most)


def _limit(item: LimitInForce) -> str:
    force = _FORCE.get(item.regulation.force, item.regulation.force)
    sign = "at most" if item.limit.direction == "max" else "at least"
    return f"{item.limit.fact} {sign} {show_bound(item.bound, item.limit)} ({item.regulation.citation}{f', {force}' if force else ''})"


def _missing(verdict: Verdict, most: int | None) -> Iterator[str]:
    facts = verdict.circumstances.vocabulary.facts
    meanings = {name: facts[name].meaning if name in facts else "" for name in verdict.missing}
    items = [_wrap(f"look for: {name}{f' - {meaning}' if meaning else ''}", 2) for name, meaning in meanings.items()]
    yield from _part("Unknown; this would settle it:", items, most)
    if most is not None and len(items) > most:
        yield from _wrap("(--fact like=quiet starts from the uneventful scene, in which only what you name is out of the ordinary)", 2)


def _assumed(verdict: Verdict, most: int | None) -> Iterator[str]:
    items = []
    for name in verdict.assumed:
        declared = verdict.circumstances.vocabulary.fact(name)
        if declared.assumption is not None:
            notes = "; ".join(text for text in (declared.assumption.within, declared.assumption.because) if text)
            items.append(_wrap(f"{name} = {declared.show(declared.assumption.value)}{f' ({notes})' if notes else ''}", 2))
    yield from _part("Assumed, as nothing reported it:", items, most)


def _errors(verdict: Verdict) -> Iterator[str]:
    if verdict.errors:
        yield ""
        yield "Could not be evaluated, and so is taken the strict way:"
    for text in verdict.errors:
        yield from _wrap(text, 2)


def _reasons(title: str, reasons: Iterable[RuleReason], most: int | None) -> Iterator[str]:
    yield from _part(title, [list(_reason(reason)) for reason in reasons], most)


def _reason(reason: RuleReason) -> Iterator[str]:
    yield from _rule(reason.regulation)
    for item in reason.evidence:
        yield from _wrap(_literal(item), 6, hanging=2)
    if reason.defeated_by:
        yield from _wrap(f"defeated by {', '.join(reason.defeated_by)}", 6)
    if reason.role != "deciding" and reason.smallest_change:
        changes = " and ".join(str(change) for change in reason.smallest_change)
        yield from _wrap(f"would {'break it' if reason.role == 'near miss' else 'help'} if {changes}", 6, hanging=2)


def _literal(item: Evidence) -> str:
    told = [(fact, value) for fact, value in item.values if fact != item.literal or fact in item.assumed]
    values = ", ".join(f"{fact} is {value}{', assumed' if fact in item.assumed else ''}" for fact, value in told)
    return f"- {spell(item.truth)}: {item.literal}{f' ({values})' if values else ''}"


def _turn(why: Explanation, most: int | None) -> Iterator[str]:
    yield from _part("Smallest change that would make it lawful:", [_wrap(str(change), 2) for change in why.turn], most)


def _wrap(text: str, indent: int = 0, hanging: int = 4) -> list[str]:
    space = " " * indent
    plain = text.translate(_PLAIN)
    return textwrap.wrap(plain, WIDTH, initial_indent=space, subsequent_indent=space + " " * hanging, break_on_hyphens=False)


def _plain(lines: Iterable[str]) -> str:
    return "\n".join(lines).translate(_PLAIN).encode("ascii", "replace").decode("ascii")


def explanation_data(asked: Asked) -> dict[str, Any]:
    """The verdict in its JSON form, with what explains it."""
    why = asked.verdict.explain()
    parts = {"because": why.because, "unless": why.unless, "near_misses": why.near_misses}
    explained = {name: [reason_data(reason) for reason in reasons] for name, reasons in parts.items()}
    turn = [{"want": change.want, "now": change.now, "facts": list(change.facts)} for change in why.turn]
    return asked.verdict.to_dict() | {"explanation": {**explained, "unknown": list(why.unknown), "turn": turn}}
