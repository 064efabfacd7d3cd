"""Quantities of the law: units with dimensions, exact conversion to SI, and back for people to read."""

import re
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache


class UnitError(ValueError):
    """A quantity that cannot be read, or two whose dimensions do not agree."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit: `symbol` as the law writes it, its `dimension`, and the exact `factor` to the SI unit of that dimension."""

    symbol: str
    dimension: str
    factor: Fraction


_FOOT = Fraction(3048, 10000)
_MILE = 5280 * _FOOT
_DEGREE = Fraction(1)  # degrees stay degrees: every angle of the law is written in them, and pi is not exact

UNITS: dict[str, Unit] = {
    unit.symbol: unit
    for unit in (
        Unit("m/s", "speed", Fraction(1)),
        Unit("km/h", "speed", Fraction(1000, 3600)),
        Unit("mph", "speed", _MILE / 3600),
        Unit("m", "length", Fraction(1)),
        Unit("ft", "length", _FOOT),
        Unit("in", "length", _FOOT / 12),
        Unit("mi", "length", _MILE),
        Unit("s", "duration", Fraction(1)),
        Unit("min", "duration", Fraction(60)),
        Unit("h", "duration", Fraction(3600)),
        Unit("kg", "mass", Fraction(1)),
        Unit("lb", "mass", Fraction(45359237, 100000000)),
        Unit("deg", "angle", _DEGREE),
        Unit("%", "ratio", Fraction(1, 100)),
        Unit("m/s2", "acceleration", Fraction(1)),
        Unit("ft/s2", "acceleration", _FOOT),
        Unit("", "number", Fraction(1)),
    )
}
"""Every unit by its symbol; the empty symbol is a bare number (counts)."""

SI_SYMBOL = {"speed": "m/s", "length": "m", "duration": "s", "mass": "kg", "angle": "deg", "acceleration": "m/s2", "ratio": "", "number": ""}

_ALIASES = {
    "feet": "ft", "foot": "ft", "inch": "in", "inches": "in", "mile": "mi", "miles": "mi", "kph": "km/h", "kmh": "km/h",
    "miles per hour": "mph", "second": "s", "seconds": "s", "sec": "s", "minutes": "min", "hour": "h", "hours": "h",
    "lbs": "lb", "pound": "lb", "pounds": "lb", "meter": "m", "metre": "m", "meters": "m", "metres": "m",
    "degrees": "deg", "percent": "%", "mps": "m/s", "hr": "h",
}  # fmt: skip
_QUANTITY = re.compile(r"\s*([+-]?(?:\d[\d,]*(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*\Z", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with its unit as the law wrote it; `si` is the value in the SI unit of its dimension, correctly rounded."""

    value: Fraction
    unit: Unit
    si: float = field(init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "si", float(self.value * self.unit.factor))

    @property
    def dimension(self) -> str:
        return self.unit.dimension

    def __str__(self) -> str:
        return show_number(self.value) + (f" {self.unit.symbol}" if self.unit.symbol else "")


def unit_named(symbol: str) -> Unit:
    """The unit with this symbol. Raises UnitError, naming the accepted spelling where there is one."""
    if symbol in UNITS:
        return UNITS[symbol]
    meant = _ALIASES.get(symbol.lower()) or (symbol.lower() if symbol.lower() in UNITS else None)
    hint = f"; write {meant}" if meant else f"; known units: {', '.join(s for s in UNITS if s)}"
    raise UnitError(f"unknown unit {symbol!r}{hint}")


@lru_cache(maxsize=4096)
def parse_quantity(text: str) -> Quantity:
    """Read `65 mph`, `3 ft`, `2.5 s`, `12`. Raises UnitError when it is no number or the unit is unknown."""
    match = _QUANTITY.match(text)
    if match is None:
        raise UnitError(f"{text!r} is not a number with a unit")
    return Quantity(Fraction(match[1].replace(",", "")), unit_named(match[2]))


def to_si(value: float, symbol: str) -> float:
    """`value` in the unit `symbol`, in SI. Decimal digits are taken as written, so 2.9 ft is exactly 2.9."""
    return float(Fraction(repr(value)) * unit_named(symbol).factor)


def from_si(value: float, symbol: str) -> Fraction:
    """The SI `value` in the unit `symbol`, as the shortest decimal that converts back to the same float."""
    factor = unit_named(symbol).factor
    exact = Fraction(value) / factor
    for digits in range(13):
        rounded = Fraction(round(exact * 10**digits), 10**digits)
        if float(rounded * factor) == value:
            return rounded
    return exact


def show_number(value: Fraction) -> str:
    """A fraction as a person writes it: no trailing zeros, at most six decimals."""
    if value.denominator == 1:
        return str(value.numerator)
    return f"{float(value):.6f}".rstrip("0").rstrip(".")


def show_si(value: float, symbol: str) -> str:
    """The SI `value` in the unit `symbol`, with the unit: `25 mph`."""
    number = show_number(from_si(value, symbol))
    return f"{number} {symbol}" if symbol else number
