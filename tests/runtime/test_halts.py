"""Places past which the law lets no plan go: found from verdicts, the nearest first, and only where firm braking reaches them."""

import math

import pytest
from regdb_runtime.assessment.assessor import Assessor
from regdb_runtime.observation import Track
from regdb_runtime.planning.goal import StopPoint
from small_worlds import CAR, GO, Street, law, road


def halt(street: Street, speed: float) -> StopPoint | None:
    return Assessor(law(), CAR).halt(street.maneuver(GO, GO), street.stretches(GO, GO), speed)


def seeing(**told: bool) -> Street:
    """A vehicle at station 50 whose eye reports a stopped school bus ahead with its lights flashing, with what is told otherwise."""
    street = Street(road(), ("main.e.1",))
    street.eye |= {"school_bus.ahead": True, "school_bus.present": True, "school_bus.red_flashing": True}
    street.eye |= {name.replace("__", "."): value for name, value in told.items()}
    street.see(50.0, 5.0)
    return street


def test_an_empty_road_has_no_halt() -> None:
    assert halt(seeing(school_bus__ahead=False, school_bus__red_flashing=False), 5.0) is None


def test_a_stopped_school_bus_whose_lights_flash_is_one() -> None:
    """CVC 22454(a); not tracked, it counts as beside the vehicle."""
    found = halt(seeing(), 1.0)
    assert found is not None
    assert found.station == pytest.approx(51.0, abs=0.05)
    assert found.rule == "CVC 22454(a)"


def test_a_tracked_bus_is_passed_at_its_near_end() -> None:
    street = seeing()
    x, y = street.path.path.to_plane(80.0, 3.5)[0]
    street.see(50.0, 5.0, (Track("bus", "bus", float(x), float(y), math.pi, 0.0, 11.0, 2.5),))
    found = halt(street, 5.0)
    assert found is not None
    assert found.station == pytest.approx(74.5, abs=0.05)


def test_its_lights_off_it_is_none() -> None:
    assert halt(seeing(school_bus__red_flashing=False), 1.0) is None


def test_what_firm_braking_does_not_reach_is_left_to_the_plans() -> None:
    assert halt(seeing(), 5.0) is None
