"""What the clock says: date, weekday, time of day, and whether the law calls it darkness where the vehicle is."""

from __future__ import annotations

import datetime
import math
from functools import lru_cache

from regdb.vocabulary import Value

WEEKDAYS = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday")
HALF_HOUR = 30.0
"""Minutes after sunset and before sunrise that frame darkness (the meaning of the fact clock.darkness)."""
HORIZON = math.radians(90.833)
"""Zenith distance of the sun at sunrise and sunset: refraction and the sun's radius (NOAA, solar calculation details)."""


def clock_facts(clock: datetime.datetime, place: tuple[float, float], summer_time: bool = True) -> dict[str, Value]:
    """Facts of the clock at a local time; `place`: longitude and latitude, degrees. A clock without zone keeps its meridian's zone time."""
    return {
        "clock.time": clock.hour * 3600 + clock.minute * 60 + clock.second,
        "clock.date": clock.toordinal(),
        "clock.weekday": WEEKDAYS[clock.weekday()],
        "clock.darkness": is_dark(clock, place, summer_time),
    }


def seconds_until(second: float, clock: datetime.datetime) -> float:
    """From a local time to the next time that its day, or the one after, has come to a second of the day (at least 0)."""
    now = clock.hour * 3600 + clock.minute * 60 + clock.second + clock.microsecond / 1e6
    return (second - now) % 86400


def is_dark(clock: datetime.datetime, place: tuple[float, float], summer_time: bool = True) -> bool:
    """Whether it is later than half an hour after sunset or earlier than half an hour before sunrise."""
    begins, ends = bright_minutes(clock.date(), place, offset_hours(clock, place[0], summer_time))
    minute = clock.hour * 60 + clock.minute + clock.second / 60
    return not begins <= minute <= ends


def offset_hours(clock: datetime.datetime, longitude: float, summer_time: bool) -> float:
    """Local time less universal time: from the clock's zone, else from the meridian and the rule of 15 U.S.C. 260a."""
    told = clock.utcoffset()
    if told is not None:
        return told.total_seconds() / 3600
    return round(longitude / 15) + (1.0 if summer_time and is_summer(clock) else 0.0)


def is_summer(clock: datetime.datetime) -> bool:
    """Whether daylight saving time runs: from 2 o'clock on the second Sunday of March to the first one of November (since 2007)."""
    start = _sunday(clock.year, 3, 2).replace(tzinfo=clock.tzinfo)
    return start <= clock < _sunday(clock.year, 11, 1).replace(tzinfo=clock.tzinfo)


def _sunday(year: int, month: int, number: int) -> datetime.datetime:
    first = datetime.datetime(year, month, 1, 2)
    return first + datetime.timedelta(days=(6 - first.weekday()) % 7 + 7 * (number - 1))


@lru_cache(maxsize=64)
def bright_minutes(day: datetime.date, place: tuple[float, float], offset: float) -> tuple[float, float]:
    """Minutes of the local day between which it is not dark. NOAA's solar equations, good to a minute or two outside the polar circles.

    Where the sun does not set the whole day is bright; where it does not rise, none of it.
    """
    longitude, latitude = place[0], math.radians(place[1])
    year = math.tau / 365 * (day.timetuple().tm_yday - 1)
    equation = 229.18 * (
        0.000075 + 0.001868 * math.cos(year) - 0.032077 * math.sin(year) - 0.014615 * math.cos(2 * year) - 0.040849 * math.sin(2 * year)
    )
    declination = (
        0.006918 - 0.399912 * math.cos(year) + 0.070257 * math.sin(year) - 0.006758 * math.cos(2 * year) + 0.000907 * math.sin(2 * year)
        - 0.002697 * math.cos(3 * year) + 0.00148 * math.sin(3 * year)
    )  # fmt: skip
    cosine = (math.cos(HORIZON) - math.sin(latitude) * math.sin(declination)) / (math.cos(latitude) * math.cos(declination))
    noon = 720 - 4 * longitude - equation + 60 * offset
    if cosine <= -1:
        return 0.0, 1440.0
    if cosine >= 1:
        return noon, noon - 1
    half_day = 4 * math.degrees(math.acos(cosine))
    return noon - half_day - HALF_HOUR, noon + half_day + HALF_HOUR
