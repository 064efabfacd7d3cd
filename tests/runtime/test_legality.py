"""Verdicts: the conformance of small cases, what a verdict tells, and that what fails fails closed."""

from __future__ import annotations

import datetime
import json
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import DatabaseDamaged, RequestError
from regdb_runtime.legality import View, judge

from regdb.condition import And, Compare, Is, Known, Linear, Node, Not, OneOf
from regdb.meaning import decide
from regdb.regulation import Limit, Regulation
from regdb.situation import Plan, Scene, Situation

A, B, C = "drive.a", "drive.b", "drive.c"
SPEED = Linear(0.0, ((1.0, "q0"),))


@pytest.fixture
def law(random_law: Callable[[int], Any]) -> Any:
    return random_law(0)


@pytest.fixture
def view(law: Any) -> Callable[..., View]:
    def make(*rules: Regulation, place: str = "state", date: Any = "2026-03-02") -> View:
        return RegulationDatabase(law.vocabulary, law.machine, law.tree, rules).at(place, date)

    return make


def rule(name: str, when: Node | None = None, *targets: str, legality: bool = False, place: str = "state", **more: Any) -> Regulation:
    more |= {} if when is None else {"when": when}
    return Regulation(name, f"SC {name}", place, legality, targets=targets, **more)


def at_most(bound: float, fact: str = "q0", direction: str = "max") -> tuple[Limit, ...]:
    return (Limit(f"{direction}_{fact}", fact, direction, Linear(bound), "mph"),)


def test_a_verdict_tells_where_when_and_by_what(view: Callable[..., View]) -> None:
    here = view(rule("a", Is("b0"), limits=at_most(4.4704), force="absolute", quote="no faster"), place="sc")
    verdict = here.judge(Scene({"b0": True}), Plan(A, B, {"q0": 5.0}))
    assert (verdict.verdict, verdict.place, verdict.date, verdict.model) == ("illegal", "state", "2026-03-02", False)
    data = verdict.to_dict()
    assert json.loads(json.dumps(data)) == data
    assert data["limits"] == [
        {"attribute": "max_q0", "fact": "q0", "direction": "max", "value": 10.0, "unit": "mph", "si": 4.4704, "force": "absolute",
         "id": "a", "citation": "SC a"}
    ]  # fmt: skip
    assert data["deciding"][0]["quote"] == "no faster"
    assert data["combined"]["max_q0"]["si"] == 4.4704
    assert verdict.explain().turn[0].want == "q0 <= 10 mph"


def test_dates_are_taken_in_every_form(view: Callable[..., View]) -> None:
    old = rule("a", effective=730000, until=739000)
    for day in (738999, datetime.date.fromordinal(738999), datetime.date.fromordinal(738999).isoformat()):
        assert view(old, date=day).judge(Scene(), Plan(A, B)).verdict == "illegal"
        assert view(old, date=day).date == datetime.date.fromordinal(738999).isoformat()
    assert view(old, date=739000).judge(Scene(), Plan(A, B)).verdict == "legal"


def test_views_of_one_interval_share_their_compiled_rules(law: Any) -> None:
    database = RegulationDatabase(law.vocabulary, law.machine, law.tree, [rule("a", effective=739000)])
    assert database.at("city", 739001)._rules is database.at("city", 739500)._rules
    assert database.at("city", 738999)._rules is not database.at("city", 739000)._rules


def test_a_model_code_says_so_and_only_where_no_law_is(law: Any) -> None:
    model = rule("m", place="model")
    only = RegulationDatabase(law.vocabulary, law.machine, law.tree, [model])
    assert only.at("mc", 739000).judge(Scene(), Plan(A, B)).model
    both = RegulationDatabase(law.vocabulary, law.machine, law.tree, [model, rule("a", Is("b0"))])
    verdict = judge(both, Scene({"b0": False}), Plan(A, B), "state", 739000)
    assert (verdict.verdict, verdict.model) == ("legal", False)


