"""Date, time, weekday, and darkness by the sun: half an hour after sunset to half an hour before sunrise."""

import datetime

import pytest
from regdb_runtime.scenes.clock_facts import bright_minutes, clock_facts, is_dark, is_summer, offset_hours

ANGELES = (-118.2437, 34.0522)
TROMSO = (18.96, 69.65)


def local(text: str) -> datetime.datetime:
    return datetime.datetime.fromisoformat(text)


@pytest.mark.parametrize(
    ("day", "sunrise", "sunset"),
    # the United States Naval Observatory's times for Los Angeles, to the minute
    [("2026-03-20", (6, 57), (19, 4)), ("2026-06-21", (5, 42), (20, 8)), ("2026-12-21", (6, 55), (16, 48)), ("2026-09-22", (6, 40), (18, 49))],
)
def test_sunrise_and_sunset_in_los_angeles(day: str, sunrise: tuple[int, int], sunset: tuple[int, int]) -> None:
    noon = local(f"{day}T12:00")
    begins, ends = bright_minutes(noon.date(), ANGELES, offset_hours(noon, ANGELES[0], summer_time=True))
    assert begins + 30 == pytest.approx(sunrise[0] * 60 + sunrise[1], abs=3)
    assert ends - 30 == pytest.approx(sunset[0] * 60 + sunset[1], abs=3)


@pytest.mark.parametrize(
    ("clock", "dark"),
    [("2026-12-21T12:00", False), ("2026-12-21T17:00", False), ("2026-12-21T17:30", True), ("2026-12-21T06:10", True), ("2026-12-21T06:40", False),
     ("2026-06-21T20:30", False), ("2026-06-21T20:50", True), ("2026-06-21T00:00", True)],
)  # fmt: skip
def test_darkness(clock: str, dark: bool) -> None:  # a table's column
    assert is_dark(local(clock), ANGELES) is dark


def test_where_the_sun_does_not_set_or_rise() -> None:
    assert not is_dark(local("2026-06-21T00:00"), TROMSO)
    assert is_dark(local("2026-12-21T12:00"), TROMSO)


def test_a_clock_with_a_zone_keeps_it() -> None:
    zone = datetime.timezone(datetime.timedelta(hours=-8))
    assert offset_hours(local("2026-07-01T12:00").replace(tzinfo=zone), ANGELES[0], summer_time=True) == -8
    assert offset_hours(local("2026-07-01T12:00"), ANGELES[0], summer_time=True) == -7
    assert offset_hours(local("2026-07-01T12:00"), ANGELES[0], summer_time=False) == -8


@pytest.mark.parametrize(
    ("clock", "summer"),
    [("2026-03-08T01:59", False), ("2026-03-08T02:00", True), ("2026-11-01T01:59", True), ("2026-11-01T02:00", False), ("2027-03-14T02:00", True)],
)
def test_daylight_saving_time(clock: str, summer: bool) -> None:
    assert is_summer(local(clock)) is summer


def test_facts_of_the_clock() -> None:
    assert clock_facts(local("2026-03-02T07:30:15.9"), ANGELES) == {
        "clock.time": 7 * 3600 + 30 * 60 + 15, "clock.date": datetime.date(2026, 3, 2).toordinal(), "clock.weekday": "monday",
        "clock.darkness": False,
    }  # fmt: skip
