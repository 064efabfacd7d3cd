"""Recordings of our own for tests: cars along given places on the fixture's junction, as CommonRoad files."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

SCENARIOS = Path(__file__).parents[3] / "shared" / "scenarios"
STREETS = Path(__file__).parent / "data" / "junction_2020a.xml"
Way = Sequence[tuple[float, float]]
STEP = 0.1


def along(points: Way, speeds: Iterable[float]) -> list[tuple[float, float, float]]:
    """Places (x, y, heading) every tenth of a second along a polyline, at the speed of each step."""
    at, found = 0.0, [_place(points, 0.0)]
    for speed in speeds:
        at += speed * STEP
        found.append(_place(points, at))
    return found


def _place(points: Way, station: float) -> tuple[float, float, float]:
    for (ax, ay), (bx, by) in pairwise(points):
        length = math.dist((ax, ay), (bx, by))
        if station <= length or (bx, by) == points[-1]:
            share = station / length
            return ax + (bx - ax) * share, ay + (by - ay) * share, math.atan2(by - ay, bx - ax)
        station -= length
    raise ValueError("a way has two points at least")


def record(path: Path, cars: Mapping[str, Sequence[tuple[float, float, float]]], velocity: float = 10.0, kind: str = "car") -> Path:
    """A file with the fixture's streets and these road users; every state carries the same `velocity`, whatever the places say."""
    streets = re.sub(r"<(staticObstacle|dynamicObstacle|planningProblem).*?</\1>", "", STREETS.read_text("utf-8"), flags=re.DOTALL)
    obstacles = "".join(_obstacle(name, states, velocity, kind) for name, states in cars.items())
    path.write_text(streets.replace("</commonRoad>", f"{obstacles}</commonRoad>"), "utf-8")
    return path


def _obstacle(name: str, states: Sequence[tuple[float, float, float]], velocity: float, kind: str) -> str:
    rows = [_state("initialState" if step == 0 else "state", step, state, velocity) for step, state in enumerate(states)]
    shape = "<shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>"
    trajectory = f"<trajectory>{''.join(rows[1:])}</trajectory>" if len(rows) > 1 else ""
    return f'<dynamicObstacle id="{name}"><type>{kind}</type>{shape}{rows[0]}{trajectory}</dynamicObstacle>'


def _state(tag: str, step: int, place: tuple[float, float, float], velocity: float) -> str:
    x, y, heading = place
    return (
        f"<{tag}><position><point><x>{x}</x><y>{y}</y></point></position><orientation><exact>{heading}</exact></orientation>"
        f"<time><exact>{step}</exact></time><velocity><exact>{velocity}</exact></velocity></{tag}>"
    )
