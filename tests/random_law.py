"""Random law for property tests: a small vocabulary, condition trees over it, scenes, and rule sets with exceptions."""

from __future__ import annotations

from hypothesis import strategies as st

from regdb.condition import And, Compare, Has, Is, Known, Linear, Literal, Node, Not, OneOf, Or, Within
from regdb.regulation import Limit, Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.units import to_si
from regdb.vocabulary import Assumption, Attribute, Fact, Value, Vocabulary

BOOLEANS = ("red", "stopped", "sign.seen", "officer")
ASSUMED = "engine.near"
VOCABULARY = Vocabulary(
    [
        *(Fact(name, "boolean", quiet=False) for name in BOOLEANS),
        Fact(ASSUMED, "boolean", assumption=Assumption(value=False, within="100 m", because="engines are reported"), quiet=False),
        Fact("signal.color", "enumeration", values=("red", "yellow", "green", "none"), quiet="none"),
        Fact("road.types", "set", values=("highway", "alley", "ramp"), quiet=frozenset()),
        Fact("ego.speed", "quantity", source="ego", unit="mph"),
        Fact("posted.speed", "quantity", source="map", unit="mph"),
        Fact("gap", "quantity", unit="ft"),
        Fact("lanes", "count", source="map"),
        Fact("clock.time", "time", source="clock"),
        Fact("clock.date", "date", source="clock"),
        Fact("plan.speed", "quantity", source="plan", unit="mph"),
        Fact("plan.clearance", "quantity", source="plan", unit="ft"),
    ],
    [
        Attribute("max_speed", "limit", "plan.speed", "max"),
        Attribute("min_clearance", "limit", "plan.clearance", "min"),
        Attribute("road_type", "scope", "road.types"),
    ],
)
OPERATORS = ("<", "<=", ">", ">=", "==", "!=")
SPEEDS = ("ego.speed", "posted.speed", "plan.speed")
PLAN = Plan("intersection_handling.stop", "intersection_handling.turn_right")

decimals = st.integers(1, 999).map(lambda n: n / 10)
coefficients = st.sampled_from((1.0, -1.0, 2.0, 0.5, -3.0))


@st.composite
def speed_comparisons(draw: st.DrawFn) -> Compare:
    """A linear expression of speeds against a literal in any unit of speed, or against another expression."""
    left = Linear(0.0, tuple(draw(st.lists(st.tuples(coefficients, st.sampled_from(SPEEDS)), min_size=1, max_size=2))))
    op = draw(st.sampled_from(OPERATORS))
    if draw(st.booleans()):
        unit = draw(st.sampled_from(("mph", "km/h", "m/s")))
        return Compare(op, left, Linear(to_si(draw(decimals), unit)), "quantity", unit)
    constant = draw(st.one_of(st.just(0.0), decimals.map(lambda n: to_si(n, "mph")), decimals.map(lambda n: -to_si(n, "mph"))))
    return Compare(op, left, Linear(constant, ((draw(coefficients), draw(st.sampled_from(SPEEDS))),)), "quantity", "mph")


def _compare(fact: str, kind: str, numbers: st.SearchStrategy[int]) -> st.SearchStrategy[Compare]:
    return st.builds(lambda op, n: Compare(op, Linear(0.0, ((1.0, fact),)), Linear(float(n)), kind, ""), st.sampled_from(OPERATORS), numbers)


times = st.integers(0, 86399)
dates = st.integers(700000, 760000)
words = st.lists(st.sampled_from(("red", "yellow", "green")), min_size=1, max_size=3, unique=True).map(lambda found: tuple(sorted(found)))
literals: st.SearchStrategy[Literal] = st.one_of(
    st.sampled_from(BOOLEANS).map(Is),
    st.builds(OneOf, st.just("signal.color"), words),
    st.builds(Has, st.just("road.types"), st.sampled_from(("highway", "alley", "ramp"))),
    speed_comparisons(),
    _compare("lanes", "count", st.integers(0, 6)),
    _compare("clock.time", "time", times),
    _compare("clock.date", "date", dates),
    st.builds(Within, st.just("clock.time"), times, times, st.just("time")),
    st.builds(Within, st.just("clock.date"), dates, dates, st.just("date")),
    st.sampled_from((*BOOLEANS, "ego.speed")).map(Known),
)


def _join(kind: type[And] | type[Or], children: st.SearchStrategy[Node]) -> st.SearchStrategy[Node]:
    """Parts that are of the same kind are taken in, as the parser does."""
    return st.lists(children, min_size=2, max_size=3).map(
        lambda parts: kind(tuple(p for part in parts for p in (part.parts if isinstance(part, kind) else (part,))))
    )


def trees(leaves: st.SearchStrategy[Node], max_leaves: int = 8) -> st.SearchStrategy[Node]:
    """Canonical condition trees over the leaves."""
    return st.recursive(leaves, lambda inner: st.one_of(inner.map(Not), _join(And, inner), _join(Or, inner)), max_leaves=max_leaves)


def _value(fact: Fact) -> st.SearchStrategy[Value]:
    if fact.kind == "boolean":
        return st.booleans()
    if fact.kind == "enumeration":
        return st.sampled_from(fact.values)
    if fact.kind == "set":
        return st.frozensets(st.sampled_from(fact.values))
    if fact.kind == "quantity":
        return decimals.map(lambda n: to_si(n, fact.unit))
    return {"count": st.integers(0, 6), "time": times, "date": dates}[fact.kind]


@st.composite
def known_facts(draw: st.DrawFn, names: tuple[str, ...] = tuple(VOCABULARY.facts)) -> dict[str, Value]:
    """Some of the facts with a value each; the others are unknown."""
    return {name: draw(_value(VOCABULARY.fact(name))) for name in names if draw(st.integers(0, 3))}


@st.composite
def situations(draw: st.DrawFn) -> Situation:
    return Situation(VOCABULARY, Scene(draw(known_facts())), PLAN)


def speed_limit(number: int) -> Limit:
    return Limit("max_speed", "plan.speed", "max", Linear(to_si(float(number), "mph")), "mph", f"{number} mph")


def clearance(number: int) -> Limit:
    return Limit("min_clearance", "plan.clearance", "min", Linear(to_si(float(number), "ft")), "ft", f"{number} ft")


limit_sets = st.lists(st.one_of(st.integers(2, 9).map(speed_limit), st.integers(2, 9).map(clearance)), max_size=2, unique_by=lambda x: x.attribute)


@st.composite
def rule_sets(draw: st.DrawFn, leaves: st.SearchStrategy[Node] | None = None, most: int = 5) -> tuple[Regulation, ...]:
    """Rules of one jurisdiction, exceptions only to earlier ones; a permission always names one."""
    conditions = trees(leaves if leaves is not None else st.sampled_from((*BOOLEANS, ASSUMED)).map(Is), 3)
    found: list[Regulation] = []
    for number in range(draw(st.integers(1, most))):
        targets = tuple(sorted(draw(st.sets(st.sampled_from([rule.id for rule in found]), max_size=2)))) if found else ()
        legality = bool(targets) and draw(st.booleans())
        limits = () if legality else tuple(draw(limit_sets)) if draw(st.integers(0, 2)) == 0 else ()
        found.append(
            Regulation(
                id=f"r{number}", citation=f"T {number}", jurisdiction="state", legality=legality, when=draw(conditions),
                unless=draw(st.one_of(st.none(), conditions)), limits=limits, force="absolute" if limits else "", targets=targets,
            )
        )  # fmt: skip
    return tuple(found)
