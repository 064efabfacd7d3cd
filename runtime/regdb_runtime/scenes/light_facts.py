"""What the lights say to a planned movement: an arrow for it governs before a circular light; what is not seen stays unknown."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from regdb.vocabulary import Value
from regdb_runtime.maps.road_map import Light, Turn
from regdb_runtime.observation import Indication, Shape

NO_SIGNAL: Mapping[str, Value] = {
    "signal.color": "none", "signal.shape": "none", "signal.flashing": False, "signal.inoperative": False, "signal.yields_on_arrow": False,
    "signal.green_arrow_elsewhere": False,
}  # fmt: skip
"""Where no signal stands."""
ARROWS: Mapping[Turn, tuple[Shape, ...]] = {
    "left": ("left_arrow",), "right": ("right_arrow",), "straight": ("straight_arrow",), "u_turn": ("u_arrow", "left_arrow"),
}  # fmt: skip
"""The arrows that speak to a movement, the more particular first."""
STRICTNESS = {"red": 3, "unknown": 2.5, "yellow": 2, "green": 1, "dark": 0}
"""When lights for one movement differ, the stricter one is obeyed."""


def light_facts(lights: Sequence[Light], shown: Mapping[str, Sequence[Indication]], turn: Turn) -> dict[str, Value]:
    """Facts of the signal for one movement: `lights` that speak to it on the map, `shown` what is seen of them by id.

    Empty (all unknown) when none of them is seen.
    """
    seen = [indication for light in lights if light.id in shown for indication in _shapes(light, shown[light.id])]
    if not seen:
        return {}
    if all(item.color == "dark" for item in seen):
        return {**NO_SIGNAL, "signal.inoperative": True}
    governing = _governing(seen, turn)
    facts: dict[str, Value] = {"signal.inoperative": False}
    if governing is None:
        facts |= {"signal.color": "none", "signal.shape": "none", "signal.flashing": False, "signal.yields_on_arrow": False}
    elif governing.color == "unknown":
        return facts
    else:
        arrow = governing.shape != "circular"
        facts |= {"signal.color": governing.color, "signal.shape": "arrow" if arrow else "circular", "signal.flashing": governing.flashing}
        facts["signal.yields_on_arrow"] = arrow and governing.flashing and governing.color == "yellow"
    facts["signal.green_arrow_elsewhere"] = _elsewhere(seen, turn, governing)
    return facts


def _shapes(light: Light, indications: Iterable[Indication]) -> list[Indication]:
    """What a light shows; a light that the map has as an arrow shows arrows even where perception tells colours alone."""
    shape: Shape | None = {"left": "left_arrow", "right": "right_arrow", "straight": "straight_arrow"}.get(light.direction) if light.arrow else None  # type: ignore[assignment]
    if shape is None:
        return list(indications)
    return [Indication(item.color, shape, item.flashing) if item.shape == "circular" else item for item in indications]


def _governing(seen: Sequence[Indication], turn: Turn) -> Indication | None:
    """The indication for the movement: of its most particular arrow, else the circular ones; the strictest where several are lit."""
    for shape in (*ARROWS[turn], "circular"):
        fitting = [item for item in seen if item.shape == shape and item.color != "dark"]
        if fitting:
            return max(fitting, key=lambda item: (STRICTNESS[item.color], item.flashing))
    return None


def _elsewhere(seen: Sequence[Indication], turn: Turn, governing: Indication | None) -> bool:
    """Whether a green arrow is lit for another movement alone and nothing permits this one."""
    permitted = governing is not None and governing.color in ("green", "yellow")
    return not permitted and any(item.color == "green" and item.shape not in (*ARROWS[turn], "circular") for item in seen)