def test_missing_and_assumed_are_told(view: Callable[..., View]) -> None:
    here = view(rule("a", And((Is("b0"), Is("b3")))))
    verdict = here.judge(Scene({}), Plan(A, B))
    assert (verdict.verdict, verdict.missing, verdict.assumed) == ("unknown", ("b0",), ("b3",))
    assert here.judge(Scene({}, frozenset({"b3"})), Plan(A, B)).missing == ("b0", "b3")
    assert verdict.to_dict()["assumed"][0]["value"] == "true"


def test_known_is_blind_to_assumptions(view: Callable[..., View]) -> None:
    here = view(rule("a", And((Is("b3"), Not(Known("b3"))))))
    assert here.judge(Scene({}), Plan(A, B)).verdict == "illegal"
    assert here.judge(Scene({"b3": True}), Plan(A, B)).verdict == "legal"
    assert here.judge(Scene({}), Plan(A, B, {"b3": True})).verdict == "legal"
    assert here.judge(Scene({"b3": None}), Plan(A, B, {"b3": None})).verdict == "illegal"  # type: ignore[dict-item]


def test_the_plan_speaks_before_the_scene(view: Callable[..., View]) -> None:
    here = view(rule("a", limits=at_most(5.0)))
    assert here.judge(Scene({"q0": 9.0}), Plan(A, B)).verdict == "illegal"
    assert here.judge(Scene({"q0": 9.0}), Plan(A, B, {"q0": 5.0})).verdict == "legal"


def test_numpy_values_and_integers_are_numbers(view: Callable[..., View]) -> None:
    here = view(rule("a", Is("b0"), limits=at_most(5.0)))
    for fast in (np.float64(5.5), np.float32(5.5), np.int64(6), 6):
        verdict = here.judge(Scene({"b0": np.bool_(1)}), Plan(A, B, {"q0": fast}))  # type: ignore[dict-item]
        assert (verdict.verdict, verdict.errors) == ("illegal", ())


def test_nan_is_unknown_and_nothing_is_assumed_for_it(view: Callable[..., View]) -> None:
    nan = float("nan")
    here = view(rule("a", limits=at_most(5.0)), rule("b", Compare("<", Linear(0.0, ((1.0, "q3"),)), Linear(1.0))))
    verdict = here.judge(Scene({"q3": nan}), Plan(A, B, {"q0": 1.0}))
    assert [item.id for item in verdict.deciding] == ["b"]
    assert here.judge(Scene({}), Plan(A, B, {"q0": nan})).verdict == "unknown"


def test_a_value_of_the_wrong_type_fails_closed(view: Callable[..., View]) -> None:
    here = view(
        rule("a", Compare(">", SPEED, Linear(50.0))),
        rule("b", Is("b0")),
        rule("c", Is("b1")),
        rule("d", OneOf("e0", ("red",)), "c", legality=True),
    )
    verdict = here.judge(Scene({"q0": "fast", "b0": False, "b1": False}), Plan(A, B))  # type: ignore[dict-item]
    assert (verdict.verdict, [item.id for item in verdict.deciding]) == ("illegal", ["a"])
    assert "SC a could not be evaluated and counts as broken: q0 is a quantity and cannot be 'fast'" in verdict.errors
    assert verdict.to_dict()["errors"]
    assert verdict.explain().verdict == "illegal"
    permitted = here.judge(Scene({"q0": 1.0, "b0": False, "b1": True, "e0": 3}), Plan(A, B))
    assert (permitted.verdict, [item.id for item in permitted.deciding]) == ("illegal", ["c"])
    in_plan = here.judge(Scene({"b0": False, "b1": False}), Plan(A, B, {"q0": [1]}))  # type: ignore[dict-item]
    assert (in_plan.verdict, in_plan.errors != ()) == ("illegal", True)


