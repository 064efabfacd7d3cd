"""Many rules at once: per fact and bin of its values a bitmap of the rules still possible; their AND finds the candidates.

One bisect settles every comparison of a fact with constants; unknown is one more bin. Parts that read several facts, sets,
or ask whether something is known are left to the exact functions, which have the last word on every candidate.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from typing import Any

from regdb.condition import And, Compare, Const, Is, Linear, Literal, Node, Not, OneOf, Or, Within, literals
from regdb.truth import Truth, conjoin, disjoin, negate
from regdb_runtime.index.bucket import Bucket, Decide
from regdb_runtime.index.conjuncts import reads_only
from regdb_runtime.index.settle import Tangle
from regdb_runtime.index.slots import Values

_Key = bool | str | int | None
_Test = Callable[[Any], Truth]


class FactBins:
    """The parts of all rules that read one fact alone, and what they become in each bin of its values."""

    def __init__(self, slot: int) -> None:
        self.slot = slot
        self.parts: list[tuple[int, Node]] = []

    def add(self, bit: int, node: Node) -> None:
        self.parts.append((bit, node))

    def tables(self, full: int) -> tuple[list[float], dict[_Key, int], int]:
        """Cut points (empty for words and truths), bin -> bitmap of the possible rules, bitmap of any other value."""
        cuts = sorted({cut for _, node in self.parts for literal in literals(node) for cut in _cuts(literal)})
        if cuts:
            return cuts, self._sweep(cuts, full), full
        words: set[_Key] = {word for _, node in self.parts for literal in literals(node) for word in _words(literal)}
        found = {word: self._possible(word, full) for word in (*words, True, False, None)}
        return [], found, self._possible("", full)

    def _possible(self, value: _Key, full: int) -> int:
        for bit, node in self.parts:
            if _truth(node, value) is False:
                full &= ~(1 << bit)
        return full

    def _sweep(self, cuts: list[float], full: int) -> dict[_Key, int]:
        """Bins 2i (below cut i) and 2i+1 (at cut i): each part is a set of bins, its changes are swept from left to right."""
        count = 2 * len(cuts) + 1
        places = {cut: index for index, cut in enumerate(cuts)}
        insides: dict[int, int] = {}
        for bit, node in self.parts:
            insides[bit] = insides.get(bit, -1) & _bins(node, places, count)
        changes: dict[int, int] = {}
        for bit, inside in insides.items():
            turns = inside ^ (inside << 1)
            while turns:
                low = turns & -turns
                turns ^= low
                place = low.bit_length() - 1
                changes[place] = changes.get(place, 0) ^ (1 << bit)
        reading, held = 0, 0
        for bit in insides:
            reading |= 1 << bit
        found: dict[_Key, int] = {}
        for place in range(count):
            held ^= changes.get(place, 0)
            found[place] = (full & ~reading) | held
        found[None] = self._possible(None, full)
        return found


def _cuts(node: Literal) -> tuple[float, ...]:
    if isinstance(node, Within):
        return (node.start, node.end)
    return (_cut(node)[1],) if isinstance(node, Compare) else ()


def _words(node: Literal) -> tuple[str, ...]:
    return node.words if isinstance(node, OneOf) else ()


_MIRROR = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}


def _is_plain(side: Linear) -> bool:
    return len(side.terms) == 1 and side.constant == 0 and side.terms[0][0] == 1


def _cut(node: Compare) -> tuple[str, float]:
    """The comparison as `fact op constant`."""
    if _is_plain(node.left):
        return node.op, node.right.constant
    return _MIRROR[node.op], node.left.constant


def can_bin(node: Node) -> bool:
    """Whether a part reads one fact alone, in a way that bins settle: words, truth, or comparison with a constant."""
    if reads_only(node) is None:
        return False
    return all(
        isinstance(item, (Const, Is, OneOf, Within))
        or (isinstance(item, Compare) and any(_is_plain(a) and not b.terms for a, b in ((item.left, item.right), (item.right, item.left))))
        for item in literals(node)
    )


def _bins(node: Node, places: dict[float, int], count: int) -> int:
    """The bins, as bits, in which a part is true of a known value."""
    full = (1 << count) - 1
    match node:
        case And(parts):
            for part in parts:
                full &= _bins(part, places, count)
            return full
        case Or(parts):
            found = 0
            for part in parts:
                found |= _bins(part, places, count)
            return found
        case Not(part):
            return full & ~_bins(part, places, count)
        case Const(value):
            return full if value else 0
        case Within(_, start, end):
            after, before = _ray(">=", places[start], full), _ray("<", places[end], full)
            return after & before if start <= end else after | before
        case Compare():
            op, cut = _cut(node)
            return _ray(op, places[cut], full)
    raise ValueError(f"no bins for {node!r}")


def _ray(op: str, place: int, full: int) -> int:
    at = 1 << (2 * place + 1)
    below = at - 1
    return {"<": below, "<=": below | at, ">": full & ~(below | at), ">=": full & ~below, "==": at, "!=": full & ~at}[op]


def _truth(node: Node, value: _Key) -> Truth:
    """The truth of a part under one value (None: unknown) of the fact it reads; comparisons are asked only of None."""
    match node:
        case And(parts):
            return conjoin(_truth(part, value) for part in parts)
        case Or(parts):
            return disjoin(_truth(part, value) for part in parts)
        case Not(part):
            return negate(_truth(part, value))
        case Const(constant):
            return constant
        case _ if value is None:
            return None
        case Is():
            return value is True
        case OneOf(_, words):
            return value in words
    raise ValueError(f"no bin for {node!r}")


def bitmaps(bucket: Bucket) -> Decide:
    """Decide a large bucket: AND the bitmaps, then settle the few candidates exactly."""
    order = [part.index for part in bucket.candidates]
    full = (1 << len(order)) - 1
    worded, numbered = _tables(bucket, order, full)
    exact = [bucket.condition(index) for index in order]
    tangle = Tangle(bucket)
    tangled = frozenset(part.index for part in bucket.candidates if part.tangled)
    file, settle, finish = tangle.file, tangle.settle, bucket.finish

    def decide(values: Values) -> Any:
        left = full
        for slot, table, other in worded:
            left &= table.get(values[slot], other)
        for slot, cuts, table in numbered:
            value = values[slot]
            if value is None:
                left &= table[None]
            else:
                place = bisect_left(cuts, value)
                left &= table[2 * place + 1 if place < len(cuts) and cuts[place] == value else 2 * place]
        broken: list[int] = []
        undecided: list[int] = []
        limiting: list[int] = []
        sure: list[int] = []
        maybe: list[int] = []
        while left:
            low = left & -left
            left ^= low
            bit = low.bit_length() - 1
            truth = exact[bit](values)
            if truth is not False:
                index = order[bit]
                if index in tangled:
                    (sure if truth else maybe).append(index)
                else:
                    file(index, truth, values, broken, undecided, limiting)
        excepting = settle(sure, maybe, values, broken, undecided, limiting) if sure or maybe else ()
        return finish(broken, undecided, limiting, excepting, values)

    return decide


def _tables(bucket: Bucket, order: list[int], full: int) -> tuple[list[Any], list[Any]]:
    """Slots of words and truths with their tables, and slots of numbers with cut points and tables."""
    facts: dict[str, FactBins] = {}
    for bit, index in enumerate(order):
        for node in bucket.conjuncts[index]:
            fact = reads_only(node)
            if fact is not None and can_bin(node) and fact in bucket.table.slots:
                facts.setdefault(fact, FactBins(bucket.table.slots[fact])).add(bit, node)
    worded: list[Any] = []
    numbered: list[Any] = []
    for bins in facts.values():
        cuts, table, other = bins.tables(full)
        if cuts:
            numbered.append((bins.slot, cuts, table))
        else:
            worded.append((bins.slot, table, other))
    return worded, numbered
