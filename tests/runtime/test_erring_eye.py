"""Fused perception that errs: the strict side is reported soon, the permissive one seldom by mistake, and by the seed the same."""

from __future__ import annotations

import random

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.observation import EgoState
from regdb_runtime.perception.policies import restricts
from regdb_runtime.worlds.erring_eye import ErringEye, Errors, mistaken
from regdb_runtime.worlds.eye import ScriptedEye, Sighting

from regdb.front import database
from regdb.situation import quiet_facts

VOCABULARY = RegulationDatabase.open(database()).vocabulary
SIGN = "sign.no_turn_on_red"


def truth() -> ScriptedEye:
    return ScriptedEye(VOCABULARY, [Sighting({SIGN: True}, (100.0, 0.0), 40.0)])


def drive(eye: ErringEye, until: float = 20.0, speed: float = 5.0) -> list[tuple[float, dict[str, object]]]:
    return [(step / 10, dict(eye.look(step / 10, EgoState(speed * step / 10, 0.0, 0.0, speed))[0])) for step in range(int(until * 10))]


def test_without_errors_it_tells_the_truth_once_confirmed() -> None:
    seen = drive(ErringEye(VOCABULARY, truth(), Errors(rate=0.0)))
    at = {time: facts.get(SIGN) for time, facts in seen}
    assert at[0.9] is None
    assert at[1.0] is False
    first = next(time for time, facts in seen if facts.get(SIGN) is True)
    assert 12.0 <= first <= 13.1, "seen within forty metres, answered half a second later"
    assert at[19.9] is True


def test_the_same_seed_errs_the_same() -> None:
    runs = [drive(ErringEye(VOCABULARY, truth(), Errors(rate=0.1, run=3.0, missed=0.1, seed=seed)), 6.0) for seed in (3, 3, 4)]
    assert runs[0] == runs[1] != runs[2]


@pytest.mark.parametrize("run", [1.0, 4.0])
def test_the_stated_rate_is_the_rate(run: float) -> None:
    eye = ErringEye(VOCABULARY, ScriptedEye(VOCABULARY), Errors(rate=0.1, run=run, latency=0.0, seed=1))
    wrong = total = 0
    for step in range(300):
        reading = eye._reading(step / 2, EgoState(0.0, 0.0, 0.0, 0.0))
        wrong += sum(item.rule == "error" for item in reading.statements)
        total += len(reading.statements)
    assert wrong / total == pytest.approx(0.1, abs=0.012)


def test_errors_hold_back_more_often_than_they_let_go() -> None:
    """At five per cent, of facts that quietly permit, more are wrongly strict than strict ones are wrongly let go."""
    seen = drive(ErringEye(VOCABULARY, truth(), Errors(rate=0.05, seed=2)), 20.0)
    missed = sum(facts.get(SIGN) is False for time, facts in seen if time > 13.2)
    assert missed == 0
    quiet = quiet_facts(VOCABULARY)
    strict = sum(facts[name] != quiet[name] and name != SIGN for _, facts in seen for name in facts if name in quiet)
    assert strict > 0


def test_a_mistake_is_a_value_that_the_fact_can_have() -> None:
    chance = random.Random(1)
    for fact in VOCABULARY:
        value = quiet_facts(VOCABULARY).get(fact.name)
        if value is not None and fact.kind in ("boolean", "enumeration", "set") and fact.fusion is not None:
            other = mistaken(fact, value, chance)
            assert fact.read(sorted(other) if isinstance(other, frozenset) else fact.show(other)) == other
            assert isinstance(restricts(fact.fusion, other), bool)


def test_what_the_map_rules_out_is_quiet_instead_of_silent() -> None:
    blind = ScriptedEye(VOCABULARY, attends=["weather.conditions"])
    ego = EgoState(0.0, 0.0, 0.0, 0.0)
    everywhere, here = ErringEye(VOCABULARY, blind, Errors(rate=0.0, latency=0.0)), ErringEye(
        VOCABULARY, blind, Errors(rate=0.0, latency=0.0), lambda _: {"signal.present": False, "rail.crossing_ahead": False})
    assert SIGN in everywhere.look(0.0, ego)[1]
    facts, silent = here.look(0.0, ego)
    assert facts[SIGN] is False
    assert SIGN not in silent
    assert SIGN in here.latest.assumed
