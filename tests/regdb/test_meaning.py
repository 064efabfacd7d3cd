"""What a rule means, against its definition: days, defeat, limits, verdicts."""

from __future__ import annotations

import random
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_law import PLAN, VOCABULARY, clearance, known_facts, rule_sets, situations, speed_limit

from regdb.condition import TRUE, Is, Node, Not, evaluate
from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.meaning import Decision, Judgement, LimitInForce, combine, decide, governing
from regdb.regulation import Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.truth import Truth, conjoin, disjoin, negate
from regdb.units import to_si
from regdb.vocabulary import Value

ONE = JurisdictionTree([Jurisdiction("state", "State")])
DAY = 740000


def rule(name: str, when: Node = TRUE, **more: object) -> Regulation:
    return Regulation(**{"id": name, "citation": f"T {name}", "jurisdiction": "state", "legality": False, "when": when, **more})  # type: ignore[arg-type]


def decision(rules: Sequence[Regulation], plan: Plan = PLAN, **facts: Value) -> Decision:
    return decide(rules, Situation(VOCABULARY, Scene(facts), plan))


@pytest.mark.parametrize(
    ("effective", "until", "days"),
    [(DAY, None, {0, 1}), (None, DAY, {-1}), (DAY, DAY + 1, {0}), (None, None, {-1, 0, 1}), (DAY, DAY, set()), (DAY + 1, DAY + 2, {1})],
)
def test_intervals_are_half_open_on_the_day_before_the_day_and_the_day_after(effective: int | None, until: int | None, days: set[int]) -> None:
    found = rule("a", effective=effective, until=until)
    assert {shift for shift in (-1, 0, 1) if found.in_force(DAY + shift)} == days
    assert {shift for shift in (-1, 0, 1) if governing([found], ONE, "state", DAY + shift)} == days


@given(st.integers(-3, 3), st.integers(-3, 3), st.integers(-3, 3))
def test_versions_that_meet_leave_no_gap_and_no_overlap(first: int, change: int, day: int) -> None:
    earlier, later = rule("a", effective=DAY + first, until=DAY + change), rule("a", effective=DAY + change)
    in_force = governing([earlier, later], ONE, "state", DAY + day)
    assert len(in_force) == (day >= min(first, change) if first <= change else day >= change)


def _effective(item: Regulation, rules: Sequence[Regulation], situation: Situation) -> Truth:
    """The definition, word for word and without memory."""
    unless = False if item.unless is None else evaluate(item.unless, situation)
    holds = conjoin((evaluate(item.when, situation), negate(unless)))
    return conjoin((holds, negate(disjoin(_effective(other, rules, situation) for other in rules if item.id in other.targets))))


