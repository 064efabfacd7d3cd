"""Why a verdict is as it is: the literals behind it, what is unknown, and the smallest change that would turn it.

Everything here is built only when somebody asks; the decision itself needs none of it.
"""

from __future__ import annotations

from dataclasses import dataclass

from regdb.condition import And, Literal, Node, Not, Or, evaluate, literal_facts
from regdb.condition_text import show, show_linear
from regdb.meaning import Judgement
from regdb.regulation import Limit, Regulation
from regdb.situation import Situation
from regdb.truth import Truth, spell
from regdb.turning import Change, after_changes, shown_value, to_hold, to_turn, to_turn_verdict
from regdb.vocabulary import show_value


@dataclass(frozen=True, slots=True)
class Evidence:
    """One literal with its truth and the values it saw: `signal.color == red` true, signal.color is red."""

    literal: str
    truth: Truth
    values: tuple[tuple[str, str], ...]
    assumed: tuple[str, ...] = ()

    def __str__(self) -> str:
        seen = ", ".join(f"{fact} is {value}{' (assumed)' if fact in self.assumed else ''}" for fact, value in self.values)
        return f"{self.literal}: {spell(self.truth)}" + (f" ({seen})" if seen else "")


@dataclass(frozen=True, slots=True)
class RuleReason:
    """What one rule contributed: whether it holds, is defeated, is broken; its literals; its smallest change."""

    regulation: Regulation
    role: str
    holds: Truth
    breach: Truth
    evidence: tuple[Evidence, ...]
    defeated_by: tuple[str, ...] = ()
    smallest_change: tuple[Change, ...] = ()


@dataclass(frozen=True, slots=True)
class Explanation:
    """The verdict taken apart. `because`: deciding rules; `unless`: exceptions that failed or are unknown;
    `unknown`: facts that would settle it; `near_misses`: rules that failed by one literal; `turn`: smallest change."""

    verdict: str
    because: tuple[RuleReason, ...]
    unless: tuple[RuleReason, ...]
    unknown: tuple[str, ...]
    near_misses: tuple[RuleReason, ...]
    turn: tuple[Change, ...]


def evidence(node: Node, situation: Situation, wanted: Truth) -> list[Evidence]:
    """The literals that make a condition what it is: for a false `and` the first false part, for a true one all parts."""
    match node:
        case And(parts) | Or(parts):
            settling = isinstance(node, Or)
            picked = [part for part in parts if evaluate(part, situation) is wanted]
            if wanted is settling or (wanted is None):
                picked = picked[:1] if wanted is settling else picked
            return [item for part in picked for item in evidence(part, situation, wanted)]
        case Not(part):
            return evidence(part, situation, None if wanted is None else not wanted)
        case _:
            return [_literal_evidence(node, situation)]


def first_failing(rule: Regulation, situation: Situation) -> tuple[Evidence, ...]:
    """The literals because of which a rule does not hold, or is not known to."""
    when = evaluate(rule.when, situation)
    if when is not True:
        return tuple(evidence(rule.when, situation, when))
    unless = evaluate(rule.unless, situation) if rule.unless is not None else False
    return tuple(evidence(rule.unless, situation, unless)) if rule.unless is not None and unless is not False else ()


def _literal_evidence(node: Literal, situation: Situation) -> Evidence:
    facts = literal_facts(node)
    values = tuple((fact, shown_value(fact, situation)) for fact in facts)
    assumed = tuple(fact for fact in facts if situation.observed(fact) is None and situation.assumed(fact) is not None)
    return Evidence(show(node), evaluate(node, situation), values, assumed)


def explain(judgement: Judgement) -> Explanation:
    """Take a judgement apart: deciding rules, failed exceptions, missing facts, near misses, and what would turn it."""
    decision = judgement.decision
    because = tuple(_reason(rule, "deciding", judgement) for rule in decision.deciding)
    failed = {o.id: o for rule in decision.deciding for o in judgement.defeaters(rule) if judgement.effective(o) is not True}
    unless = tuple(_reason(rule, "exception", judgement) for rule in failed.values())
    return Explanation(decision.verdict, because, unless, decision.missing, _near_misses(judgement), to_turn_verdict(judgement))


def _near_misses(judgement: Judgement) -> tuple[RuleReason, ...]:
    """Prohibitions that one literal keeps from being broken, at most five, fewest facts first."""
    found = []
    for rule in judgement.concerned:
        if rule.legality or rule.force == "advisory" or judgement.breaks(rule) is not False or not _seen(rule, judgement):
            continue
        needed = to_hold(rule, judgement)
        after = after_changes(needed, judgement) if needed is not None and len(needed) <= 1 and (needed or rule.limits) else None
        if after is not None and after.effective(rule) is True:
            found.append(_reason(rule, "near miss", judgement, needed))
    return tuple(found[:5])


def _seen(rule: Regulation, judgement: Judgement) -> bool:
    """Whether something in the scene speaks for the rule: a literal of its condition that is true by observation."""
    return rule.legality is False and any(
        item.truth is True and not item.assumed for item in _all_evidence(rule.when, judgement.situation)
    )


def _all_evidence(node: Node, situation: Situation) -> list[Evidence]:
    match node:
        case And(parts) | Or(parts):
            return [item for part in parts for item in _all_evidence(part, situation)]
        case Not():
            return []
        case _:
            return [_literal_evidence(node, situation)]


def _reason(rule: Regulation, role: str, judgement: Judgement, turn: tuple[Change, ...] | None = None) -> RuleReason:
    situation = judgement.situation
    holds = judgement.holds(rule)
    shown = tuple(evidence(rule.when, situation, wanted=True)) if holds else first_failing(rule, situation)
    for limit in rule.limits:
        if judgement.effective(rule) is not False:
            shown += (_limit_evidence(limit, judgement),)
    defeated = tuple(other.id for other in judgement.defeaters(rule) if judgement.effective(other) is True)
    change = turn if turn is not None else to_turn(rule, judgement) if role == "deciding" else to_hold(rule, judgement)
    return RuleReason(rule, role, holds, judgement.breaks(rule), shown, defeated, change or ())


def _limit_evidence(limit: Limit, judgement: Judgement) -> Evidence:
    op = "<=" if limit.direction == "max" else ">="
    beyond = judgement.beyond(limit)
    literal = f"{limit.fact} {op} {show_linear(limit.bound, 'quantity', limit.unit)}"
    facts = (limit.fact, *(fact for _, fact in limit.bound.terms))
    values = tuple((fact, shown_value(fact, judgement.situation)) for fact in facts)
    return Evidence(literal, None if beyond is None else not beyond, values)


def show_bound(bound: float, limit: Limit) -> str:
    """A limit's number in the law's own unit: `25 mph`."""
    return show_value(bound, "quantity", limit.unit)
