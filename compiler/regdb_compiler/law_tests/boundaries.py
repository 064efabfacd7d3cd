"""Scenes below, at and above every number of the law: made from a test's scene in which the number decides, and judged.

What should come out is said here by itself, never by the evaluator: a table of operators for conditions, and for limits that the
bound is lawful and what lies beyond it is not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from regdb.condition import FALSE, TRUE, And, Compare, Linear, Literal, Node, Not, Or, Within, evaluate, linear_value, literals
from regdb.condition_text import show
from regdb.counterfactual import Wish, with_wishes
from regdb.meaning import Judgement
from regdb.regulation import Limit, Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.truth import Truth, conjoin, negate
from regdb.turning import changes
from regdb.vocabulary import Value
from regdb_compiler.diagnostics import Place
from regdb_compiler.law_tests.judge import judge_tests
from regdb_compiler.law_tests.literal_place import place_of_literal
from regdb_compiler.lower import Row

if TYPE_CHECKING:
    from regdb_compiler.driver import Build

SIDES = ("below", "at", "above")

_TRUE_ON = {
    "<": (True, False, False), "<=": (True, True, False), ">": (False, False, True), ">=": (False, True, True),
    "==": (False, True, False), "!=": (True, False, True),
}  # fmt: skip
"""Operator -> its truth below, at and above the number."""

_NEAR = 1e-6
"""How far beside the number a scene lies, of the number itself: past what conversion between units can blur, short of what law can mean."""


@dataclass(frozen=True, slots=True)
class Boundary:
    """One number: `shown` are the sides on which some law test lets it decide; `built` whether a scene could be made.

    `wrong` says of each side that came out otherwise than the number says.
    """

    regulation: str
    what: str
    place: Place
    shown: frozenset[str]
    built: bool
    wrong: tuple[str, ...] = ()

    @property
    def missing(self) -> tuple[str, ...]:
        """Sides no law test shows."""
        return tuple(side for side in SIDES if side not in self.shown)


@dataclass(frozen=True)
class Boundaries:
    """All numbers asked for."""

    numbers: tuple[Boundary, ...]

    @property
    def wrong(self) -> tuple[Boundary, ...]:
        return tuple(item for item in self.numbers if item.wrong)

    @property
    def not_built(self) -> tuple[Boundary, ...]:
        return tuple(item for item in self.numbers if not item.built)


@dataclass(frozen=True)
class _Number:
    """A number of one row, as what is compared with what: `truths` of the rule below, at and above, where the number decides."""

    row: Row
    what: str
    place: Place
    left: Linear
    right: Linear
    step: float
    truths: tuple[bool, bool, bool]
    decides: Callable[[Situation], bool]
    wishes: Callable[[Situation], Iterable[Wish] | None]
    answer: Callable[[Judgement], Truth]

    def side(self, situation: Situation) -> str | None:
        """On which side of the number a situation lies; None where a fact is unknown."""
        a, b = linear_value(self.left, situation), linear_value(self.right, situation)
        return None if a is None or b is None else SIDES[(a >= b) + (a > b)]


def boundaries(build: Build, wanted: Callable[[str], bool] = lambda _: True) -> Boundaries:
    """Judge every number of the files that are wanted, from the situations of the law tests that pass."""
    beside: dict[str, list[Judgement]] = {}
    for outcome in judge_tests(build, build.law_tests):
        if outcome.status == "passed" and outcome.judgement is not None:
            for rule in outcome.judgement.rules if outcome.test.entry is not None else ():
                beside.setdefault(rule.id, []).append(outcome.judgement)
    rows = (row for row in build.rows if wanted(row.entry.file.path))
    return Boundaries(tuple(_judged(number, beside.get(number.row.regulation.id, ())) for row in rows for number in _numbers(row)))


def _judged(number: _Number, judgements: Iterable[Judgement]) -> Boundary:
    rule = number.row.regulation
    own = [judgement for judgement in judgements if any(other is rule for other in judgement.rules)]
    deciding = [item for item in own if number.decides(item.situation) and rule in item.concerned]
    sides = (number.side(item.situation) for item in deciding)
    shown = frozenset(side for side in sides if side is not None)
    for judgement in (*deciding, *own):
        scenes = _scenes(number, judgement)
        if scenes is not None:
            return Boundary(rule.id, number.what, number.place, shown, built=True, wrong=tuple(_wrong(number, scenes)))
    return Boundary(rule.id, number.what, number.place, shown, built=False)


def _wrong(number: _Number, scenes: tuple[Judgement, ...]) -> Iterator[str]:
    for side, judgement, expected in zip(SIDES, scenes, number.truths, strict=True):
        found = number.answer(judgement)
        if found is not expected:
            yield f"{side}: the number says {str(expected).lower()}, the judge {str(found).lower()}"


def _scenes(number: _Number, judgement: Judgement) -> tuple[Judgement, ...] | None:
    """The three scenes made from one situation, after the other literals are turned so that the number decides; None if they cannot be."""
    wishes = number.wishes(judgement.situation)
    start = None if wishes is None else with_wishes(judgement.situation, wishes)
    rule = number.row.regulation
    if start is None or not rule.concerns(start.plan.current, start.plan.next):
        return None
    found = []
    for position, wanted in enumerate(SIDES):
        moved = _at(number, start, (position - 1) * number.step)
        if moved is None or number.side(moved) != wanted or not number.decides(moved):
            return None
        found.append(Judgement(judgement.rules, moved))
    return tuple(found) if all(item.defeated(rule) is False for item in found) else None


def _at(number: _Number, situation: Situation, distance: float) -> Situation | None:
    """The situation with the first fact set so that left lies so far above right; facts not known count as nothing."""
    slopes: dict[str, float] = {}
    for sign, side in ((1.0, number.left), (-1.0, number.right)):
        for coefficient, fact in side.terms:
            slopes[fact] = slopes.get(fact, 0.0) + sign * coefficient
    turned = next((name for name, slope in slopes.items() if slope), None)
    if turned is None:
        return None
    values = {name: _number_of(situation.value(name)) for name in slopes}
    rest = sum(slope * values[name] for name, slope in slopes.items() if name != turned)
    equal = (number.right.constant - number.left.constant - rest) / slopes[turned]
    return _with(situation, {**values, turned: equal + distance / slopes[turned]})


def _number_of(value: Value | None) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0


def _with(situation: Situation, values: dict[str, float]) -> Situation:
    """Plan facts go into the plan, others into the scene."""
    known = situation.vocabulary.facts
    plan = {fact: value for fact, value in values.items() if known[fact].source == "plan" or fact in situation.plan.facts}
    scene = {**situation.scene.facts, **{fact: value for fact, value in values.items() if fact not in plan}}
    told = situation.plan
    return Situation(situation.vocabulary, Scene(scene, situation.scene.silent), Plan(told.current, told.next, {**told.facts, **plan}))


def _numbers(row: Row) -> Iterator[_Number]:
    """Every number of a row: in its conditions, then in its limits."""
    rule = row.regulation
    for part, node in (("when", rule.when), ("unless", rule.unless)):
        if node is not None:
            for literal in dict.fromkeys(literals(node)):
                yield from _of_literal(row, part, literal)
    if not rule.legality and rule.force != "advisory":
        yield from (_of_limit(row, position, limit) for position, limit in enumerate(rule.limits))


def _of_literal(row: Row, part: str, literal: Literal) -> Iterator[_Number]:
    rule = row.regulation
    if isinstance(literal, Compare):
        ends = [(literal.left, literal.right, _TRUE_ON[literal.op])]
    elif isinstance(literal, Within):
        fact = Linear(0.0, ((1.0, literal.fact),))
        ends = [(fact, Linear(literal.start), _TRUE_ON[">="]), (fact, Linear(literal.end), _TRUE_ON["<"])]
    else:
        return
    upright = _is_upright(rule, part, literal)
    if upright is None:
        return
    for position, (left, right, truths) in enumerate(ends):
        step = _step(literal.kind, right.constant)
        name = show(literal) if len(ends) == 1 else f"{show(literal)}, {('from', 'to')[position]}"
        a, b, c = (truth is upright for truth in truths)
        yield _Number(
            row, name, place_of_literal(row.entry, part, literal), left, right, step, (a, b, c),
            lambda situation: _decides(rule, literal, situation), lambda situation: _to_decide(rule, part, literal, situation),
            lambda judgement: judgement.holds(rule),
        )  # fmt: skip


def _step(kind: str, number: float) -> float:
    return 1.0 if kind in {"time", "date", "count"} else max(abs(number), 1.0) * _NEAR


def _is_upright(rule: Regulation, part: str, literal: Literal) -> bool | None:
    """Whether the rule holds where the literal is true, by counting what negates it; None where it stands both ways."""
    node = rule.when if part == "when" else rule.unless
    found = set(_signs(node, literal, part == "when")) if node is not None else set()
    return found.pop() if len(found) == 1 else None


def _signs(node: Node, literal: Literal, upright: bool) -> Iterator[bool]:
    match node:
        case And(parts) | Or(parts):
            for part in parts:
                yield from _signs(part, literal, upright)
        case Not(part):
            yield from _signs(part, literal, not upright)
        case _ if node == literal:
            yield upright


def _decides(rule: Regulation, literal: Literal, situation: Situation) -> bool:
    """Whether the rule holds or not by this literal alone, all else as it is."""
    answers = [_holds(rule, literal, truth, situation) for truth in (TRUE, FALSE)]
    return None not in answers and answers[0] is not answers[1]


def _holds(rule: Regulation, literal: Literal, truth: Node, situation: Situation) -> Truth:
    unless = rule.unless
    kept: Truth = True if unless is None else negate(evaluate(_put(unless, literal, truth), situation))
    return conjoin((evaluate(_put(rule.when, literal, truth), situation), kept))


def _put(node: Node, literal: Literal, truth: Node) -> Node:
    match node:
        case And(parts):
            return And(tuple(_put(part, literal, truth) for part in parts))
        case Or(parts):
            return Or(tuple(_put(part, literal, truth) for part in parts))
        case Not(part):
            return Not(_put(part, literal, truth))
        case _:
            return truth if node == literal else node


def _to_decide(rule: Regulation, part: str, literal: Literal, situation: Situation) -> tuple[Wish, ...] | None:
    """What must be otherwise for the literal to decide: parts joined with it by `and` true, by `or` false."""
    other, others_truth = (rule.unless, False) if part == "when" else (rule.when, True)
    own = rule.when if part == "when" else rule.unless
    found = [] if other is None else [changes(other, situation, others_truth)]
    found += [changes(sibling, situation, truth) for sibling, truth in _siblings(own or TRUE, literal)]
    if any(item is None for item in found):
        return None
    return tuple((change.literal, change.truth) for item in found for change in item or ())


def _siblings(node: Node, literal: Literal) -> Iterator[tuple[Node, bool]]:
    match node:
        case And(parts) | Or(parts):
            for part in parts:
                if literal in literals(part):
                    yield from _siblings(part, literal)
                else:
                    yield part, isinstance(node, And)
        case Not(part):
            yield from _siblings(part, literal)


def _of_limit(row: Row, position: int, limit: Limit) -> _Number:
    """A limit decides where its rule is in effect and no other limit of the rule is passed."""
    rule = row.regulation
    truths = (False, False, True) if limit.direction == "max" else (True, False, False)
    others = [item for number, item in enumerate(rule.limits) if number != position]

    def decides(situation: Situation) -> bool:
        alone = Judgement((rule,), situation)
        return alone.holds(rule) is True and all(alone.beyond(item) is False for item in others)

    def wishes(situation: Situation) -> tuple[Wish, ...] | None:
        when = changes(rule.when, situation, wanted=True)
        unless = () if rule.unless is None else changes(rule.unless, situation, wanted=False)
        return None if when is None or unless is None else tuple((change.literal, change.truth) for change in (*when, *unless))

    return _Number(
        row, f"{limit.attribute}: {limit.text}", row.entry.place("attributes", limit.attribute), Linear(0.0, ((1.0, limit.fact),)),
        limit.bound, _step("quantity", limit.bound.constant), truths, decides, wishes, lambda judgement: judgement.breaks(rule),
    )  # fmt: skip
