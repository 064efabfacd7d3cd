"""Many rules at once: per fact and bin of its values a bitmap of the rules still possible; their AND finds the candidates.

One bisect settles every comparison of a fact with constants; unknown is one more bin. Parts that read several facts, sets,
or ask whether something is known are left to the exact functions, which have the last word on every candidate.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator

from regdb.condition import And, Compare, Const, Is, Linear, Literal, Node, Not, OneOf, Or, Within, literals
from regdb.truth import Truth, conjoin, disjoin, negate
from regdb_runtime.index.bucket import Bucket, Decide, Found
from regdb_runtime.index.conjuncts import Conjuncts, reads_only
from regdb_runtime.index.settle import Tangle
from regdb_runtime.index.slots import Values

_Key = bool | str | int | None


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

    def doubt(self) -> int:
        """The rules that an unknown value leaves open."""
        found = 0
        for bit, node in self.parts:
            if _truth(node, None) is None:
                found |= 1 << bit
        return found

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


class _Masks:
    """Which bits can be answered how: `plain` rules are broken or undecided by their bits alone, `whole` ones need no exact
    function, the rest are looked at one by one."""

    def __init__(self, bucket: Bucket) -> None:
        self.order = [part.index for part in bucket.candidates]
        self.full = (1 << len(self.order)) - 1
        self.whole = self.plain = 0
        self.facts: dict[str, FactBins] = {}
        for bit, part in enumerate(bucket.candidates):
            if self._bin(bit, bucket.conjuncts[part.index], bucket):
                self.whole |= 1 << bit
                if part.breakable and not (part.tangled or part.limiting or part.rule.limits):
                    self.plain |= 1 << bit

    def _bin(self, bit: int, parts: Conjuncts, bucket: Bucket) -> bool:
        """File the parts of a rule under their facts; whether that was all of them."""
        whole = True
        for node in parts:
            fact = reads_only(node)
            if fact is not None and can_bin(node) and fact in bucket.table.slots:
                self.facts.setdefault(fact, FactBins(bucket.table.slots[fact])).add(bit, node)
            else:
                whole = False
        return whole


def bitmaps(bucket: Bucket) -> Decide:
    """Decide a large bucket: AND the bitmaps, then settle what they leave open exactly."""
    masks = _Masks(bucket)
    find = _finder(masks)
    order, whole, plain = masks.order, masks.whole, masks.plain
    others = ~plain
    tangle = Tangle(bucket)
    tangled = frozenset(part.index for part in bucket.candidates if part.tangled)
    exact = {bit: bucket.condition(index) for bit, index in enumerate(order) if not whole >> bit & 1}
    file, settle, finish = tangle.file, tangle.settle, bucket.finish

    def decide(values: Values) -> Found:
        left, doubtful = find(values)
        simple, rest = left & plain, left & others
        broken = [order[bit] for bit in set_bits(simple & ~doubtful)] if simple else []
        undecided = [order[bit] for bit in set_bits(simple & doubtful)] if simple else []
        limiting: list[int] = []
        sure: list[int] = []
        maybe: list[int] = []
        for bit in set_bits(rest) if rest else ():
            test = exact.get(bit)
            truth = test(values) if test is not None else None if doubtful >> bit & 1 else True
            if truth is not False:
                index = order[bit]
                if index in tangled:
                    (sure if truth else maybe).append(index)
                else:
                    file(index, truth, values, broken, undecided, limiting)
        excepting = settle(sure, maybe, values, broken, undecided, limiting) if sure or maybe else ()
        return finish(broken, undecided, limiting, excepting, values)

    return decide


def _finder(masks: _Masks) -> Callable[[Values], tuple[int, int]]:
    """The function from values to the possible rules, and the rules that read something unknown."""
    worded, numbered = [], []
    for bins in masks.facts.values():
        cuts, table, other = bins.tables(masks.full)
        if cuts:
            numbered.append((bins.slot, cuts, table, bins.doubt()))
        else:
            worded.append((bins.slot, table, other, bins.doubt()))
    full = masks.full

    def find(values: Values) -> tuple[int, int]:
        left, doubtful = full, 0
        for slot, table, other, doubt in worded:
            value = values[slot]
            left &= table.get(value, other)
            if value is None:
                doubtful |= doubt
        for slot, cuts, table, doubt in numbered:
            value = values[slot]
            if value is None:
                left &= table[None]
                doubtful |= doubt
            else:
                place = bisect_left(cuts, value)
                left &= table[2 * place + 1 if place < len(cuts) and cuts[place] == value else 2 * place]
        return left, doubtful

    return find


def set_bits(mask: int) -> Iterator[int]:
    """The places of the ones, ascending."""
    digits = bin(mask)[:1:-1]
    place = digits.find("1")
    while place >= 0:
        yield place
        place = digits.find("1", place + 1)
