"""Interpretations: read with every mistake at its place, stored in the database, read back, shown, and driven by."""

import json
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import yaml
from regdb_compiler.documents.interpretation import InterpretationFile
from regdb_compiler.driver import Build, build
from regdb_compiler.emit.to_sqlite import write_database
from regdb_compiler.fmt import format_text, model_of
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import DatabaseDamaged
from regdb_runtime.interpretation import interpreted, judge, judge_all

from regdb.cli import main
from regdb.content_hash import content_hash
from regdb.interpretation import FORMULAS
from regdb.situation import read_plan, read_scene
from regdb.units import UNITS

PROFILES = ("conservative", "planner", "rss", "statute_only")
CLOSE = {"rear_speed": 25.0, "front_speed": 25.0, "gap": 10.0}


@pytest.fixture(scope="module")
def shipped(codes: Path) -> Build:
    return build(codes)


@pytest.fixture(scope="module")
def database(shipped: Build, tmp_path_factory: pytest.TempPathFactory) -> RegulationDatabase:
    path = tmp_path_factory.mktemp("interpretations") / "regulations.sqlite"
    write_database(shipped, path)
    return RegulationDatabase.open(path)


@pytest.fixture
def wrong(tmp_path: Path, small_codes: Path) -> Callable[..., list[str]]:
    """What reading says of the small codes' profile with some fields changed."""

    def read(**fields: Any) -> list[str]:
        folder = tmp_path / "codes"
        shutil.copytree(small_codes, folder, dirs_exist_ok=True)
        path = folder / "interpretations" / "cautious.yaml"
        data = yaml.load(path.read_text(), Loader=yaml.BaseLoader)
        path.write_text(yaml.safe_dump({**data, **fields}, sort_keys=False))
        return [f"{item.code} {item.message}" for item in build(folder).diagnostics]

    return read


def test_the_shipped_profiles(shipped: Build) -> None:
    found = {entry.profile.name: entry.profile for entry in shipped.corpus.interpretations}
    assert tuple(found) == PROFILES
    assert [decision.formula for decision in found["statute_only"]] == [""] * len(found["statute_only"].decisions)
    assert len({frozenset(item.decisions) for item in found.values()}) == 1
    assert all(decision.because for item in found.values() for decision in item)
    assert all(decision.source for item in found.values() for decision in item if decision.formula)
    assert not any(item.code == "R450" for item in shipped.diagnostics)


def test_every_duty_without_a_number_is_spoken_of(shipped: Build) -> None:
    spoken = set(shipped.corpus.interpretations[0].profile.decisions)
    for number, fact in (
        ("21703-reasonable-and-prudent", "lead.following_unsafe"), ("21750-a-distance", "plan.unsafe_pass"), ("21760-b", "plan.unsafe_pass"),
        ("22350-a", "speed.unsafe_for_conditions"), ("21802-a", "cross_traffic.hazard"), ("21801-a", "oncoming.hazard"),
        ("22107-safe-lane", "target_lane.hazard"), ("22107-safe-turn", "movement.hazard"),
    ):  # fmt: skip
        written = [entry.doc.condition.when for entry in shipped.corpus.by_id[f"cvc-{number}"]]
        assert all(fact in when for when in written)
        assert fact in spoken


def test_no_number_of_a_profile_is_law(shipped: Build) -> None:
    """The regulations that profiles serve stay qualitative: none of them bounds what a formula measures."""
    for entry in shipped.corpus.by_id["cvc-21703-reasonable-and-prudent"] + shipped.corpus.by_id["cvc-22350-a"]:
        assert entry.doc.attributes == {}


def test_parameters_are_of_dimensions_that_units_have() -> None:
    known = {unit.dimension for unit in UNITS.values()}
    for formula in FORMULAS.values():
        assert set(formula.parameters.values()) | set(formula.measures.values()) <= known


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"facts": {"sign.scool": "unknown"}}, "unknown fact `sign.scool`; did you mean sign.school?"),
        ({"facts": {"weather.kind": "unknown"}}, "`weather.kind` is no boolean but of the type"),
        ({"facts": {"sign.school": "stop_in_site"}}, "there is no formula `stop_in_site`; did you mean `stop_in_sight`?"),
        ({"parameters": {}, "facts": {"sign.school": "stop_in_sight"}}, "`stop_in_sight` needs the parameter `response_time` (of duration)"),
        ({"parameters": {"response_time": "2 ft", "min_braking": "4 m/s2"}}, "`response_time` is of duration, not of length: 2 ft"),
        ({"parameters": {"response_time": "0 s", "min_braking": "4 m/s2"}}, "`response_time` must be more than nothing, not 0 s"),
        ({"parameters": {"response_tyme": "2 s"}}, "no formula has a parameter `response_tyme`; did you mean `response_time`?"),
        ({"parameters": {"response_time": "soon"}}, "`response_time`: 'soon' is not a number with a unit"),
        ({"facts": {"sign.school": {"formula": "time_gap", "parameters": {"least_tim": "3 s"}}}}, "`time_gap` has no parameter `least_tim`"),
        ({"interpretation": "bold"}, "`bold` stands in a file of another name"),
        ({"facts": {"sign.school": {"formula": "unknown", "when": "x"}}}, "unknown key `when`"),
        ({"facts": {"sign.school": {"formula": "unknown", "true_when": "maybe"}}}, "'maybe' is none of unsafe, safe"),
    ],
)
def test_mistakes_are_told(wrong: Callable[..., list[str]], fields: dict[str, Any], message: str) -> None:
    assert any(message in told for told in wrong(**fields))


