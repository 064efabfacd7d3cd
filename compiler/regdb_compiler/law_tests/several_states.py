"""A plan whose `current` or `next` lists several states, as every transition between them that the machine has."""

from __future__ import annotations

from collections.abc import Iterable

from regdb.states import StateError, StateMachine

RawPlan = dict[str, object]


def each_transition(raw: RawPlan, machine: StateMachine) -> tuple[list[RawPlan], tuple[str, ...]]:
    """The plans a written plan stands for, and the names in its lists that no transition among them has.

    A plan without lists stands for itself. A name that the machine does not know stands alone, for the reader to complain of.
    """
    if not any(isinstance(raw.get(role), list) for role in ("current", "next")):
        return [raw], ()
    ours, theirs = _names(raw.get("current"), machine), _names(raw.get("next"), machine)
    for role, names in (("current", ours), ("next", theirs)):
        for name in names:
            if not _is_state(name, machine):
                return [{**raw, "current": ours[0], "next": theirs[0], role: name}], ()
    pairs = {(a, b): machine.transition(a, b) for a in ours for b in theirs}
    there = {names: pair for names, pair in pairs.items() if pair[1] in machine.states[pair[0]].next}
    alone = [*(name for name in ours if all(a != name for a, _ in there)), *(name for name in theirs if all(b != name for _, b in there))]
    plans = [{**raw, "current": a, "next": b} for a, b in dict.fromkeys(there.values())]
    return plans or [{**raw, "current": ours[0], "next": theirs[0]}], tuple(alone)


def _names(written: object, machine: StateMachine) -> tuple[str, ...]:
    if isinstance(written, list):
        return tuple(map(str, written)) or (machine.initial,)
    return (str(written) if written else machine.initial,)


def _is_state(name: str, machine: StateMachine) -> bool:
    try:
        machine.expand(name)
    except StateError:
        return False
    return True


def listed(names: Iterable[str]) -> str:
    """Names for a message."""
    return ", ".join(f"`{name}`" for name in names)
