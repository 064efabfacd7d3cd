"""What the live statements on one fact come to under its policy: the strictest at once, what permits only when confirmed; pure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from regdb.fusion_policy import FusionPolicy
from regdb.vocabulary import Fact, Value
from regdb_runtime.perception.evidence import Source, Statement

EXACT: frozenset[Source] = frozenset(("map", "gnss", "clock"))
"""Sources whose one word is enough where nobody contradicts it: they do not look, they know or measure."""
_LOOKS: frozenset[Source] = frozenset(("model", "scripted"))
SAME_PLACE = 1.0
"""Metres within which two frames show the same."""
OUTVOTED, OUTVOTED_BY = 6, 4
"""Denials from one place, and how many to each affirmation, that make the affirmations a slip (3 s of a model that answers twice a second)."""
CHOICE = "choice"
"""The `rule` of statements that answer a closed question on a crop."""
_TICK = 1e-9
"""Seconds by which times that should be equal may differ after arithmetic."""


@dataclass(frozen=True, slots=True)
class Held:
    """A statement with the odometer (m) at the moment its frame was captured."""

    statement: Statement
    travelled: float

    @property
    def captured(self) -> float:
        return self.statement.captured


@dataclass(frozen=True, slots=True)
class Moment:
    """Now: seconds since the run began and metres on the odometer."""

    time: float
    travelled: float

    def age(self, held: Held) -> tuple[float, float]:
        """Seconds and metres since a statement was captured; beyond its reach by what arithmetic alone makes is within it."""
        return self.time - held.captured - _TICK, self.travelled - held.travelled - _TICK


@dataclass(frozen=True, slots=True)
class Belief:
    """What is held to be so, and the statements it rests on."""

    value: Value
    evidence: tuple[Statement, ...]


def believe(fact: Fact, policy: FusionPolicy, held: Sequence[Held], now: Moment) -> Belief | None:
    """The fact's value, None while it is unknown. Never depends on the order of `held`.

    Restrictive values stand from their first statement until they have aged or, where the policy lets them, were replaced by confirmed
    later ones; values that permit need all confirmations, fresh, corroborated where that is declared, with nothing stricter alive.
    """
    live = _without_slips(policy, tuple(item for item in held if _counts(policy, item, now)))
    if fact.kind == "set":
        return _believe_set(fact, policy, live)
    return _settle(fact, policy, _as_chosen(policy, live))


def restricts(policy: FusionPolicy, value: Value) -> bool:
    """Whether a value holds the vehicle back, so that one statement of it is enough. A set does while one of its words does."""
    if isinstance(value, frozenset):
        return any(word not in policy.permissive for word in value)
    return value not in policy.permissive


def outlived(policy: FusionPolicy, item: Held, now: Moment) -> bool:
    """Whether a statement can no longer count for anything."""
    seconds, metres = now.age(item)
    return not (policy.holds.covers(seconds, metres) or policy.fresh.covers(seconds, metres))


def _counts(policy: FusionPolicy, item: Held, now: Moment) -> bool:
    statement = item.statement
    strict = statement.certainty == "asserted" and restricts(policy, statement.value)
    return now.time - item.captured >= -_TICK and (policy.holds if strict else policy.fresh).covers(*now.age(item))


def _without_slips(policy: FusionPolicy, live: Sequence[Held]) -> Sequence[Held]:
    """Without what the model said once or twice and denied again and again from the very same place.

    What holds by distance alone would never be forgotten by a vehicle that stands, so one slip of the model would keep it there. A thing
    that is there is affirmed from that place most of the time; one that has left the view was affirmed from other places, and stays.
    """
    if not math.isinf(policy.holds.seconds):
        return live
    looked = [item for item in live if item.statement.source in _LOOKS and item.statement.certainty == "asserted"]
    denials = [item.travelled for item in looked if not restricts(policy, item.statement.value)]
    if len(denials) < OUTVOTED:
        return live
    slips = {id(item) for item in looked if restricts(policy, item.statement.value) and _is_slip(item, looked, denials)}
    return [item for item in live if id(item) not in slips] if slips else live


def _is_slip(item: Held, looked: Sequence[Held], denials: Sequence[float]) -> bool:
    denied = sum(abs(place - item.travelled) <= SAME_PLACE for place in denials)
    affirmed = sum(other.statement.value == item.statement.value and abs(other.travelled - item.travelled) <= SAME_PLACE for other in looked)
    return denied >= OUTVOTED and affirmed * OUTVOTED_BY <= denied


def _as_chosen(policy: FusionPolicy, live: Sequence[Held]) -> Sequence[Held]:
    """Without what the model said unasked, once its confirmed answers to the closed question say something that permits."""
    answers = [item for item in live if item.statement.rule == CHOICE and item.statement.certainty == "asserted"]
    last_strict = max((item.captured for item in answers if restricts(policy, item.statement.value)), default=-math.inf)
    after = [item for item in answers if item.captured > last_strict]
    if len(_spaced(policy, after)) < policy.confirmations:
        return live
    return [item for item in live if item in after or item.statement.source not in ("model", "scripted")]


def _settle(fact: Fact, policy: FusionPolicy, live: Sequence[Held]) -> Belief | None:
    said = [item for item in live if item.statement.certainty == "asserted"]
    strict = sorted((item for item in said if restricts(policy, item.statement.value)), key=lambda item: _strictness(fact, policy, item))
    while strict:
        value = strict[-1].statement.value
        group = [item for item in strict if item.statement.value == value]
        if not _is_replaced(fact, policy, group, said):
            return _belief(value, group)
        strict = [item for item in strict if item.statement.value != value]
        said = [item for item in said if item.statement.value != value]
    if any(item.statement.certainty == "hedged" and restricts(policy, item.statement.value) for item in live):
        return None
    return _permitted(fact, policy, said)


def _is_replaced(fact: Fact, policy: FusionPolicy, group: Sequence[Held], said: Sequence[Held]) -> bool:
    """Whether later statements, as many as a permission needs, agree on something less strict."""
    if not policy.replaced:
        return False
    last, bar = max(item.captured for item in group), _strictness(fact, policy, group[0])
    later = [item for item in said if item.captured > last and _strictness(fact, policy, item) < bar]
    return any(_confirming(fact, policy, later, value) for value in _values(later))


def _permitted(fact: Fact, policy: FusionPolicy, said: Sequence[Held]) -> Belief | None:
    """The one permissive value that is confirmed. Of numbers with a strict side the strictest said; of words one that nothing contradicts."""
    if fact.is_numeric and not policy.permissive.values and (policy.permissive.above, policy.permissive.below) != (None, None):
        return _permitted_number(fact, policy, said)
    found = []
    for value in _values(said):
        others = max((item.captured for item in said if item.statement.value != value), default=-math.inf)
        since = [item for item in said if item.captured > others] if policy.replaced else list(said)
        proof = _confirming(fact, policy, since, value)
        if proof:
            found.append(_belief(value, proof))
    alone = len(found) == 1 and (policy.replaced or len(_values(said)) == 1)
    return found[0] if alone else None


def _permitted_number(fact: Fact, policy: FusionPolicy, said: Sequence[Held]) -> Belief | None:
    left = sorted(said, key=lambda item: _strictness(fact, policy, item))
    while left:
        value = left[-1].statement.value
        group = [item for item in left if item.statement.value == value]
        if not _is_replaced(fact, policy, group, left):
            proof = _confirming(fact, policy, left, value)
            return _belief(value, [*group, *proof]) if proof else None
        left = [item for item in left if item.statement.value != value]
    return None


def _confirming(fact: Fact, policy: FusionPolicy, said: Sequence[Held], value: Value) -> list[Held]:
    """Statements that make a value known beyond the first: enough of them, apart, near in time; empty when they do not.

    Where corroboration is declared, enough of the corroborating sources and enough of the others. A number is confirmed by every
    number that permits at least as much.
    """
    least = _strictness_of(fact, policy, value)
    same = [item for item in said if item.statement.value == value or (fact.is_numeric and _strictness(fact, policy, item) < least)]
    asked = not policy.asks or value is not True or any(item.statement.rule == CHOICE or item.statement.source in EXACT for item in same)
    return _proof(policy, same, alone=restricts(policy, value)) if asked else []


def _proof(policy: FusionPolicy, same: Sequence[Held], *, alone: bool = False) -> list[Held]:
    """Those of statements that agree which make it known; empty when they are too few, or `alone` is not enough and nobody corroborates."""
    exact = [item for item in same if item.statement.source in EXACT and (not policy.corroboration or item.statement.source in policy.corroboration)]
    if exact:
        return exact
    if alone or not policy.corroboration:
        found = _spaced(policy, same)
        return found if len(found) >= policy.confirmations else []
    beside = _spaced(policy, [item for item in same if item.statement.source in policy.corroboration])
    others = _spaced(policy, [item for item in same if item.statement.source not in policy.corroboration])
    return [*others, *beside] if min(len(others), len(beside)) >= policy.confirmations else []


def _spaced(policy: FusionPolicy, items: Iterable[Held]) -> list[Held]:
    """The newest and those before it that are `apart` from one another, as far back as `within` reaches."""
    found: list[Held] = []
    for item in sorted(items, key=_order, reverse=True):
        if not found or (
            found[-1].captured - item.captured >= policy.apart - _TICK
            and found[-1].captured > item.captured
            and found[0].captured - item.captured <= policy.within + _TICK
        ):
            found.append(item)
    return found


def _believe_set(fact: Fact, policy: FusionPolicy, live: Sequence[Held]) -> Belief | None:
    """Word by word: a restrictive word from one statement, a permissive one when confirmed; nothing at all when that is confirmed."""
    said = [item for item in live if item.statement.certainty == "asserted"]
    words: dict[str, Sequence[Held]] = {}
    for word in fact.values:
        naming = [item for item in said if isinstance(item.statement.value, frozenset) and word in item.statement.value]
        if naming and word not in policy.permissive:
            words[word] = naming
        elif proof := _proof(policy, naming):
            words[word] = proof
    if words:
        return _belief(frozenset(words), [item for naming in words.values() for item in naming])
    empty = _proof(policy, [item for item in said if not item.statement.value])
    return _belief(frozenset(), empty) if empty and len(_values(said)) == 1 else None


def _strictness(fact: Fact, policy: FusionPolicy, item: Held) -> float:
    return _strictness_of(fact, policy, item.statement.value)


def _strictness_of(fact: Fact, policy: FusionPolicy, value: Value) -> float:
    """Greater is stricter. Numbers by the side that permits; of words those that permit are all alike."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return value if policy.permissive.below is not None else -value if policy.permissive.above is not None else 0.0
    if isinstance(value, str):
        return _word_strictness(fact.values, policy.strictest, value) if value not in policy.permissive else 0.0
    return 0.0 if value in policy.permissive else 1.0


@lru_cache(maxsize=1024)
def _word_strictness(values: tuple[str, ...], strictest: tuple[str, ...], word: str) -> float:
    """Words that the policy ranks come first, the others as the vocabulary lists them."""
    order = [*strictest, *(other for other in values if other not in strictest)]
    return float(len(order) - order.index(word))


def _values(items: Iterable[Held]) -> list[Value]:
    return list(dict.fromkeys(item.statement.value for item in items))


def _order(item: Held) -> tuple[float, str, str, str]:
    statement = item.statement
    return statement.captured, statement.source, statement.rule, statement.frame


def _belief(value: Value, items: Iterable[Held]) -> Belief:
    evidence = sorted(dict.fromkeys(items), key=_order)
    return Belief(value, tuple(item.statement for item in evidence))