@given(rule_sets(), situations())
def test_effective_is_holds_and_not_defeated(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    assert [judgement.effective(item) for item in rules] == [_effective(item, rules, situation) for item in rules]


@given(rule_sets(), situations())
def test_the_verdict_and_who_decides_it(rules: tuple[Regulation, ...], situation: Situation) -> None:
    judgement = Judgement(rules, situation)
    breaches = {item.id: judgement.breaks(item) for item in rules}
    found = judgement.decision
    wanted = "illegal" if True in breaches.values() else "unknown" if None in breaches.values() else "legal"
    assert found.verdict == wanted
    deciding = {item.id for item in found.deciding}
    if wanted == "illegal":
        assert deciding == {name for name, breach in breaches.items() if breach is True}
    elif wanted == "unknown":
        assert deciding == {name for name, breach in breaches.items() if breach is None}
    assert bool(found.missing) == (wanted == "unknown")


@given(rule_sets(), situations(), st.randoms(use_true_random=False))
def test_order_changes_nothing(rules: tuple[Regulation, ...], situation: Situation, chance: random.Random) -> None:
    mixed = decide(chance.sample(rules, len(rules)), situation)
    found = decide(rules, situation)
    assert mixed.verdict == found.verdict
    for name in ("deciding", "limits", "possible", "missing", "assumed"):
        assert set(getattr(mixed, name)) == set(getattr(found, name))
    assert {name: item.bound for name, item in mixed.combined.items()} == {name: item.bound for name, item in found.combined.items()}


@given(rule_sets(), situations(), st.data())
def test_learning_more_never_turns_legal_into_illegal(rules: tuple[Regulation, ...], situation: Situation, data: st.DataObject) -> None:
    """Assumptions aside, which are kept as they were."""
    before = decide(rules, situation).verdict
    facts = {**data.draw(known_facts()), **situation.scene.facts}
    if "engine.near" not in situation.scene.facts:
        facts.pop("engine.near", None)
    after = decide(rules, Situation(VOCABULARY, Scene(facts), PLAN)).verdict
    assert before in ("unknown", after)


@pytest.mark.parametrize(
    ("speed", "gap", "verdict", "deciding"),
    [
        (25.0, 3.0, "legal", []), (25.001, 3.0, "illegal", ["a"]), (25.0, 2.999, "illegal", ["a"]), (None, 3.0, "unknown", ["a"]),
        (30.0, None, "illegal", ["a"]), (20.0, 4.0, "legal", []),
    ],
)  # fmt: skip
def test_the_bound_itself_is_within_the_limit(speed: float | None, gap: float | None, verdict: str, deciding: list[str]) -> None:
    numbers = {"plan.speed": (speed, "mph"), "plan.clearance": (gap, "ft")}
    plan = Plan(PLAN.current, PLAN.next, {name: to_si(number, unit) for name, (number, unit) in numbers.items() if number is not None})
    found = decision([rule("a", limits=(speed_limit(25), clearance(3)), force="absolute")], plan)
    assert found.verdict == verdict
    assert [item.id for item in found.deciding] == deciding


@pytest.mark.parametrize(("force", "verdict", "limits"), [("absolute", "illegal", 1), ("basic", "illegal", 1), ("prima_facie", "illegal", 1),
                                                          ("penalty_tier", "illegal", 0), ("advisory", "legal", 0)])  # fmt: skip
def test_what_the_force_of_a_limit_does(force: str, verdict: str, limits: int) -> None:
    found = decision([rule("a", limits=(speed_limit(25),), force=force)], Plan(PLAN.current, PLAN.next, {"plan.speed": to_si(30, "mph")}))
    assert found.verdict == verdict
    assert len(found.limits) == limits


@given(st.lists(st.integers(1, 99), min_size=1), st.lists(st.integers(1, 99), min_size=1))
def test_limits_combine_to_the_strictest(speeds: list[int], gaps: list[int]) -> None:
    made = [*map(speed_limit, speeds), *map(clearance, gaps)]
    items = [rule(f"r{number}", limits=(limit,)) for number, limit in enumerate(made)]
    combined = combine(LimitInForce(item.limits[0], item.limits[0].bound.constant, item) for item in items)
    assert combined["max_speed"].bound == to_si(float(min(speeds)), "mph")
    assert combined["min_clearance"].bound == to_si(float(max(gaps)), "ft")


def test_states_narrow_which_rules_are_concerned() -> None:
    here, elsewhere = rule("a", current=frozenset({PLAN.current}), next=frozenset({PLAN.next})), rule("b", next=frozenset({"elsewhere"}))
    assert [item.id for item in decision([here, elsewhere]).deciding] == ["a"]


def test_an_unknown_exception_leaves_unknown_and_names_what_would_settle_it() -> None:
    rules = [rule("a", Is("red")), rule("b", Is("stopped"), legality=True, targets=("a",), unless=Is("sign.seen"))]
    assert decision(rules, red=True).missing == ("stopped", "sign.seen")
    assert decision(rules, red=True, stopped=False).verdict == "illegal"
    assert decision(rules, red=True, stopped=True, **{"sign.seen": False}).verdict == "legal"
    assert [item.id for item in decision(rules, red=True, stopped=True, **{"sign.seen": False}).deciding] == ["b"]


def test_an_exception_to_the_exception_restores_the_rule() -> None:
    rules = [
        rule("a", Is("red")),
        rule("b", Is("stopped"), legality=True, targets=("a",)),
        rule("c", Not(Is("officer")), legality=True, targets=("b",)),
    ]
    assert decision(rules, red=True, stopped=True, officer=False).verdict == "illegal"
    assert decision(rules, red=True, stopped=True, officer=True).verdict == "legal"
    assert decision(rules, red=True, stopped=True).verdict == "unknown"


def test_limits_of_rules_that_may_be_in_effect_are_possible_limits() -> None:
    found = decision([rule("a", Is("red"), limits=(speed_limit(25),)), rule("b", limits=(speed_limit(55),))])
    assert [item.regulation.id for item in found.limits] == ["b"]
    assert [item.regulation.id for item in found.possible] == ["a"]


def test_assumptions_that_stood_in_are_told() -> None:
    assert decision([rule("a", Is("engine.near"))]).assumed == ("engine.near",)
    assert decision([rule("a", Is("engine.near"))], **{"engine.near": False}).assumed == ()
