"""Recorded vehicles judged: what is certain is said with its measure, what the recording cannot tell is unknown and says so."""

from __future__ import annotations

import datetime
import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.drive.observed.findings import Observed
from regdb_runtime.drive.observed.matching import match
from regdb_runtime.drive.observed.observe import about, draw_observed, observe, open_recording, write_observed
from regdb_runtime.drive.observed.observer import SPEED, Observer, ObserverSettings
from regdb_runtime.drive.observed.report import data, text
from regdb_runtime.errors import RequestError, WorldError
from regdb_runtime.maps.lane_graph import LaneGraph

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
RIGHT = ((1.75, -40.0), (1.75, -10.0), (2.4, -5.5), (5.0, -2.6), (10.0, -1.75), (58.0, -1.75))
LEFTWARD = ((1.75, -48.0), (1.75, -40.0), (-1.75, -22.0), (-1.75, 58.0))
Open = Callable[..., Observer]


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@pytest.fixture
def record(law: RegulationDatabase, tmp_path: Path) -> Open:
    """An observer of cars along given places."""

    def opened(
        cars: dict[str, list[tuple[float, float, float]]], place: str = "los_angeles", eye: str = "scripted", velocity: float = 10.0
    ) -> Observer:
        file = R.record(tmp_path / "recording.xml", cars, velocity)
        return open_recording(file, law, ObserverSettings(place, eye=eye))  # type: ignore[arg-type]

    return opened


def citations(found: Observed, word: str) -> set[str]:
    return {item.said.citation for item in found.findings if item.said.word == word}


def missing(found: Observed, citation: str) -> set[str]:
    return {fact for item in found.open if item.said.citation == citation for fact in item.said.missing}


class TestSpeed:
    def test_over_the_posted_limit(self, record: Open) -> None:
        found = record({"1": R.along(NORTH, [18.0] * 50)}).vehicle("1")
        over = next(item for item in found.broken if item.said.citation == "CVC 22351(b)")
        assert over.said.measured == pytest.approx(18.0, abs=0.01)
        assert over.said.bound == pytest.approx(15.6464)
        assert over.said.unit == "m/s"
        assert over.start == 0.0
        assert over.lanes == ("13", "23")
        assert over.end == pytest.approx(3.2, abs=0.2)  # the front leaves the posted lanes at y = 10
        assert "40.3 mph" in over.said.because

    def test_within_the_error_is_unknown(self, record: Open) -> None:
        found = record({"1": R.along(NORTH, [15.9] * 50)}).vehicle("1")
        assert not found.broken
        assert SPEED in missing(found, "CVC 22351(b)")

    def test_a_recorded_speed_that_the_places_contradict_accuses_nobody(self, record: Open) -> None:
        found = record({"1": R.along(NORTH, [10.0] * 50)}, velocity=30.0).vehicle("1")
        assert not found.broken
        assert max(moment.speed for moment in found.moments) == pytest.approx(10.0, abs=0.01)


class TestStopSign:
    def test_driven_through(self, record: Open) -> None:
        found = record({"1": R.along(EAST, [8.0] * 60)}).vehicle("1")
        run = next(item for item in found.broken if item.said.citation == "CVC 22450(a)")
        assert run.start == pytest.approx(4.4, abs=0.21)
        assert run.lanes == ("12",)

    def test_crossed_slowly_is_still_crossed(self, record: Open) -> None:
        found = record({"1": R.along(EAST, [8.0] * 30 + [3.0] * 60)}).vehicle("1")
        assert "CVC 22450(a)" in citations(found, "illegal")

    @pytest.mark.parametrize(("steps", "broken"), [(33, False), (28, True)])
    def test_a_stop_counts_at_the_line_alone(self, record: Open, steps: int, broken: bool) -> None:
        """One metre before the line, and five."""
        slowing = [8.0] * steps + [8.0 - 0.4 * step for step in range(20)] + [0.0] * 15 + [0.2 * step for step in range(40)]
        found = record({"1": R.along(EAST, slowing)}).vehicle("1")
        assert ("CVC 22450(a)" in citations(found, "illegal")) == broken
        assert "intersection_handling.stop" in {moment.state for moment in found.moments}

    def test_first_seen_at_the_line_may_have_stopped(self, record: Open) -> None:
        found = record({"1": R.along(((-13.0, -1.75), (58.0, -1.75)), [5.0] * 30)}).vehicle("1")
        assert not found.broken
        assert "ego.stopped_at_line" in missing(found, "CVC 22450(a)")


class TestLights:
    @pytest.mark.parametrize("eye", ["none", "scripted"])
    def test_nominal_phases_are_no_truth(self, record: Open, eye: str) -> None:
        found = record({"1": R.along(NORTH, [12.0] * 60)}, eye=eye).vehicle("1")
        assert "signal.color" in missing(found, "CVC 21453(a)")
        assert "CVC 21453(a)" not in citations(found, "illegal")

    def test_a_turn_is_read_off(self, record: Open) -> None:
        observer = record({"1": R.along(RIGHT, [6.0] * 90)})
        assert [leg.lane for leg in match(LaneGraph(observer.road_map), observer.replay.motions["1"])] == ["10", "20", "30"]
        assert "intersection_handling.turn_right" in {moment.state for moment in observer.vehicle("1").moments}


