"""The smallest change that would turn a rule or a verdict: found from the conditions, then tried out before anybody is told."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice, product

from regdb.condition import OPPOSITE, TRUE, And, Compare, Const, Is, Linear, Literal, Node, Not, Or, evaluate, literal_facts, literals
from regdb.condition_text import show, show_linear
from regdb.counterfactual import with_wishes
from regdb.meaning import ILLEGAL, LEGAL, Judgement
from regdb.regulation import Limit, Regulation
from regdb.situation import Situation
from regdb.truth import Truth, spell

_TRIES = 16
"""Combinations of ways out of several broken rules that are tried before the search for what turns a verdict goes deeper."""


_RULES_TRIED = 64
"""Rules in all the combinations together; where very many rules decide, only the first combination is tried."""


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that would have to be otherwise: the condition it should meet, and what it is now.

    `literal` and the `truth` it should have are the same as `want`, for whoever applies it.
    """

    want: str
    now: str
    facts: tuple[str, ...]
    literal: Literal = TRUE
    truth: bool = True

    def __str__(self) -> str:
        return f"{self.want} (now {self.now})" if self.now else self.want


def shown_value(fact: str, situation: Situation) -> str:
    """A fact's value as a person reads it, assumed ones too."""
    declared = situation.vocabulary.facts.get(fact)
    value = situation.value(fact)
    return spell(None) if value is None else declared.show(value) if declared else str(value)


def changes(node: Node, situation: Situation, wanted: bool) -> tuple[Change, ...] | None:
    """The fewest literals to change so that a condition becomes `wanted`; None when nothing can."""
    if evaluate(node, situation) is wanted:
        return ()
    match node:
        case Not(part):
            return changes(part, situation, not wanted)
        case And(parts) | Or(parts):
            options = [changes(part, situation, wanted) for part in parts]
            if isinstance(node, And) is wanted:
                return None if any(option is None for option in options) else tuple(c for o in options for c in o or ())
            return shortest(options)
        case Const():
            return None
        case _:
            return (_change(node, situation, wanted),)


def shortest(options: Iterable[tuple[Change, ...] | None]) -> tuple[Change, ...] | None:
    """The option with the fewest changes, the first of equals."""
    possible = [option for option in options if option is not None]
    return min(possible, key=len) if possible else None


def _change(node: Literal, situation: Situation, wanted: bool) -> Change:
    facts = literal_facts(node)
    now = ", ".join(f"{fact} is {shown_value(fact, situation)}" if len(facts) > 1 else shown_value(fact, situation) for fact in facts)
    if isinstance(node, Is):
        return Change(f"{node.fact} is {spell(wanted)}", now, facts, node, wanted)
    if isinstance(node, Compare) and not wanted:
        node = Compare(OPPOSITE[node.op], node.left, node.right, node.kind, node.unit)
        return Change(show(node), now, facts, node)
    return Change(show(node if wanted else Not(node)), now, facts, node, wanted)


def _within_limit(limit: Limit, situation: Situation) -> Change:
    op = "<=" if limit.direction == "max" else ">="
    bound = show_linear(limit.bound, "quantity", limit.unit)
    literal = Compare(op, Linear(0.0, ((1.0, limit.fact),)), limit.bound, "quantity", limit.unit)
    return Change(f"{limit.fact} {op} {bound}", shown_value(limit.fact, situation), (limit.fact,), literal)


def to_turn(rule: Regulation, judgement: Judgement) -> tuple[Change, ...] | None:
    """The smallest change after which this rule is not broken and no other one is that was not before; None when none is found."""
    before = {other.id for other in judgement.concerned if judgement.breaks(other) is True}
    for option in _ways_out(rule, judgement):
        after = after_changes(option, judgement)
        if after is None or after.breaks(rule) is not False:
            continue
        if all(other.id in before or after.breaks(other) is not True for other in after.concerned):
            return option
    return None


