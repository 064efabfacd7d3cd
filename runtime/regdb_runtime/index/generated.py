"""One Python function per bucket: nested gates over shared parts, so that rules behind a false gate cost nothing."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from threading import Lock
from typing import Any

from regdb.regulation import Regulation
from regdb_runtime.index.bucket import Bucket, Decide, Part
from regdb_runtime.index.conjuncts import chance, conjuncts
from regdb_runtime.index.expressions import Expressions
from regdb_runtime.index.settle import Tangle
from regdb_runtime.index.slots import FactTable

_DEEPEST_NEST = 60


@dataclass(frozen=True, slots=True)
class Test:
    """One part of a rule's condition as source: `possibly` lets the rule through, `surely` makes it certain."""

    possibly: str
    surely: str
    chance: float


@dataclass(frozen=True, slots=True)
class Item:
    """A rule on its way down the nest: the tests left by their source, and the one that decides between sure and maybe."""

    part: Part
    left: dict[str, Test]
    surely: str

    def without(self, possibly: str) -> Item:
        return Item(self.part, {text: test for text, test in self.left.items() if text != possibly}, self.surely)


class Generator:
    """Compiles buckets of one database. What rules have in common across buckets is written and compiled once."""

    def __init__(self, table: FactTable) -> None:
        self.expressions = Expressions(table)
        self._tests: dict[int, tuple[Regulation, tuple[dict[str, Test], str] | None]] = {}  # holds the rule, so that its id stays its own
        self._lock = Lock()

    def generate(self, bucket: Bucket) -> Decide:
        """Compile a bucket into one function of the values."""
        with self._lock:
            make = self._run(self.write(bucket), "make")
        decide: Decide = make(bucket.finish, Tangle(bucket).settle, ("legal", (), ()))
        return decide

    def write(self, bucket: Bucket) -> str:
        """The source of a bucket's function."""
        writer = _Writer(bucket, self.expressions)
        found = ((part, self.tests(part.rule)) for part in bucket.candidates)
        writer.nest([Item(part, *tests) for part, tests in found if tests is not None], 2)
        head = ["def make(finish, settle, nothing):", " def decide(f):", "  b = []; u = []; l = []; e = ()"]
        tail = ["  return finish(b, u, l, e, f) if b or u or l or e else nothing", " return decide"]
        if writer.tangled:
            head.append("  s = []; m = []")
            tail.insert(0, "  if s or m: e = settle(s, m, f, b, u, l)")
        return "\n".join([*head, *writer.lines, *tail, ""])

    def tests(self, rule: Regulation) -> tuple[dict[str, Test], str] | None:
        """A rule's tests, rarest first, and the expression that makes it certain; None for one that can never hold."""
        found = self._tests.get(id(rule))
        if found is None:
            found = self._tests[id(rule)] = rule, self._read(rule)
        return found[1]

    def _read(self, rule: Regulation) -> tuple[dict[str, Test], str] | None:
        tests = []
        for node in conjuncts(rule):
            possibly, surely = self.expressions.pair(node)
            if possibly == "False":
                return None
            if possibly != "True":
                tests.append(Test(possibly, surely, chance(node)))
        tests.sort(key=lambda test: test.chance)
        certain = [test.surely for test in tests if test.surely != test.possibly]
        return {test.possibly: test for test in tests}, self._sure(certain)

    def _sure(self, tests: list[str]) -> str:
        """The tests as one expression; several become a function of their own, compiled once for all buckets."""
        if len(tests) < 2:
            return tests[0] if tests else ""
        text = " and ".join(tests)
        return self.expressions.hold(self._run(f"def sure(f): return {text}\n", "sure"), ("sure", text)) + "(f)"

    def _run(self, source: str, name: str) -> Any:
        """Define a function over the constants. The source is made of checked nodes only, see `expressions`."""
        names = self.expressions.names
        exec(compile(source, "<regdb bucket>", "exec"), names)
        return names.pop(name)


class _Writer:
    def __init__(self, bucket: Bucket, expressions: Expressions) -> None:
        self.bucket, self.expressions = bucket, expressions
        self.lines: list[str] = []
        self.tangled = False

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
            self.nest([item.without(gate) for item in items if gate in item.left], level + 1)
            items = [item for item in items if gate not in item.left]

    def _single(self, item: Item, level: int) -> None:
        self._line(level, f"if {' and '.join(item.left)}:")
        self.leaf(item, level + 1)

    def leaf(self, item: Item, level: int) -> None:
        """Write what happens when every part of a rule is possible."""
        if not item.surely:
            self._holds(item.part, level, sure=True)
            return
        self._line(level, f"if {item.surely}:")
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
        self._line(level, f"x = {self.expressions.hold(self.bucket.beyond(index), ('beyond', id(part.rule)))}(f)")
        self._line(level, f"if x is not False: {'(b if x else u)' if sure else 'u'}.append({index})")

    def _line(self, level: int, text: str) -> None:
        self.lines.append(" " * level + text)


def _gate(items: list[Item]) -> str | None:
    """The test that keeps most work behind it; None when no two rules share one."""
    shared = Counter(text for item in items for text in item.left)
    if not shared or max(shared.values()) < 2:
        return None
    likely = {text: test.chance for item in items for text, test in item.left.items()}
    return max(shared, key=lambda text: ((shared[text] - 1) * (1.05 - likely[text]), text))
