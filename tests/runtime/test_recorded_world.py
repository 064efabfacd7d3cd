"""Recorded traffic replayed as a world, and driven in: places between states, who leaves, scripted lights, the same bytes, the planner's turn."""

from __future__ import annotations

import importlib.util
import json
import math
from contextlib import closing
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.log import line_of
from regdb_runtime.drive.recorded_drive import drive_recorded, lights_said, recorded_spec, write_recorded
from regdb_runtime.errors import NoRoute, RequestError, WorldError
from regdb_runtime.maps.commonroad_traffic import read_traffic
from regdb_runtime.trajectory import Trajectory
from regdb_runtime.worlds.recorded import RecordedWorld, ego_of, footprint_of
from regdb_runtime.worlds.recorded_spec import LightsSpec, RecordedSpec
from regdb_runtime.worlds.replay import Replay
from regdb_runtime.worlds.scene_spec import EyeSpec
from typer.testing import CliRunner

from regdb.cli import app
from regdb.front import database


def _recordings() -> ModuleType:
    spec = importlib.util.spec_from_file_location("recordings", Path(__file__).parent / "recordings.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


R = _recordings()
NORTH = ((-1.75, -48.0), (-1.75, 58.0))
EAST = ((-48.0, -1.75), (58.0, -1.75))


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return R.record(tmp_path / "two.xml", {"1": R.along(NORTH, [10.0] * 20), "2": R.along(EAST, [5.0] * 40)}, velocity=30.0)


def standing(world: RecordedWorld) -> Trajectory:
    """A plan to stay where the ego is."""
    ego, time = world.ego, np.array([0.0, 5.0])
    same = {name: np.full(2, getattr(ego, name)) for name in ("x", "y", "heading")}
    nothing = np.zeros(2)
    return Trajectory(time, same["x"], same["y"], same["heading"], nothing, nothing, nothing, nothing, nothing, nothing)


class TestReplay:
    def test_places_lie_between_states_and_speeds_come_from_them(self, file: Path) -> None:
        motion = Replay(read_traffic(file)).motions["1"]
        track = motion.at(0.55)
        assert (track.x, track.y) == pytest.approx((-1.75, -42.5))
        assert track.speed == pytest.approx(10.0)  # the file says 30
        assert track.heading == pytest.approx(math.pi / 2)

    def test_slowing_is_kept_and_jitter_is_not(self, tmp_path: Path) -> None:
        smooth = R.along(NORTH, [10.0 - 0.2 * step for step in range(40)])
        jitter = [(x, y + (0.05 if step % 2 else -0.05), heading) for step, (x, y, heading) in enumerate(smooth)]
        motion = Replay(read_traffic(R.record(tmp_path / "slow.xml", {"1": jitter}))).motions["1"]
        wanted = 10.0 - 2.0 * motion.time
        assert np.abs(motion.speed - wanted)[8:-8].max() < 0.3
        assert motion.acceleration[10:-10] == pytest.approx(np.full(len(motion.time) - 20, -2.0), abs=0.6)

    def test_who_leaves_the_recording_leaves_the_scene(self, file: Path) -> None:
        replay = Replay(read_traffic(file))
        assert [[track.id for track in replay.tracks(time)] for time in (0.0, 2.0, 2.1, 4.0, 4.1)] == [["1", "2"], ["1", "2"], ["2"], ["2"], []]
        assert replay.ends == pytest.approx(4.0)

    def test_one_state_alone(self, tmp_path: Path) -> None:
        replay = Replay(read_traffic(R.record(tmp_path / "one.xml", {"1": R.along(NORTH, [])}, velocity=7.0)))
        assert replay.tracks(0.0)[0].speed == 7.0
        assert not replay.tracks(0.1)


class TestWorld:
    def test_the_ego_is_added_and_lights_are_scripted(self, law: RegulationDatabase, file: Path) -> None:
        spec = RecordedSpec("test", str(file), ("10", "20", "30"), 8.0, 6.0)
        with closing(RecordedWorld(spec, law.vocabulary)) as world:
            seen = world.observe()
            assert [track.id for track in seen.tracks] == ["1", "2"]
            assert seen.signals["50"][0].color == "red"  # the file's own plan would show another colour at times
            assert seen.provenance == "scripted"
            assert world.road_map.jurisdiction == "model"
            for _ in range(45):
                world.step(standing(world), "off", 0.1)
            assert not world.observe().tracks
            assert world.ended

    def test_without_a_script_lights_are_not_seen(self, law: RegulationDatabase, file: Path) -> None:
        spec = RecordedSpec("test", str(file), ("10", "20", "30"), lights=LightsSpec("none"), eye=EyeSpec("none"))
        with closing(RecordedWorld(spec, law.vocabulary)) as world:
            seen = world.observe()
        assert not seen.signals
        assert seen.provenance == "none"
        assert lights_said(spec) == "none"

    def test_a_recorded_ego_drives_as_recorded_whatever_is_planned(self, law: RegulationDatabase, file: Path) -> None:
        with closing(RecordedWorld(RecordedSpec("test", str(file), vehicle="2"), law.vocabulary)) as world:
            assert [track.id for track in world.observe().tracks] == ["1"]
            for _ in range(10):
                world.step(standing(world), "off", 0.1)
            motion = world.replay.motions["2"]
            assert world.ego == ego_of(motion.at(1.0), footprint_of(motion))
            assert world.ego.box_center(world.footprint)[0] == pytest.approx(-43.0)

    def test_problems_name_what_is_there(self, law: RegulationDatabase, file: Path) -> None:
        with pytest.raises(WorldError, match="there are: 1, 2"):
            RecordedWorld(RecordedSpec("test", str(file), vehicle="9"), law.vocabulary)
        with pytest.raises(WorldError, match="not at 3 s"):
            RecordedWorld(RecordedSpec("test", str(file), vehicle="1", begins=3.0), law.vocabulary)
        with pytest.raises(WorldError, match="needs a route"):
            RecordedWorld(RecordedSpec("test", str(file)), law.vocabulary)
        with pytest.raises(WorldError, match="stands vehicle 1"):
            RecordedWorld(RecordedSpec("test", str(file), ("13", "23", "32"), 2.0), law.vocabulary)
        with pytest.raises(NoRoute):
            recorded_spec("test", file, ["10", "11"])

    def test_a_spec_survives_json(self, file: Path) -> None:
        spec = recorded_spec("test", file, ["10", "30"], lights=LightsSpec("green"), place="los_angeles")
        assert RecordedSpec.from_json(spec.to_json()) == spec
        assert spec.route == ("10", "20", "30")


class TestDrive:
    def test_no_sign_of_lights_or_traffic_is_passed_off_as_recorded(self, law: RegulationDatabase, file: Path, tmp_path: Path) -> None:
        """Straight on, the drive waits for the script's green, and its log is the same for the same spec."""
        spec = recorded_spec("test", file, ["10", "21", "31"], place="los_angeles", lights=LightsSpec("red", red=12.0), station=4.0)
        log = drive_recorded(spec, law)
        assert log.end["ended"] == "destination"
        assert log.run["lights"] == "scripted: red first"
        assert log.run["world"] == "recorded"
        entered = next(tick for tick in log.ticks if tick["ego"]["front"] > log.run["marks"]["stop_lines"][0]["station"])
        assert entered["time"] > 12.0
        assert not any(tick["clearance"] <= 0 for item in log.ticks for tick in item["tracks"])
        again = drive_recorded(spec, law)
        assert [line_of(tick) for tick in again.ticks] == [line_of(tick) for tick in log.ticks]
        files = write_recorded(log, spec, tmp_path / "out")
        assert RecordedSpec.from_json(files[1].read_text("utf-8")) == spec

    def test_an_unknown_place_is_said_before_the_drive(self, law: RegulationDatabase, file: Path) -> None:
        with pytest.raises(RequestError):
            drive_recorded(RecordedSpec("test", str(file), ("10", "20", "30"), place="atlantis"), law)

    @pytest.mark.skipif(not R.SCENARIOS.is_dir(), reason="the recorded scenarios lie beside the checkout, in ../shared/scenarios, and are not there")
    @pytest.mark.parametrize(("lanes", "line"), [(("43394", "43488"), 61.7), (("43343", "43640", "43484"), 55.1)])
    def test_the_papers_route_among_peachtrees_traffic(self, law: RegulationDatabase, lanes: tuple[str, ...], line: float) -> None:
        """35 mph, right turn on red after a full stop, 25 mph; nobody touched, never over the limit in force, no emergency."""
        log = drive_recorded(recorded_spec("peachtree", R.SCENARIOS / "USA_Peach-4_8_T-1.xml", lanes, place="los_angeles"), law)
        assert log.end["ended"] == "destination"
        assert max(len(tick["tracks"]) for tick in log.ticks) >= 6
        assert all(track["clearance"] > 0.3 for tick in log.ticks for track in tick["tracks"])
        assert not any(tick["emergency"]["active"] for tick in log.ticks)
        stood = [tick for tick in log.ticks if tick["ego"]["speed"] < 0.1 and tick["ego"]["front"] < line]
        assert line - 2.0 <= stood[0]["ego"]["front"] <= line
        crossing = next(tick for tick in log.ticks if tick["ego"]["front"] > line)
        assert any(shown[0][0] == "red" for shown in crossing["signals"].values())
        assert "CVC 21453(b)" in {citation for tick in log.ticks if tick["law"] for _, citation in tick["law"]["deciding"]}
        limits = {round(tick["law"]["limits"]["max_speed"][0], 3) for tick in log.ticks if tick["law"] and "max_speed" in tick["law"]["limits"]}
        assert {15.646, 11.176} <= limits
        assert all(
            tick["ego"]["speed"] <= tick["law"]["limits"]["max_speed"][0] + 0.05
            for tick in log.ticks if tick["law"] and "max_speed" in tick["law"]["limits"]
        )


class TestCommand:
    def test_observe(self, file: Path, tmp_path: Path) -> None:
        result = CliRunner().invoke(
            app,
            ["drive", "observe", str(file), "--vehicle", "1", "--in", "los_angeles", "--on", "2026-03-02", "--format", "json", "-o", str(tmp_path)],
        )
        assert result.exit_code == 0, result.output
        shown = json.loads(result.stdout)
        assert shown["schema"] == "regdb-drive-observe/1"
        assert [item["id"] for item in shown["vehicles"]] == ["1"]
        assert shown["lights"] == "unknown"
        assert json.loads((tmp_path / "observe-USA_Fixture-1_1_T-1" / "observed.json").read_text("utf-8")) == shown

    def test_exit_code_tells_a_breach(self, tmp_path: Path) -> None:
        fast = R.record(tmp_path / "fast.xml", {"1": R.along(NORTH, [18.0] * 30)})
        result = CliRunner().invoke(app, ["drive", "observe", str(fast), "--on", "2026-03-02", "--no-figures", "-o", str(tmp_path)])
        assert result.exit_code == 1
        assert "UVC 11-803" in result.stdout
        assert "--in los_angeles" in result.stdout

    @pytest.mark.parametrize(
        ("words", "said"),
        [
            (["observe"], "regdb drive observe FILE"),
            (["recorded", "x.xml"], "--route LANE,LANE"),
            (["observe", "nowhere.xml"], "nowhere.xml"),
            (["observe", "x.xml", "--on", "soon"], "--on: 'soon' is no day"),
            (["observe", "x.xml", "--eye", "recorded"], "--eye is scripted or none"),
        ],
    )
    def test_what_can_be_put_right_is_said(self, words: list[str], said: str) -> None:
        result = CliRunner().invoke(app, ["drive", *words])
        assert result.exit_code != 0
        assert said in result.output + str(result.exception)