def test_a_mistake_stands_at_its_place(tmp_path: Path, small_codes: Path) -> None:
    folder = Path(shutil.copytree(small_codes, tmp_path / "codes"))
    path = folder / "interpretations" / "cautious.yaml"
    path.write_text(path.read_text().replace("sign.school:", "sign.scool:"))
    found = build(folder).diagnostics
    assert [(item.code, str(item.place)) for item in found] == [("R450", "codes/interpretations/cautious.yaml:7:3")]


def test_what_is_stored_is_read_back(shipped: Build, database: RegulationDatabase) -> None:
    assert database.interpretations == {entry.profile.name: entry.profile for entry in shipped.corpus.interpretations}
    own = database.interpretations["rss"].decisions["target_lane.hazard"].parameters["response_time"]
    assert (own.text, own.si) == ("2 s", 2.0)
    assert database.interpretations["rss"].decisions["lead.following_unsafe"].parameters["response_time"].si == 1.0


def test_a_database_of_the_first_schema_is_still_read(small: Build, tmp_path: Path) -> None:
    path = tmp_path / "old.sqlite"
    write_database(small, path)
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("DROP TABLE interpretation_rule")
        connection.execute("DROP TABLE interpretation")
        connection.execute("PRAGMA user_version = 1000")
        connection.execute("UPDATE regdb_meta SET value = ? WHERE key = 'content_hash'", (content_hash(connection),))
    assert RegulationDatabase.open(path).interpretations == {}


def test_a_formula_that_the_runtime_lacks_is_refused(small: Build, tmp_path: Path) -> None:
    path = tmp_path / "new.sqlite"
    write_database(small, path)
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("UPDATE interpretation_rule SET formula = 'rss_vertical'")
        connection.execute("UPDATE regdb_meta SET value = ? WHERE key = 'content_hash'", (content_hash(connection),))
    with pytest.raises(DatabaseDamaged, match="rss_vertical"):
        RegulationDatabase.open(path)


@pytest.mark.parametrize(
    ("name", "value", "verdict"), [("statute_only", None, "unknown"), ("conservative", True, "illegal"), ("rss", True, "illegal")]
)
def test_following_too_closely_by_each_profile(database: RegulationDatabase, name: str, value: bool | None, verdict: str) -> None:
    """One scene, one law; what differs is how the runtime decides the fact that the law leaves open."""
    profile = database.interpretations[name]
    scene = read_scene({"like": "quiet", "lead.present": "true", "lead.following_unsafe": "unknown"}, database.vocabulary)
    plan = read_plan({"current": "lane_following.car_following", "next": "lane_following.car_following", "speed": "55 mph"},
                     database.vocabulary, database.machine)  # fmt: skip
    judgements = judge_all(profile, {"lead.following_unsafe": CLOSE})
    assert judge(profile, "lead.following_unsafe", CLOSE).value is value
    scene, plan = interpreted(scene, plan, judgements)
    found = database.at("california", "2026-03-02").judge(scene, plan)
    assert found.verdict == verdict
    assert [rule.id for rule in found.deciding] == ["cvc-21703-reasonable-and-prudent"]


def test_a_profile_is_shown(codes: Path, own_cache: Path, capsys: pytest.CaptureFixture[str]) -> None:  # noqa: ARG001
    with pytest.raises(SystemExit) as caught:
        main(["show", "--interpretation", "rss", "--codes", str(codes)])
    out = capsys.readouterr().out
    assert caught.value.code == 0
    for part in ("Not law", "arXiv.org/abs".lower(), "lead.following_unsafe  true when unsafe by rss_longitudinal", "min_braking 4 m/s2",
                 "plan.lacks_due_care  never decided: stays unknown", "cvc-21703-reasonable-and-prudent"):  # fmt: skip
        assert part in out
    assert max(len(line) for line in out.splitlines() if "http" not in line) <= 80
    with pytest.raises(SystemExit):
        main(["show", "statute_only", "--codes", str(codes), "--format", "json"])
    data = json.loads(capsys.readouterr().out)
    assert (data["shows"], data["name"]) == ("interpretation", "statute_only")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--interpretation", "bold"], "there are: cautious"),
        ([], "name what to show"),
        (["22350", "--interpretation", "cautious"], "name what to show"),
    ],
)
def test_what_cannot_be_shown(
    arguments: list[str], message: str, small_codes: Path, own_cache: Path, capsys: pytest.CaptureFixture[str]  # noqa: ARG001
) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["show", *arguments, "--codes", str(small_codes)])
    assert caught.value.code == 2
    assert message in " ".join(capsys.readouterr().err.split())


def test_profiles_are_formatted_like_other_files(codes: Path) -> None:
    assert model_of(("interpretations", "rss.yaml")) is InterpretationFile
    for name in PROFILES:
        assert format_text((codes / "interpretations" / f"{name}.yaml").read_text(), InterpretationFile).problem == ""
