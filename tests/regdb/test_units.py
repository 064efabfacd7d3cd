"""Quantities: exact factors, correctly rounded SI values, and back to what the law wrote."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from regdb.units import SI_SYMBOL, UNITS, UnitError, from_si, parse_quantity, show_number, show_si, to_si, unit_named

SYMBOLS = st.sampled_from(sorted(UNITS))
DECIMALS = st.decimals(0, 100000, places=4, allow_nan=False).map(lambda d: d.normalize())


@pytest.mark.parametrize(
    ("text", "si"),
    [
        ("65 mph", 29.0576), ("25 mph", 11.176), ("3 ft", 0.9144), ("1 mi", 1609.344), ("12 in", 0.3048), ("100 km/h", 27.77777777777778),
        ("1 lb", 0.45359237), ("6,000 lb", 2721.55422), ("50 %", 0.5), ("1.5 h", 5400.0), ("-5 deg", -5.0), ("7", 7.0), (".5 s", 0.5),
    ],
)  # fmt: skip
def test_known_values(text: str, si: float) -> None:
    assert parse_quantity(text).si == si


@given(DECIMALS, SYMBOLS)
def test_si_is_the_nearest_float_to_the_exact_value(number: Decimal, symbol: str) -> None:
    exact = Fraction(number) * UNITS[symbol].factor
    found = parse_quantity(f"{number:f} {symbol}")
    assert found.value == Fraction(number)
    assert found.si == float(exact)


@given(DECIMALS, SYMBOLS)
def test_what_was_written_comes_back(number: Decimal, symbol: str) -> None:
    si = parse_quantity(f"{number:f} {symbol}").si
    assert from_si(si, symbol) == Fraction(number)
    assert parse_quantity(show_si(si, symbol)).si == si


@given(st.floats(0.001, 1e6), SYMBOLS)
def test_any_float_survives_the_way_out_and_back(si: float, symbol: str) -> None:
    assert float(from_si(si, symbol) * UNITS[symbol].factor) == pytest.approx(si, rel=1e-12)


@given(st.integers(1, 10**6), st.integers(1, 4))
def test_a_python_number_is_taken_as_written(digits: int, places: int) -> None:
    number = digits / 10**places
    assert to_si(number, "ft") == float(Fraction(repr(number)) * Fraction(3048, 10000))


@pytest.mark.parametrize("unit", UNITS.values(), ids=lambda unit: unit.symbol or "number")
def test_every_dimension_has_an_si_unit_of_factor_one(unit) -> None:
    assert unit.factor > 0
    assert UNITS[SI_SYMBOL[unit.dimension]].factor == 1


def test_units_agree_with_each_other() -> None:
    assert parse_quantity("1 mi").si == parse_quantity("5280 ft").si == parse_quantity("63360 in").si
    assert parse_quantity("60 mph").si * 60 == pytest.approx(to_si(1, "mi"), rel=1e-15)


@pytest.mark.parametrize(
    ("text", "hint"),
    [("25 miles per hour", "mph"), ("3 feet", "ft"), ("5 KPH", "km/h"), ("2 furlongs", "known units"), ("fast", "not a number"), ("", "not a number"),
     ("1 2 mph", "unknown unit"), ("5 MPH", "write mph")],
)  # fmt: skip
def test_what_cannot_be_read_says_what_would_be_right(text: str, hint: str) -> None:
    with pytest.raises(UnitError, match=hint):
        parse_quantity(text)


def test_a_unit_is_found_by_its_symbol_only() -> None:
    assert unit_named("mph").dimension == "speed"
    with pytest.raises(UnitError, match="write mi"):
        unit_named("miles")


def test_numbers_are_shown_without_noise() -> None:
    assert show_number(Fraction(5, 2)) == "2.5"
    assert show_number(Fraction(30)) == "30"
    assert show_number(Fraction(1, 3)) == "0.333333"
    assert str(parse_quantity("06.50 ft")) == "6.5 ft"
    assert str(parse_quantity("4")) == "4"