def _ways_out(rule: Regulation, judgement: Judgement) -> list[tuple[Change, ...]]:
    """Keep the limit, earn an exception, or undo the condition; the fewest changes first, not yet tried."""
    situation = judgement.situation
    options: list[tuple[Change, ...] | None] = []
    if rule.limits:
        options.append(tuple(_within_limit(limit, situation) for limit in rule.limits if judgement.beyond(limit) is not False))
    options += [to_hold(other, judgement) for other in judgement.defeaters(rule)]
    options.append(changes(rule.when, situation, wanted=False))
    if rule.unless is not None:
        options.append(changes(rule.unless, situation, wanted=True))
    return sorted((option for option in options if option is not None), key=len)


def after_changes(wanted: Iterable[Change], judgement: Judgement) -> Judgement | None:
    """The judgement of the same rules after the changes; None when they cannot be made."""
    situation = with_wishes(judgement.situation, ((change.literal, change.truth) for change in wanted))
    return None if situation is None else Judgement(judgement.concerned, situation)


@dataclass(frozen=True, slots=True)
class _Goal:
    """What a turn is to reach: an unlawful plan is no longer broken by any rule, an unsettled one is lawful."""

    judgement: Judgement
    settled: bool

    def reached(self, wanted: tuple[Change, ...]) -> bool:
        after = after_changes(wanted, self.judgement)
        return after is not None and all(self._is_fine(after.breaks(rule)) for rule in (*self.judgement.decision.deciding, *after.concerned))

    def _is_fine(self, breach: Truth) -> bool:
        return breach is False or (breach is None and not self.settled)

    def needed(self, wanted: tuple[Change, ...]) -> tuple[Change, ...]:
        """The changes without those that can be left out."""
        for change in wanted:
            fewer = tuple(other for other in wanted if other is not change)
            if self.reached(fewer):
                return self.needed(fewer)
        return wanted


def to_turn_verdict(judgement: Judgement) -> tuple[Change, ...]:
    """Changes that turn the verdict, tried out and none of them needless; empty when it is legal or none are found."""
    verdict = judgement.decision.verdict
    return () if verdict == LEGAL else _search(_Goal(judgement, settled=verdict != ILLEGAL), (), judgement, _TRIES)


def _search(goal: _Goal, made: tuple[Change, ...], judgement: Judgement, tries: int) -> tuple[Change, ...]:
    """Ways out of what is still broken; where each calls for another, the first two are followed with fewer tries."""
    if not tries or judgement.decision.verdict == LEGAL:
        return ()
    deciding = judgement.decision.deciding
    choices = product(*(_ways_out(rule, judgement) for rule in deciding))
    tries = min(tries, max(1, _RULES_TRIED // len(deciding)))
    merged = [tuple({change.want: change for way in choice for change in way}.values()) for choice in islice(choices, tries)]
    options = sorted((option for option in merged if option), key=len)
    for option in (*options, *_singles(judgement)):
        if goal.reached((*made, *option)):
            return goal.needed((*made, *option))
    for option in options[:2]:
        after = after_changes(option, judgement)
        found = _search(goal, (*made, *option), after, tries // 4) if after is not None else ()
        if found:
            return found
    return ()


def to_hold(rule: Regulation, judgement: Judgement) -> tuple[Change, ...] | None:
    """The smallest change after which a rule that nothing displaces holds; None when there is none. Not tried out."""
    if any(judgement.effective(other) is not False for other in judgement.defeaters(rule)):
        return None
    when = changes(rule.when, judgement.situation, wanted=True)
    unless = () if rule.unless is None else changes(rule.unless, judgement.situation, wanted=False)
    return None if when is None or unless is None else (*when, *unless)


def _singles(judgement: Judgement) -> list[tuple[Change, ...]]:
    """Each literal behind a lone deciding rule turned by itself: one change may do what the rule's own ways out, taken alone, do not."""
    if len(judgement.decision.deciding) != 1:
        return []
    found: dict[str, Change] = {}
    for rule in (judgement.decision.deciding[0], *judgement.defeaters(judgement.decision.deciding[0])):
        for node in (rule.when, rule.unless):
            for literal in literals(node) if node is not None else ():
                now = evaluate(literal, judgement.situation)
                for wanted in (True, False):
                    if now is not wanted and not isinstance(literal, Const):
                        change = _change(literal, judgement.situation, wanted)
                        found[change.want] = change
    return [(change,) for change in found.values()]
