"""Items aligned and compared by field; every change gets its impact: tighter, looser, different, or text only."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import zip_longest

from regdb_compiler.diff.sides import Item

TEXT_FIELDS = frozenset({"condition", "result", "quote", "citation", "topic", "vagueness", "force"})
DATE_FIELDS = frozenset({"effective", "until"})
NAME_FIELDS = frozenset({"citation", "displaces", "authority"})
TIGHTER, LOOSER, DIFFERENT, TEXT_ONLY, DATES_ONLY = "TIGHTER", "LOOSER", "DIFFERENT", "TEXT-ONLY", "DATES-ONLY"


@dataclass(frozen=True)
class Change:
    """What became of one regulation: `old` or `new` is None where it was added or removed."""

    old: Item | None
    new: Item | None
    fields: tuple[tuple[str, str, str], ...] = ()

    @property
    def kind(self) -> str:
        return "added" if self.old is None else "removed" if self.new is None else "changed"

    @cached_property
    def item(self) -> Item:
        """The side that is there, the newer one if both are."""
        found = self.new or self.old
        assert found is not None
        return found

    @cached_property
    def impact(self) -> str:
        """What the change does to a driver, as far as fields tell: a proof is another matter."""
        if self.old is None or self.new is None:
            gained = self.old is None
            return LOOSER if self.item.permission == gained else TIGHTER
        names = {name for name, _, _ in self.fields}
        if names <= DATE_FIELDS:
            return DATES_ONLY
        if names <= TEXT_FIELDS | DATE_FIELDS:
            return TEXT_ONLY
        return _limit_impact(self.old, self.new, names - TEXT_FIELDS - DATE_FIELDS)


def _limit_impact(old: Item, new: Item, names: set[str]) -> str:
    if any(name not in old.limits or name not in new.limits for name in names):
        return DIFFERENT
    steps = set()
    for name in names:
        (direction, before), (_, after) = old.limits[name], new.limits[name]
        lower_is_tighter = direction == "max"
        steps.add(TIGHTER if (after < before) == lower_is_tighter else LOOSER)
    return steps.pop() if len(steps) == 1 else DIFFERENT


def compare(old: Iterable[Item], new: Iterable[Item], without: frozenset[str] = frozenset()) -> tuple[Change, ...]:
    """Changes between two lists of items, aligned by id; of an id with several versions, version by version.

    Fields in `without` do not count: between two dates the dates themselves are no difference.
    """
    before, after = _by_id(old), _by_id(new)
    changes: list[Change] = []
    for name in sorted(before.keys() | after.keys()):
        found = _versions(before.get(name, []), after.get(name, []), without)
        changes += [change for change in found if change.fields or change.kind != "changed"]
    return tuple(changes)


def _by_id(items: Iterable[Item]) -> dict[str, list[Item]]:
    found: dict[str, list[Item]] = {}
    for item in items:
        found.setdefault(item.id, []).append(item)
    return found


def _versions(old: list[Item], new: list[Item], without: frozenset[str]) -> list[Change]:
    """The same text is the same version; what is left over is paired by its first day, then in order."""
    left_old = [item for item in old if all(item.fields != other.fields for other in new)]
    left_new = [item for item in new if all(item.fields != other.fields for other in old)]
    pairs: list[tuple[Item | None, Item | None]] = []
    for item in list(left_old):
        match = next((other for other in left_new if other.fields.get("effective") == item.fields.get("effective")), None)
        if match is not None:
            pairs.append((item, match))
            left_old.remove(item)
            left_new.remove(match)
    pairs += zip_longest(left_old, left_new)
    return [_change(a, b, without) for a, b in pairs]


def compare_by_topic(old: Sequence[Item], new: Sequence[Item]) -> tuple[Change, ...]:
    """Changes between two codes, aligned by topic and, within it, by likeness; names and dates of codes do not count."""
    topics = sorted({item.topic for item in (*old, *new)})
    changes: list[Change] = []
    for topic in topics:
        ours, theirs = [i for i in old if i.topic == topic], [i for i in new if i.topic == topic]
        ranked = sorted(
            ((likeness(a, b), -i, -j) for i, a in enumerate(ours) for j, b in enumerate(theirs)), reverse=True
        )
        used_a: set[int] = set()
        used_b: set[int] = set()
        for score, i, j in ranked:
            if score > 0.25 and -i not in used_a and -j not in used_b:
                used_a.add(-i)
                used_b.add(-j)
                change = _change(ours[-i], theirs[-j], without=NAME_FIELDS | DATE_FIELDS)
                changes += [change] if change.fields else []
        changes += [_change(item, None) for i, item in enumerate(ours) if i not in used_a]
        changes += [_change(None, item) for j, item in enumerate(theirs) if j not in used_b]
    return tuple(changes)


def likeness(a: Item, b: Item) -> float:
    """How alike two regulations of one topic are, 0 to 1: words of the condition, states, legality, limits."""
    if a.permission != b.permission:
        return 0.0
    ours, theirs = _words(a), _words(b)
    shared = len(ours & theirs) / max(len(ours | theirs), 1)
    states = a.fields.get("states") == b.fields.get("states")
    return 0.6 * shared + 0.25 * states + 0.15 * (set(a.limits) == set(b.limits))


def _words(item: Item) -> set[str]:
    text = " ".join(item.fields.get(name, "") for name in ("when", "unless", "condition", "result"))
    return set(re.findall(r"[a-z_.]{3,}", text.lower()))


def _change(old: Item | None, new: Item | None, without: frozenset[str] = frozenset()) -> Change:
    if old is None or new is None:
        return Change(old, new)
    names = dict.fromkeys((*old.fields, *new.fields))
    fields = tuple(
        (name, old.fields.get(name, ""), new.fields.get(name, ""))
        for name in names
        if name not in without and old.fields.get(name, "") != new.fields.get(name, "")
    )
    return Change(old, new, fields)
