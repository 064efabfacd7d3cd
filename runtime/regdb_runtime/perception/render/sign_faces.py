"""What each sign looks like, by its MUTCD code: shape, colours, legend and symbol, sizes of a conventional road in metres.

Source: Standard Highway Signs (FHWA), from memory of their look; drawn for a camera to recognise, not to be cut from sheet metal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

Outline = Literal["rectangle", "octagon", "triangle_down", "diamond", "pentagon", "circle", "pennant", "cross"]
Colour = tuple[int, int, int]

WHITE: Colour = (246, 246, 244)
BLACK: Colour = (24, 24, 26)
RED: Colour = (187, 30, 40)
YELLOW: Colour = (250, 204, 28)
ORANGE: Colour = (246, 130, 32)
SCHOOL: Colour = (196, 226, 40)
GREEN: Colour = (0, 105, 80)
BLUE: Colour = (20, 84, 165)


@dataclass(frozen=True, slots=True)
class Face:
    """`lines`: rows of the legend from top to bottom, each with its share of the height; `{n}` stands for the number the sign shows.
    `symbol`: a drawing of `symbols.py`, behind or instead of the legend; `slashed`: a red ring and bar over it. `legend_top`: where the legend
    begins, as a share of the height, None in the middle; `legend`: its colour, None the ink."""

    outline: Outline
    width: float
    height: float
    ground: Colour
    ink: Colour
    border: Colour | None = None
    lines: tuple[tuple[str, float], ...] = ()
    symbol: str = ""
    slashed: bool = False
    legend_top: float | None = None
    legend: Colour | None = None


def _plate(*lines: tuple[str, float], size: tuple[float, float] = (0.61, 0.76), symbol: str = "", top: float | None = None) -> Face:
    return Face("rectangle", *size, WHITE, BLACK, BLACK, lines, symbol, legend_top=top)


def _warning(*lines: tuple[str, float], symbol: str = "", ground: Colour = YELLOW) -> Face:
    return Face("diamond", 1.05, 1.05, ground, BLACK, BLACK, lines, symbol)


def _forbidden(symbol: str) -> Face:
    return Face("rectangle", 0.61, 0.61, WHITE, BLACK, BLACK, (), symbol, slashed=True)


FACES: Mapping[str, Face] = {
    "R1-1": Face("octagon", 0.76, 0.76, RED, WHITE, WHITE, (("STOP", 0.36),)),
    "R1-2": Face("triangle_down", 0.91, 0.79, WHITE, RED, RED, (("YIELD", 0.11),), legend_top=0.27),
    "R1-3P": Face("rectangle", 0.46, 0.15, RED, WHITE, WHITE, (("ALL WAY", 0.55),)),
    "R2-1": _plate(("SPEED", 0.15), ("LIMIT", 0.15), ("{n}", 0.42)),
    "R2-4P": _plate(("MINIMUM", 0.15), ("SPEED", 0.15), ("{n}", 0.42)),
    "R3-1": _forbidden("turn_right"),
    "R3-2": _forbidden("turn_left"),
    "R3-4": _forbidden("u_turn"),
    "R3-5L": _plate(("ONLY", 0.2), size=(0.76, 0.91), symbol="turn_left_above", top=0.72),
    "R3-5R": _plate(("ONLY", 0.2), size=(0.76, 0.91), symbol="turn_right_above", top=0.72),
    "R3-7": _plate(("RIGHT LANE", 0.15), ("MUST", 0.15), ("TURN RIGHT", 0.15), size=(0.76, 0.76)),
    "R3-9a": _plate(("CENTER", 0.13), ("LANE", 0.13), ("ONLY", 0.13), size=(0.61, 0.91), symbol="two_way_left", top=0.06),
    "R3-11a": _plate(("HOV 2+", 0.2), ("ONLY", 0.2), ("2 OR MORE", 0.12), size=(0.76, 0.91)),
    "R3-11b": _plate(("BUS", 0.24), ("LANE", 0.24), ("ONLY", 0.2), size=(0.76, 0.91)),
    "R3-17": Face("rectangle", 0.76, 0.61, WHITE, BLACK, BLACK, (("BIKE LANE", 0.22),), "bicycle_above", legend_top=0.7),
    "R4-1": _plate(("DO", 0.2), ("NOT", 0.2), ("PASS", 0.2)),
    "R4-3": _plate(("SLOWER", 0.13), ("TRAFFIC", 0.13), ("KEEP", 0.13), ("RIGHT", 0.13)),
    "R4-7": _plate(size=(0.61, 0.76), symbol="keep_right"),
    "R4-8": _plate(size=(0.61, 0.76), symbol="keep_left"),
    "R4-12": _plate(("SLOW", 0.14), ("VEHICLES", 0.14), ("USE", 0.14), ("TURNOUT", 0.14)),
    "R5-1": Face("rectangle", 0.76, 0.76, WHITE, WHITE, None, (("DO NOT", 0.12), ("", 0.3), ("ENTER", 0.12)), "no_entry", legend=WHITE),
    "R5-1a": Face("rectangle", 0.91, 0.61, RED, WHITE, WHITE, (("WRONG", 0.32), ("WAY", 0.32))),
    "R5-2": _forbidden("truck"),
    "R5-6": _forbidden("bicycle"),
    "R6-1": Face("rectangle", 0.91, 0.3, BLACK, WHITE, WHITE, (("ONE WAY", 0.26),), "arrow_bar", legend=BLACK),
    "R7-1": Face("rectangle", 0.3, 0.46, WHITE, RED, RED, (("NO", 0.2), ("PARKING", 0.16), ("ANY", 0.16), ("TIME", 0.16))),
    "R7-4": Face("rectangle", 0.3, 0.46, WHITE, RED, RED, (("NO", 0.2), ("STOPPING", 0.14), ("ANY", 0.16), ("TIME", 0.16))),
    "R7-107": Face("rectangle", 0.3, 0.46, WHITE, RED, RED, (("NO", 0.18), ("PARKING", 0.14), ("BUS", 0.2), ("STOP", 0.2))),
    "R9-3": _forbidden("pedestrian"),
    "R10-6": _plate(("STOP", 0.17), ("HERE ON", 0.17), ("RED", 0.17), size=(0.61, 0.91), symbol="arrow_down_left", top=0.06),
    "R10-7": _plate(("DO NOT", 0.2), ("BLOCK", 0.2), ("INTERSECTION", 0.11)),
    "R10-11": _plate(("NO", 0.16), ("TURN", 0.16), ("ON", 0.16), ("RED", 0.16), size=(0.61, 0.76)),
    "R10-17T": _plate(("LEFT TURN", 0.12), ("YIELD ON", 0.12), ("FLASHING", 0.12), ("YELLOW ARROW", 0.1), size=(0.76, 0.91)),
    "R11-2": Face("rectangle", 1.22, 0.76, WHITE, BLACK, BLACK, (("ROAD", 0.32), ("CLOSED", 0.32))),
    "R12-1": _plate(("WEIGHT", 0.17), ("LIMIT", 0.17), ("{n} TONS", 0.22)),
    "R15-1": Face("cross", 1.2, 1.2, WHITE, BLACK, None, (("RAILROAD CROSSING", 0.08),)),
    "R15-3": _plate(("EXEMPT", 0.4), size=(0.61, 0.3)),
    "S1-1": Face("pentagon", 0.91, 0.91, SCHOOL, BLACK, BLACK, (), "children"),
    "S4-1P": _plate(("8:30 TO 9:30", 0.26), ("AND 2 TO 4", 0.26), size=(0.61, 0.3)),
    "S4-2P": _plate(("WHEN CHILDREN", 0.26), ("ARE PRESENT", 0.26), size=(0.61, 0.3)),
    "S5-1": _plate(
        ("SCHOOL", 0.13), ("SPEED", 0.1), ("LIMIT", 0.1), ("{n}", 0.28), ("WHEN CHILDREN", 0.07), ("ARE PRESENT", 0.07), size=(0.61, 1.22)),
    "S5-2": _plate(("END", 0.22), ("SCHOOL", 0.22), ("ZONE", 0.22)),
    "W1-2": _warning(symbol="curve_right"),
    "W2-1": _warning(symbol="crossroads"),
    "W2-2": _warning(symbol="side_road"),
    "W2-4": _warning(symbol="t_junction"),
    "W2-6": _warning(symbol="roundabout"),
    "W3-1": _warning(symbol="stop_ahead"),
    "W3-3": _warning(symbol="signal_ahead"),
    "W4-1": _warning(symbol="merge"),
    "W4-2": _warning(symbol="lane_ends"),
    "W6-1": _warning(symbol="divided"),
    "W6-3": _warning(symbol="two_way"),
    "W7-1": _warning(symbol="grade"),
    "W8-5": _warning(symbol="slippery"),
    "W10-1": Face("circle", 0.91, 0.91, YELLOW, BLACK, BLACK, (), "railroad"),
    "W11-1": _warning(symbol="bicycle"),
    "W11-2": _warning(symbol="pedestrian"),
    "W11-7": _warning(("EQUESTRIAN", 0.11)),
    "W13-1P": Face("rectangle", 0.61, 0.61, YELLOW, BLACK, BLACK, (("{n}", 0.42), ("MPH", 0.2))),
    "W14-3": Face("pennant", 1.2, 0.9, YELLOW, BLACK, BLACK, (("NO PASSING", 0.14), ("ZONE", 0.14))),
    "W17-1": _warning(("SPEED", 0.16), ("BUMP", 0.16)),
    "W20-1": _warning(("ROAD", 0.12), ("WORK", 0.12), ("AHEAD", 0.12), ground=ORANGE),
    "W21-1": _warning(symbol="worker", ground=ORANGE),
    "D11-1": Face("rectangle", 0.61, 0.46, GREEN, WHITE, WHITE, (("BIKE ROUTE", 0.2),), "bicycle_above", legend_top=0.7),
    "G20-2": Face("rectangle", 0.91, 0.46, ORANGE, BLACK, BLACK, (("END", 0.36), ("ROAD WORK", 0.3))),
    "G20-5aP": Face("rectangle", 0.61, 0.46, ORANGE, BLACK, BLACK, (("WORK", 0.34), ("ZONE", 0.34))),
}  # fmt: skip
"""Codes that can be drawn; a suffix of another variant (`R2-1-2`, `R10-11a`) falls back on its family by `face_of`."""


def face_of(code: str) -> Face | None:
    """The face of a code, or of the longest known code that it begins with; None for one that cannot be drawn."""
    while code:
        if code in FACES:
            return FACES[code]
        code = code[:-1]
    return None


def with_number(face: Face, number: str) -> Face:
    """The face with what its `{n}` stands for."""
    return replace(face, lines=tuple((text.replace("{n}", number), share) for text, share in face.lines))
