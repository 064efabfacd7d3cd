"""A decision in words: the state and why it was chosen, each candidate with its law and cost, and why plans fell out."""

from __future__ import annotations

from collections.abc import Iterator

from regdb.units import show_si
from regdb_runtime.decision import CandidateReport, CostTerms, Decision, Rejection

RANK_WORDS = ("lawful", "unknown", "unlawful", "no plan")
MOST_REJECTIONS = 4
"""Reasons told per candidate; how many more there are is said."""


def decision_lines(decision: Decision) -> Iterator[str]:
    """The lines of a decision, the chosen state first."""
    yield _head(decision)
    if decision.emergency.active:
        yield _emergency(decision)
    if decision.reason:
        yield f"  because {decision.reason}"
    if decision.events:
        yield f"  events: {', '.join(decision.events)}"
    order = sorted(range(len(decision.candidates)), key=lambda index: (index != decision.chosen, _worth(decision.candidates[index])))
    refused = [decision.candidates[index] for index in order if _is_refused(decision.candidates[index])]
    for index in order:
        if not _is_refused(decision.candidates[index]):
            yield from _candidate(decision.candidates[index], index == decision.chosen)
    if refused:
        yield "  not possible here: " + ", ".join(f"{item.next} ({item.rejections[0].rule})" for item in refused)


def decision_text(decision: Decision) -> str:
    """The same as one text."""
    return "\n".join(decision_lines(decision))


def _head(decision: Decision) -> str:
    way = f" by {' -> '.join(decision.steps)}" if len(decision.steps) > 1 else ""
    phase = f", stop {decision.stop_phase}" if decision.stop_phase else ""
    flag = f" [{decision.flag}]" if decision.flag else ""
    margin = "" if decision.margin is None else f", {decision.margin:.2f} cheaper than the next one of its rank"
    signal = "" if decision.turn_signal == "off" else f", signals {decision.turn_signal}"
    return f"{decision.time:.1f} s: {decision.state}{way}{phase}{signal}{margin}{flag}"


def _emergency(decision: Decision) -> str:
    found = decision.emergency
    gap = "unknown" if found.gap is None else f"{found.gap:.1f} m"
    return f"  emergency: gap to {found.track or 'something'} {gap}, required {found.required:.1f} m"


def _candidate(item: CandidateReport, chosen: bool) -> Iterator[str]:
    cost = "" if item.cost is None else f", cost {item.cost.total:.2f} ({_terms(item.cost)})"
    yield f"  {'*' if chosen else '-'} {item.current} -> {item.next}: {RANK_WORDS[item.rank]}{cost}"
    if item.verdict is not None:
        cited = dict.fromkeys(rule.citation for rule in item.verdict.deciding)
        if cited:
            yield f"      law: {item.verdict.verdict} by {', '.join(cited)}"
        combined = sorted(item.verdict.combined.items())
        limits = [f"{name} {show_si(found.bound, found.limit.unit)} ({found.regulation.citation})" for name, found in combined]
        if limits:
            yield f"      limits: {', '.join(limits)}"
        if item.verdict.verdict == "unknown" and item.verdict.missing:
            yield f"      not known: {', '.join(item.verdict.missing)}"
    for rejection in item.rejections[:MOST_REJECTIONS]:
        yield f"      {_rejection(rejection, item.sampled)}"
    more = len(item.rejections) - MOST_REJECTIONS
    if more > 0:
        yield f"      and {more} more {'reason' if more == 1 else 'reasons'}"


def _terms(cost: CostTerms) -> str:
    return f"legal {cost.legal:g}, safety {cost.safety:.2f}, comfort {cost.comfort:.2f}, distance {cost.distance:.2f}"


def _rejection(item: Rejection, sampled: int) -> str:
    measured = "" if item.measured is None else f", {item.measured:.3g} {item.unit}".rstrip()
    bound = "" if item.bound is None else f", bound {item.bound:.3g} {item.unit}".rstrip()
    because = f": {item.because}" if item.because else ""
    return f"{item.count} of {sampled} plans out by {item.rule}{measured}{bound}{because}"


def _is_refused(item: CandidateReport) -> bool:
    return item.rank == len(RANK_WORDS) - 1 and item.sampled == 0 and bool(item.rejections) and item.rejections[0].rule != "error"


def _worth(item: CandidateReport) -> tuple[int, float]:
    return item.rank, 0.0 if item.cost is None else item.cost.total