class TestLaneChange:
    def test_is_read_off_and_its_signal_unknown(self, record: Open) -> None:
        behind = [(-1.75, y - 30.0, heading) for _, y, heading in R.along(((0.0, -48.0), (0.0, 90.0)), [9.0] * 60)]
        found = record({"1": R.along(LEFTWARD, [9.0] * 60), "2": behind}).vehicle("1")
        changing = [moment for moment in found.moments if moment.state == "lane_following.lane_change_left"]
        assert changing
        assert 1.0 < changing[0].time < 3.0
        assert "ego.turn_signal" in missing(found, "CVC 22107") | missing(found, "CVC 22108")

    def test_seen_in_part_is_no_straddling(self, record: Open) -> None:
        found = record({"1": R.along(((-1.75, -48.0), (-0.2, -14.0)), [9.0] * 36)}).vehicle("1")
        assert "CVC 21658(a)" not in citations(found, "illegal")


class TestWhatARecordingCannotTell:
    def test_people_on_foot_are_not_absent(self, record: Open) -> None:
        silent = record({"1": R.along(NORTH, [12.0] * 60)}, eye="none")
        assert {"pedestrian.in_crosswalk", "ego.turn_signal", "emergency_vehicle.approaching"} <= silent.unseen
        assert any("pedestrian.in_crosswalk" in item.said.missing for item in silent.vehicle("1").open)

    def test_a_script_says_that_nobody_was_there(self, record: Open) -> None:
        scripted = record({"1": R.along(NORTH, [12.0] * 60)})
        assert "ego.turn_signal" in scripted.unseen
        assert not any("pedestrian.in_crosswalk" in item.said.missing for item in scripted.vehicle("1").open)

    def test_the_model_code_says_that_it_binds_nobody(self, record: Open) -> None:
        observer = record({"1": R.along(NORTH, [18.0] * 50)}, place="model")
        found = observe(observer)
        assert "UVC 11-803" in citations(found[0], "illegal")
        assert "binds nobody" in text(about(observer), found)


class TestReport:
    def test_same_bytes_and_a_picture_of_each_breach(self, record: Open, tmp_path: Path) -> None:
        pytest.importorskip("matplotlib")
        observer = record({"1": R.along(NORTH, [18.0] * 30), "2": R.along(EAST, [4.0] * 30)})
        found = observe(observer)
        one = write_observed(observer, found, tmp_path / "a").read_bytes()
        again = record({"1": R.along(NORTH, [18.0] * 30), "2": R.along(EAST, [4.0] * 30)})
        assert write_observed(again, observe(again), tmp_path / "b").read_bytes() == one
        pictures = draw_observed(observer, found[:1], tmp_path / "a")
        assert len(pictures) == len(found[0].broken) > 0
        assert all(path.stat().st_size > 5000 for path in pictures)

    def test_text_keeps_to_80_columns_and_adds_up(self, record: Open) -> None:
        observer = record({"1": R.along(NORTH, [18.0] * 50)})
        found = observe(observer)
        shown = text(about(observer), found)
        assert all(len(line) <= 80 for line in shown.splitlines())
        assert "ILLEGAL CVC 22351(b) (prima facie): speed 40.3 mph" in " ".join(shown.split())
        plain = data(about(observer), found)["vehicles"][0]
        assert sum(plain["seconds"].values()) == pytest.approx(5.0)
        assert plain["intervals"][0]["verdict"] == "illegal"

    def test_who_is_not_recorded(self, record: Open) -> None:
        with pytest.raises(RequestError, match="no vehicle '9'"):
            observe(record({"1": R.along(NORTH, [10.0] * 5)}), ["9"])

    def test_nobody_recorded(self, law: RegulationDatabase, tmp_path: Path) -> None:
        with pytest.raises(WorldError, match="nothing to judge"):
            open_recording(R.record(tmp_path / "empty.xml", {}), law, ObserverSettings())

    def test_unknown_place_and_interpretation(self, law: RegulationDatabase, tmp_path: Path) -> None:
        file = R.record(tmp_path / "one.xml", {"1": R.along(NORTH, [10.0] * 5)})
        with pytest.raises(RequestError):
            open_recording(file, law, ObserverSettings("atlantis"))
        with pytest.raises(RequestError, match="no interpretation 'mine'"):
            open_recording(file, law, ObserverSettings(interpretation="mine"))


@pytest.mark.skipif(not R.SCENARIOS.is_dir(), reason="the recorded scenarios lie beside the checkout, in ../shared/scenarios, and are not there")
class TestRecordedStreets:
    def test_peachtree(self, law: RegulationDatabase) -> None:
        day = datetime.datetime(2026, 3, 2, 12)
        observer = open_recording(R.SCENARIOS / "USA_Peach-4_8_T-1.xml", law, ObserverSettings("model", day))
        found = {item.vehicle: item for item in observe(observer)}
        assert set(found) == {"507", "512", "520", "560", "564", "566", "569", "601", "605"}
        assert {name for name, item in found.items() if item.broken} == {"601"}
        speeding = found["601"].broken[0]
        assert speeding.said.citation == "UVC 11-803"
        assert speeding.said.measured == pytest.approx(16.44, abs=0.05)
        assert {moment.state for moment in found["566"].moments} == {"intersection_handling.car_following"}
        assert any(moment.state == "intersection_handling.turn_left" for moment in found["605"].moments)

    def test_lankershim_accuses_nobody_of_running_a_light(self, law: RegulationDatabase) -> None:
        observer = open_recording(R.SCENARIOS / "USA_Lanker-1_3_T-1.xml", law, ObserverSettings("los_angeles", eye="scripted"))
        found = observe(observer, ("1560", "1577", "1598", "1600"))
        assert not any(item.said.citation.startswith("CVC 2145") for vehicle in found for item in vehicle.broken)
        assert "signal.color" in {fact for vehicle in found for item in vehicle.open for fact in item.said.missing}
