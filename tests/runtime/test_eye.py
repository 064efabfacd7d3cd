"""What stands in for the vision-language model tells only what it may, and says what it does not tell."""

from pathlib import Path

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import WorldError
from regdb_runtime.observation import EgoState
from regdb_runtime.scenes.tellers import JUDGED_FACTS, LIGHT_FACTS, MAP_FACTS, TRACK_FACTS, UNTOLD, eye_facts
from regdb_runtime.worlds.built_in.build import shipped_vocabulary
from regdb_runtime.worlds.eye import Eye, NoEye, RecordedEye, ScriptedEye, Sighting, build_eye
from regdb_runtime.worlds.scene_spec import EyeSpec, SightingSpec

from regdb.front import database
from regdb.situation import Plan, Scene, quiet_facts

HERE, FAR = EgoState(0.0, 0.0, 0.0, 10.0), EgoState(-500.0, 0.0, 0.0, 10.0)
CRUISE = Plan("lane_following.go_straight", "lane_following.go_straight", {"plan.speed": 10.0})


def test_every_fact_of_perception_has_one_teller() -> None:
    vocabulary = shipped_vocabulary()
    told_by_nobody = {name for name in UNTOLD if vocabulary.facts[name].source == "perception"}
    groups = (LIGHT_FACTS, MAP_FACTS, TRACK_FACTS, JUDGED_FACTS, eye_facts(vocabulary), told_by_nobody)
    perceived = {fact.name for fact in vocabulary if fact.source == "perception"}
    assert set().union(*groups) == perceived
    assert sum(map(len, groups)) == len(perceived)


def test_a_sighting_is_seen_within_its_range_and_quiet_beyond_it() -> None:
    eye = ScriptedEye(shipped_vocabulary(), [Sighting({"sign.school": True}, (50.0, 0.0), 80.0)])
    assert eye.look(0.0, HERE)[0]["sign.school"] is True
    assert eye.look(0.0, FAR)[0]["sign.school"] is False
    assert eye.look(0.0, HERE)[1] == frozenset()


def test_a_sighting_lasts_from_its_time_to_the_other_and_inside_its_area() -> None:
    area = ((-10.0, -5.0), (10.0, -5.0), (10.0, 5.0), (-10.0, 5.0))
    eye = ScriptedEye(shipped_vocabulary(), [Sighting({"school.children_going": True}, area=area, start=5.0, until=10.0)])
    assert [eye.look(time, HERE)[0]["school.children_going"] for time in (4.9, 5.0, 9.9, 10.0)] == [False, True, True, False]
    assert eye.look(6.0, FAR)[0]["school.children_going"] is False


def test_what_the_eye_misses_or_does_not_attend_to_is_unknown_and_silent() -> None:
    vocabulary = shipped_vocabulary()
    facts, silent = ScriptedEye(vocabulary, [Sighting({"sign.no_turn_on_red": True})], misses=["sign.no_turn_on_red"]).look(0.0, HERE)
    assert "sign.no_turn_on_red" not in facts
    assert silent == {"sign.no_turn_on_red"}
    facts, silent = ScriptedEye(vocabulary, attends=["sign.school"]).look(0.0, HERE)
    assert dict(facts) == {"sign.school": False}
    assert silent == eye_facts(vocabulary) - {"sign.school"}


@pytest.mark.parametrize("fact", ["signal.color", "lead.distance", "posted.speed", "sign.scool"])
def test_the_eye_may_not_tell_what_others_tell(fact: str) -> None:
    with pytest.raises(WorldError, match=f"{fact} is not the eye's to tell"):
        ScriptedEye(shipped_vocabulary(), [Sighting({fact: True})])


def test_a_record_is_replayed_until_it_is_too_old(tmp_path: Path) -> None:
    record = tmp_path / "seen.jsonl"
    first = '{"time": 1.0, "facts": {"sign.school": true, "posted.advisory_speed": "25 mph"}}'
    record.write_text(first + '\n{"time": 2.0, "facts": {}}\n', encoding="utf-8")
    eye = build_eye(EyeSpec("recorded", record=str(record)), shipped_vocabulary())
    assert isinstance(eye, RecordedEye)
    assert dict(eye.look(0.5, HERE)[0]) == {}
    facts, silent = eye.look(1.5, HERE)
    assert facts == {"sign.school": True, "posted.advisory_speed": pytest.approx(11.176)}
    assert "sign.school" not in silent
    assert "sign.road_work" in silent
    assert "sign.school" in eye.look(2.5, HERE)[1]
    assert eye.look(4.5, HERE)[1] == eye_facts(shipped_vocabulary())


@pytest.mark.parametrize("line", ['{"time": 1.0}', "no json", '{"time": 1.0, "facts": {"sign.scool": true}}', "[1]"])
def test_a_record_that_is_none_is_named_with_its_line(tmp_path: Path, line: str) -> None:
    record = tmp_path / "seen.jsonl"
    record.write_text(line, encoding="utf-8")
    with pytest.raises(WorldError, match=r"seen\.jsonl:1"):
        RecordedEye.read(shipped_vocabulary(), record)


def test_each_eye_says_where_its_facts_come_from(tmp_path: Path) -> None:
    (tmp_path / "none.jsonl").write_text("", encoding="utf-8")
    kinds: dict[str, EyeSpec] = {
        "scripted": EyeSpec(sightings=(SightingSpec({"posted.advisory_speed": "20 mph"}),)), "none": EyeSpec("none"),
        "recorded": EyeSpec("recorded", record=str(tmp_path / "none.jsonl")),
    }  # fmt: skip
    eyes: dict[str, Eye] = {name: build_eye(spec, shipped_vocabulary()) for name, spec in kinds.items()}
    assert {name: eye.provenance for name, eye in eyes.items()} == {name: name for name in kinds}
    assert eyes["scripted"].look(0.0, HERE)[0]["posted.advisory_speed"] == pytest.approx(8.9408)


def test_a_quiet_scene_told_by_the_scripted_eye_is_judged_and_one_without_eye_is_not() -> None:
    shipped = RegulationDatabase.open(database())
    others = {name: value for name, value in quiet_facts(shipped.vocabulary).items() if name not in eye_facts(shipped.vocabulary)}
    posted = {"sign.speed_limit": True, "posted.speed": 15.6464, "local.speed_declared": True, "ego.speed": 10.0}
    view = shipped.at("los_angeles", "2026-03-04")
    facts, silent = ScriptedEye(shipped.vocabulary).look(0.0, HERE)
    assert view.judge(Scene(others | posted | dict(facts), silent), CRUISE).verdict == "legal"
    facts, silent = NoEye(shipped.vocabulary).look(0.0, HERE)
    blind = view.judge(Scene(others | posted | dict(facts), silent), CRUISE)
    assert blind.verdict == "unknown"
