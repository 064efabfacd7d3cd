"""One Python function per bucket: nested gates over shared parts, so that rules behind a false gate cost nothing."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from regdb_runtime.index.bucket import Bucket, Decide, Part
from regdb_runtime.index.conjuncts import chance
from regdb_runtime.index.expressions import Expressions
from regdb_runtime.index.settle import Tangle

_DEEPEST_NEST = 60


@dataclass(frozen=True, slots=True)
class Test:
    """One part of a rule's condition as source: `possibly` lets the rule through, `surely` makes it certain."""

    possibly: str
    surely: str
    chance: float


@dataclass(frozen=True, slots=True)
class Item:
    """A rule on its way down the nest: the tests left, and those that decide between sure and maybe."""

    part: Part
    left: tuple[Test, ...]
    surely: tuple[str, ...]

    def without(self, possibly: str) -> Item:
        return Item(self.part, tuple(test for test in self.left if test.possibly != possibly), self.surely)


def generate(bucket: Bucket) -> Decide:
    """Compile a bucket into one function of the values."""
    source, names = write(bucket)
    space: dict[str, Any] = {"__builtins__": {}, **names}
    exec(compile(source, "<regdb bucket>", "exec"), space)  # made of checked nodes only, see expressions
    decide: Decide = space["decide"]
    return decide


def write(bucket: Bucket) -> tuple[str, dict[str, object]]:
    """The source of a bucket's function and the constants it names."""
    writer = _Writer(bucket)
    writer.nest([item for part in bucket.candidates if (item := writer.item(part)) is not None], 1)
    head = ["def decide(f):", " b = []; u = []; l = []; e = ()"]
    tail = [" return finish(b, u, l, e, f) if b or u or l or e else nothing"]
    if writer.tangled:
        head.append(" s = []; m = []")
        tail.insert(0, " if s or m: e = settle(s, m, f, b, u, l)")
    names: dict[str, object] = dict(writer.expressions.names)
    names |= {"finish": bucket.finish, "settle": Tangle(bucket).settle, "nothing": ("legal", (), ())}
    return "\n".join([*head, *writer.lines, *tail, ""]), names


class _Writer:
    def __init__(self, bucket: Bucket) -> None:
        self.bucket = bucket
        self.expressions = Expressions(bucket.table)
        self.lines: list[str] = []
        self.tangled = False

    def item(self, part: Part) -> Item | None:
        """A rule with its tests, rarest first; None for one that can never hold."""
        tests = []
        for node in self.bucket.conjuncts[part.index]:
            possibly, surely = self.expressions.pair(node)
            if possibly == "False":
                return None
            if possibly != "True":
                tests.append(Test(possibly, surely, chance(node)))
        tests.sort(key=lambda test: test.chance)
        return Item(part, tuple(tests), tuple(test.surely for test in tests if test.surely != test.possibly))

    def nest(self, items: list[Item], level: int) -> None:
        """Write the rules, those that share a test under that test."""
        for item in [item for item in items if not item.left]:
            self.leaf(item, level)
        items = [item for item in items if item.left]
        while items:
            gate = _gate(items) if level < _DEEPEST_NEST else None
            if gate is None:
                for item in items:
                    self._single(item, level)
                return
            self._line(level, f"if {gate}:")
            self.nest([item.without(gate) for item in items if _has(item, gate)], level + 1)
            items = [item for item in items if not _has(item, gate)]

    def _single(self, item: Item, level: int) -> None:
        self._line(level, f"if {' and '.join(test.possibly for test in item.left)}:")
        self.leaf(item, level + 1)

    def leaf(self, item: Item, level: int) -> None:
        """Write what happens when every part of a rule is possible."""
        if not item.surely:
            self._holds(item.part, level, sure=True)
            return
        self._line(level, f"if {' and '.join(item.surely)}:")
        self._holds(item.part, level + 1, sure=True)
        self._line(level, "else:")
        self._holds(item.part, level + 1, sure=False)

    def _holds(self, part: Part, level: int, *, sure: bool) -> None:
        index = part.index
        if part.tangled:
            self.tangled = True
            self._line(level, f"{'s' if sure else 'm'}.append({index})")
            return
        if part.limiting and sure:
            self._line(level, f"l.append({index})")
        if not part.breakable:
            self._line(level, "pass")
        elif not part.rule.limits:
            self._line(level, f"{'b' if sure else 'u'}.append({index})")
        else:
            self._past(part, level, sure=sure)

    def _past(self, part: Part, level: int, *, sure: bool) -> None:
        """Write the test of a rule's limits; a single fixed bound stands in the source."""
        limit, index = part.rule.limits[0], part.index
        if len(part.rule.limits) == 1 and not limit.bound.terms and limit.fact in self.bucket.table.slots:
            past = f"x {'>' if limit.direction == 'max' else '<'} {self.expressions.number(limit.bound.constant)}"
            self._line(level, f"x = f[{self.bucket.table.slots[limit.fact]}]")
            if sure:
                self._line(level, f"if x is None: u.append({index})")
                self._line(level, f"elif {past}: b.append({index})")
            else:
                self._line(level, f"if x is None or {past}: u.append({index})")
            return
        self._line(level, f"x = {self.expressions.hold(self.bucket.beyond(index), ('beyond', index))}(f)")
        self._line(level, f"if x is not False: {'(b if x else u)' if sure else 'u'}.append({index})")

    def _line(self, level: int, text: str) -> None:
        self.lines.append(" " * level + text)


def _has(item: Item, possibly: str) -> bool:
    return any(test.possibly == possibly for test in item.left)


def _gate(items: list[Item]) -> str | None:
    """The test that keeps most work behind it; None when no two rules share one."""
    shared = Counter(test.possibly for item in items for test in item.left)
    if not shared or max(shared.values()) < 2:
        return None
    likely = {test.possibly: test.chance for item in items for test in item.left}
    return max(shared, key=lambda text: ((shared[text] - 1) * (1.05 - likely[text]), text))
