"""Quantities are found in law's words, in digits and spelled out, and nothing else is."""

import pytest
from regdb_compiler.lint.spoken_numbers import spoken_numbers


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("less than three feet", "3 ft"),
        ("at 25 miles per hour", "25 mph"),
        ("twenty-five miles an hour", "25 mph"),
        ("a 3-foot gap", "3 ft"),
        ("within 1,000 feet", "1000 ft"),
        ("one hundred feet", "100 ft"),
        ("Six\n inches", "6 in"),
        ("2.5 seconds", "2.5 s"),
    ],
)
def test_quantities_are_read(text: str, shown: str) -> None:
    (found,) = spoken_numbers(text)
    assert found.shown == shown
    assert text[found.start : found.end] == found.words


@pytest.mark.parametrize("text", ["section 25", "the second lane", "after the left", "CVC 22350", "a few feet", "two tons", "$3 foot"])
def test_other_numbers_are_none(text: str) -> None:
    assert spoken_numbers(text) == ()


def test_several_in_one_text() -> None:
    assert [item.shown for item in spoken_numbers("15 mph within 500 feet, else 25 mph")] == ["15 mph", "500 ft", "25 mph"]
