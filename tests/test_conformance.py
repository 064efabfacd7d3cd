"""The meaning of a rule, from YAML to verdict: the shared cases, and random ones against the reference."""

from __future__ import annotations

import datetime
import random
from pathlib import Path
from typing import Any

import pytest
import yaml
from conformance import judge, plain
from hypothesis import given, settings
from hypothesis import strategies as st
from neutral_facts import infer_facts
from random_law import trees

from regdb.condition import Compare, Is, Known, Linear, Node, OneOf
from regdb.condition_text import show
from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.meaning import decide, governing
from regdb.regulation import Limit, Regulation
from regdb.situation import Plan, Scene, Situation
from regdb.vocabulary import Assumption, Fact, Vocabulary

SHARED = Path(__file__).parents[2] / "shared" / "conformance" / "cases.yaml"
CASES: list[dict[str, Any]] = yaml.safe_load(SHARED.read_text("utf-8")) if SHARED.is_file() else []
TREE = {"model": {"status": "model"}, "state": {"parent": "model"}, "city": {"parent": "state"}, "county": {"parent": "state"}}
DAYS = ("2025-12-31", "2026-01-01", "2026-01-02")
STOP, STRAIGHT, RIGHT = (f"intersection_handling.{name}" for name in ("stop", "go_straight", "turn_right"))


@pytest.mark.skipif(not CASES, reason=f"the shared cases are not there: {SHARED}")
@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_shared_case(case: dict[str, Any]) -> None:
    answer = judge(case)
    for key, wanted in case["expect"].items():
        found = answer.get(key)
        assert (sorted(found) if isinstance(found, list) else found) == (sorted(wanted) if isinstance(wanted, list) else wanted), answer


LEAVES: st.SearchStrategy[Node] = st.one_of(
    st.sampled_from(("b0", "b1", "b2", "assumed")).map(Is),
    st.sampled_from(("red", "green")).map(lambda word: OneOf("color", (word,))),
    st.builds(
        lambda op, n: Compare(op, Linear(0.0, ((1.0, "distance"),)), Linear(n), "count", ""),
        st.sampled_from(("<", "<=", ">", ">=", "==", "!=")),
        st.sampled_from((1.0, 2.5, 4.0)),
    ),
    st.sampled_from(("b0", "assumed")).map(Known),
)
VOCABULARY = Vocabulary(
    [
        Fact("b0", "boolean"), Fact("b1", "boolean"), Fact("b2", "boolean"), Fact("assumed", "boolean", assumption=Assumption(value=False)),
        Fact("color", "enumeration", values=("red", "green")), Fact("distance", "count"), Fact("speed", "count"), Fact("gap", "count"),
    ]
)  # fmt: skip


@st.composite
def rules(draw: st.DrawFn, number: int, earlier: list[Regulation]) -> Regulation:
    """One rule that may except earlier ones of its jurisdiction, or override earlier ones above it."""
    owner = draw(st.sampled_from(list(TREE)))
    tree = _tree()
    own = [rule.id for rule in earlier if rule.jurisdiction == owner]
    above = [rule.id for rule in earlier if tree.is_ancestor(rule.jurisdiction, owner)]
    excepted = tuple(draw(st.lists(st.sampled_from(own), max_size=2, unique=True))) if own else ()
    overridden = tuple(draw(st.lists(st.sampled_from(above), max_size=1))) if above else ()
    legality = bool(excepted or overridden) and draw(st.booleans())
    limits = draw(st.dictionaries(st.sampled_from(("max_speed", "min_gap")), st.sampled_from((2.0, 3.5, 5.0)), max_size=2))
    first, last = draw(st.sampled_from((None, *DAYS))), draw(st.sampled_from((None, "2026-01-02", "2026-01-03")))
    if first is not None and last is not None and first >= last:
        last = None
    return Regulation(
        id=f"r-{number}", citation="", jurisdiction=owner, legality=legality, effective=_day(first), until=_day(last),
        when=draw(trees(LEAVES, 4)), unless=draw(st.one_of(st.none(), trees(LEAVES, 3))),
        limits=() if legality else tuple(Limit(n, n[4:], n[:3], Linear(b)) for n, b in limits.items()),
        force=draw(st.sampled_from(("absolute", "penalty_tier", "advisory"))) if limits and not legality else "",
        current=draw(st.sampled_from((None, frozenset({STOP})))), next=draw(st.sampled_from((None, frozenset({RIGHT})))),
        targets=(*excepted, *overridden), overrides=overridden,
    )  # fmt: skip


@st.composite
def rule_lists(draw: st.DrawFn) -> list[Regulation]:
    found: list[Regulation] = []
    for number in range(draw(st.integers(1, 5))):
        found.append(draw(rules(number, found)))
    return found


SCENES = st.fixed_dictionaries(
    {},
    optional={
        "b0": st.booleans(), "b1": st.booleans(), "b2": st.booleans(), "assumed": st.booleans(),
        "color": st.sampled_from(("red", "green")), "distance": st.sampled_from((0.5, 1.0, 2.5, 3.0, 4.0, 9.0)),
    },
)  # fmt: skip
PLANS = st.fixed_dictionaries(
    {"current": st.just("stop"), "next": st.sampled_from(("turn_right", "go_straight"))},
    optional={"speed": st.sampled_from((1.0, 2.0, 3.5, 6.0)), "gap": st.sampled_from((1.0, 3.5, 6.0))},
)