def test_an_error_inside_the_index_is_judged_again_by_the_guarded_reference(view: Callable[..., View]) -> None:
    here = view(rule("a", Compare(">", Linear(0.0, ((0.5, "q0"), (1.0, "q1"))), Linear(50.0))), rule("b", Is("b0")))
    verdict = here.judge(Scene({"q0": 10**400, "q1": 0.0, "b0": False}), Plan(A, B))
    assert verdict.verdict == "illegal"
    assert "too large" in verdict.errors[0]


def test_a_prepared_scene_serves_many_plans(view: Callable[..., View]) -> None:
    here = view(rule("a", Is("b0"), current=frozenset({A}), next=frozenset({B})))
    prepared = here.prepare(Scene({"b0": True}))
    assert [here.judge(prepared, Plan(A, state)).verdict for state in (A, B, C)] == ["legal", "illegal", "legal"]
    other = view(rule("b"))
    assert other.judge(prepared, Plan(A, A)).verdict == "illegal"


def test_lawful_next_asks_every_state_the_machine_allows(view: Callable[..., View]) -> None:
    here = view(rule("a", Is("b0"), next=frozenset({B})), rule("s", limits=at_most(5.0)))
    verdicts = here.lawful_next(Scene({"b0": True}), A, {"q0": 4.0})
    assert {state: verdict.verdict for state, verdict in verdicts.items()} == {A: "legal", B: "illegal", C: "legal"}
    with pytest.raises(RequestError, match=r"unknown state 'drive\.z'"):
        here.lawful_next(Scene(), "drive.z")


def test_a_state_that_is_not_there_is_no_lawful_answer(view: Callable[..., View]) -> None:
    with pytest.raises(RequestError, match="unknown state 'go_straight'"):
        view(rule("a")).judge(Scene(), Plan("go_straight", B))


def test_warm_builds_what_may_follow(view: Callable[..., View]) -> None:
    here = view(rule("a"))
    assert (here.warm(A), here.warm()) == (3, 9)
    assert here.concerned(A, B) == here.rules


def test_a_fact_outside_the_vocabulary_is_refused(view: Callable[..., View]) -> None:
    with pytest.raises(DatabaseDamaged, match="the fact 'zz'"):
        view(rule("a", Is("zz"))).judge(Scene(), Plan(A, B))


def test_no_text_of_the_law_reaches_the_generated_source(view: Callable[..., View]) -> None:
    here = view(rule("evil\");import os", OneOf("e0", ("red'); import os", "red")), limits=at_most(-0.5)))
    generator = here._rules._generator
    source, names = generator.write(here._rules.bucket(A, B)[1]), generator.expressions.names
    assert "evil" not in source
    assert "import" not in source
    assert here.judge(Scene({"e0": "red"}), Plan(A, B, {"q0": 0.0})).verdict == "illegal"
    assert frozenset({"red'); import os", "red", None}) in names.values()


def test_deep_conditions_are_no_error(view: Callable[..., View], law: Any) -> None:
    node: Node = Is("b0")
    for turn in range(150):
        node = And((Not(node), Is("b1"))) if turn % 2 else Not(And((node, Is("b2"))))
    deep = rule("a", node)
    for facts in ({"b0": True, "b1": True, "b2": True}, {"b1": True, "b2": True}, {"b1": False}):
        scene, plan = Scene(facts), Plan(A, B)
        assert view(deep).judge(scene, plan).verdict == decide([deep], Situation(law.vocabulary, scene, plan)).verdict


def test_many_threads_get_the_same_answers(random_law: Callable[[int], Any]) -> None:
    law = random_law(3)
    database = RegulationDatabase(law.vocabulary, law.machine, law.tree, law.rules(30))
    questions = [(law.scene(), law.plan()) for _ in range(60)]
    answers: list[list[str]] = []

    def run() -> None:
        here = database.at("city", 739003)
        answers.append([here.judge(*question).verdict for question in questions])

    threads = [threading.Thread(target=run) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 4
    assert all(found == answers[0] for found in answers)
