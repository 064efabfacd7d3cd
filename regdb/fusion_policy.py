"""How statements on a fact are believed and forgotten: which values permit, what confirms them, how long and how far they hold."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

CORROBORATORS = ("map", "detector", "gnss", "clock")
"""Sources whose word can stand beside the model's; what was scripted stands for the model, so it is none of them."""


@dataclass(frozen=True, slots=True)
class Reach:
    """How long something counts: seconds since it was captured and metres travelled since, whichever ends first."""

    seconds: float = math.inf
    metres: float = math.inf

    def covers(self, seconds: float, metres: float) -> bool:
        """Whether something that old, and that far behind, still counts."""
        return seconds <= self.seconds and metres <= self.metres


@dataclass(frozen=True, slots=True)
class Permissive:
    """The values of a fact that let the vehicle do what their opposites forbid: words or truths, or numbers beyond a bound (SI)."""

    values: tuple[bool | str, ...] = ()
    above: float | None = None
    below: float | None = None

    def __contains__(self, value: object) -> bool:
        if isinstance(value, (bool, str)):
            return value in self.values
        if isinstance(value, (int, float)):
            if self.above is None and self.below is None:
                return True
            return (self.above is not None and value > self.above) or (self.below is not None and value < self.below)
        return False


@dataclass(frozen=True, slots=True)
class FusionPolicy:
    """One fact's rules of belief. Times in seconds, distances in metres, numbers of the fact in SI.

    `ages`: the class it belongs to. `holds`: how long a restrictive statement stands; `fresh`: how long a permissive one counts.
    `confirmations` within `within` seconds, at least `apart` seconds from one another, make a permissive value known; `corroboration`:
    sources of which one must agree. `replaced`: confirmed later statements replace a stricter earlier one before its hold has ended.
    `strictest`: words, strictest first. `least`, `most`, `step`: numbers beyond them are refused. `asks`: facts that look alike, among
    which a closed `question` is put. `ends`: facts (or `map`) that end it; `places`: facts without which it does not matter here.
    """

    ages: str
    holds: Reach = Reach()
    fresh: Reach = Reach()
    confirmations: int = 2
    within: float = 2.0
    apart: float = 0.0
    permissive: Permissive = field(default_factory=Permissive)
    corroboration: tuple[str, ...] = ()
    replaced: bool = True
    strictest: tuple[str, ...] = ()
    least: float | None = None
    most: float | None = None
    step: float | None = None
    asks: tuple[str, ...] = ()
    question: str = ""
    ends: tuple[str, ...] = ()
    places: tuple[str, ...] = ()
    because: str = ""
