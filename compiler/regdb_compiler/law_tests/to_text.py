"""Outcomes as text for people, 80 columns wide: what failed, what decided, the literal behind it, and what would turn it."""

from __future__ import annotations

import datetime
import textwrap
from collections.abc import Iterable, Iterator

from regdb.explanation import Evidence, RuleReason, evidence, first_failing
from regdb.meaning import Judgement
from regdb.truth import spell
from regdb.turning import changes
from regdb_compiler.law_tests.outcome import Outcome, Tally

WIDTH = 80
_LABEL = 14
RED, BOLD = "31", "1"


def paint(text: str, *codes: str, color: bool) -> str:
    """The text in a colour, if there are colours."""
    return f"\033[{';'.join(codes)}m{text}\033[0m" if color else text


def outcome_text(outcome: Outcome, *, color: bool = False) -> str:
    """One failed or broken test, ready to print; lines end with a line feed."""
    test = outcome.test
    word = paint(outcome.status.upper(), BOLD, RED, color=color)
    lines = [f"{word} {test.where.path}:{test.where.line}", *_folded("", f"{test.subject}: {test.name}", 2)]
    lines += _circumstances(outcome)
    lines += [line for reason in outcome.reasons for line in _folded("because", reason)]
    for item in outcome.differences:
        lines += _folded("expected", f"{item.key}: {item.expected}")
        lines += _folded("got", f"{item.key}: {item.got}")
    lines += _why(outcome)
    return "\n".join(lines) + "\n"


def _circumstances(outcome: Outcome) -> Iterator[str]:
    plan, test = outcome.test.plan, outcome.test
    if plan is not None:
        day = datetime.date.fromordinal(test.day).isoformat()
        yield from _folded("judged", f"on {day} in {test.place}, {plan.current} -> {plan.next}")


def _why(outcome: Outcome) -> Iterator[str]:
    found = outcome.explanation
    if found is None:
        return
    for reason in found.because:
        yield from _reason(reason, "decided by")
    for reason in found.unless:
        yield from _reason(reason, "not excused")
    wanted = (outcome.test.expected.deciding or frozenset()) | _subject(outcome)
    shown = {item.regulation.id for item in (*found.because, *found.unless)}
    for reason in _absent(outcome.judgement, wanted - shown) if outcome.judgement is not None else ():
        yield from _reason(reason, "not deciding")
    if found.unknown:
        yield from _folded("unknown", ", ".join(found.unknown))
    for change in found.turn:
        yield from _folded("would turn", str(change))


def _subject(outcome: Outcome) -> frozenset[str]:
    return frozenset() if outcome.test.entry is None else frozenset({outcome.test.entry.id})


def _absent(judgement: Judgement, names: frozenset[str]) -> Iterator[RuleReason]:
    """Rules that were expected to decide and did not, each with the smallest change after which it would hold."""
    situation = judgement.situation
    for rule in judgement.concerned:
        if rule.id in names:
            holds = judgement.holds(rule)
            shown = tuple(evidence(rule.when, situation, wanted=True)) if holds else first_failing(rule, situation)
            by = tuple(other.id for other in judgement.defeaters(rule) if judgement.effective(other) is True)
            when = changes(rule.when, situation, wanted=True)
            unless = () if rule.unless is None else changes(rule.unless, situation, wanted=False)
            change = () if when is None or unless is None else (*when, *unless)
            yield RuleReason(rule, "absent", holds, judgement.breaks(rule), shown, by, change)


def _reason(reason: RuleReason, label: str) -> Iterator[str]:
    rule = reason.regulation
    state = {True: "holds", False: "does not hold", None: "may hold"}[reason.holds]
    if reason.defeated_by:
        state += f", displaced by {', '.join(reason.defeated_by)}"
    yield from _folded(label, f"{rule.id} ({rule.citation}) {state}" + (f': "{rule.quote}"' if rule.quote else ""))
    for item in reason.evidence:
        yield from _folded("", f"- {_literal(item)}")
    if reason.role == "absent":
        for change in reason.smallest_change:
            yield from _folded("", f"- would hold if {change}")


def _literal(item: Evidence) -> str:
    """`signal.color == red is true (signal.color is red)`; a boolean fact says its value once."""
    said = f"{item.literal} is {spell(item.truth)}"
    if [fact for fact, _ in item.values] == [item.literal]:
        return said + (" (assumed)" if item.assumed else "")
    values = ", ".join(f"{fact} is {value}{', assumed' if fact in item.assumed else ''}" for fact, value in item.values)
    return f"{said} ({values})" if values else said


def _folded(label: str, text: str, indent: int = 2 + _LABEL) -> list[str]:
    """A labelled paragraph broken at 80 columns."""
    head = f"  {label:<{_LABEL}}" if indent > 2 else "  "
    return textwrap.wrap(text, WIDTH, initial_indent=head, subsequent_indent=" " * indent, break_on_hyphens=False)


def closing_line(found: Tally, seconds: float) -> str:
    """`312 law tests passed, 2 failed (118 regulations, 61 cases) in 0.8 s`."""
    parts = [f"{found.passed} law tests passed"]
    parts += [f"{number} {word}" for number, word in ((found.failed, "failed"), (found.broken, "broken")) if number]
    regulations = f"{found.regulations} regulation{'s' if found.regulations != 1 else ''}"
    cases = f"{found.cases} case{'s' if found.cases != 1 else ''}"
    return f"{', '.join(parts)} ({regulations}, {cases}) in {seconds:.1f} s"


def outcomes_text(outcomes: Iterable[Outcome], *, quiet: bool = False, color: bool = False) -> str:
    """Every test that did not pass; `quiet` gives each one line."""
    wrong = [item for item in outcomes if item.status != "passed"]
    if quiet:
        return "".join(f"{item.status.upper()} {item.test.where.path}:{item.test.where.line} {item.test.name}\n" for item in wrong)
    return "".join(outcome_text(item, color=color) + "\n" for item in wrong)