@st.composite
def questions(draw: st.DrawFn) -> tuple[list[Regulation], dict[str, Any]]:
    """Rules as the reference takes them, and the same question as a neutral case."""
    found = draw(rule_lists())
    case = {
        "rules": [_neutral(rule) for rule in found], "scene": draw(SCENES), "plan": draw(PLANS), "jurisdictions": TREE,
        "place": draw(st.sampled_from(list(TREE))), "date": draw(st.sampled_from(DAYS)), "policy": {"assumed": {"assume": False}},
    }  # fmt: skip
    return found, case


def _neutral(rule: Regulation) -> dict[str, Any]:
    data: dict[str, Any] = {"id": rule.id, "legality": rule.legality, "when": show(rule.when), "jurisdiction": rule.jurisdiction}
    data |= {"unless": show(rule.unless)} if rule.unless is not None else {}
    data |= {"limits": {limit.attribute: limit.bound.constant for limit in rule.limits}} if rule.limits else {}
    data |= {"force": rule.force} if rule.force else {}
    excepted = [target for target in rule.targets if target not in rule.overrides]
    data |= {key: names for key, names in (("exception_to", excepted), ("overrides", list(rule.overrides))) if names}
    data |= {"authority": "s1"} if rule.jurisdiction in {"city", "county"} else {}
    data |= {"effective": _iso(rule.effective)} if rule.effective else {}
    data |= {"until": _iso(rule.until)} if rule.until else {}
    states = {"current": ["stop"] if rule.current else None, "next": ["turn_right"] if rule.next else None}
    return data | {"states": {key: names for key, names in states.items() if names}}


def _tree() -> JurisdictionTree:
    return JurisdictionTree(Jurisdiction(name, name, parent=item.get("parent"), status=item.get("status", "law")) for name, item in TREE.items())


def _day(text: str | None) -> int | None:
    return None if text is None else datetime.date.fromisoformat(text).toordinal()


def _iso(day: int) -> str:
    return datetime.date.fromordinal(day).isoformat()


def reference(found: list[Regulation], case: dict[str, Any]) -> dict[str, Any]:
    """The answer by regdb.meaning alone."""
    in_force = governing(found, _tree(), case["place"], _day(case["date"]) or 0)
    facts = {name: value for name, value in case["plan"].items() if name not in {"current", "next"}}
    plan = Plan(STOP, {"turn_right": RIGHT, "go_straight": STRAIGHT}[case["plan"]["next"]], facts)
    decision = decide(in_force, Situation(VOCABULARY, Scene(case["scene"]), plan))
    return {
        "verdict": decision.verdict,
        "deciding": sorted(rule.id for rule in decision.deciding),
        "limits": {name: plain(item.bound) for name, item in sorted(decision.combined.items())},
        "assumed": sorted(decision.assumed),
        "unknown": sorted(decision.missing),
    }


@settings(max_examples=60, deadline=None)
@given(questions())
def test_compiler_database_and_runtime_answer_as_the_reference(question: tuple[list[Regulation], dict[str, Any]]) -> None:
    found, case = question
    assert judge(case) == reference(found, case)


@settings(max_examples=25, deadline=None)
@given(questions(), st.randoms(use_true_random=False))
def test_order_of_rules_files_and_keys_changes_nothing(question: tuple[list[Regulation], dict[str, Any]], chance: random.Random) -> None:
    case = question[1]
    assert judge(_shuffled(case, chance)) == judge(case)


def _shuffled(value: Any, chance: random.Random) -> Any:
    if isinstance(value, dict):
        keys = list(value)
        chance.shuffle(keys)
        return {key: _shuffled(value[key], chance) for key in keys}
    if isinstance(value, list):
        return [_shuffled(item, chance) for item in chance.sample(value, len(value))]
    return value


def test_types_are_inferred_from_every_mention() -> None:
    case = {
        "rules": [
            {"id": "a", "when": "red and color == amber and speed > 2 * other and clock within 07:00..16:00 and ramp in kinds"},
            {"id": "b", "when": "gap < 3 ft and left == right and kind in {x, y}", "limits": {"max_v": "posted"}},
        ],
        "scene": {"color": "green", "right": 4},
    }
    kinds = {name: fact.kind for name, fact in infer_facts(case).items()}
    assert kinds == {
        "red": "boolean", "color": "enumeration", "speed": "count", "other": "count", "clock": "time", "kinds": "set", "gap": "quantity",
        "left": "count", "right": "count", "kind": "enumeration", "v": "count", "posted": "count",
    }  # fmt: skip
    assert list(infer_facts(case)["color"].words) == ["green", "amber"]


def test_an_error_no_case_names_is_told_by_its_own_name() -> None:
    assert judge({"rules": [{"id": "a", "legality": False, "when": "red ="}]}) == {"error": "condition-syntax"}
