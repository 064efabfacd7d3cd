"""Citations: long and short forms, what lies within what, and the order codes print them in."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from regdb.citation import Citation, CitationError, parse_citation, section_key

SECTIONS = st.from_regex(r"[1-9][0-9]{0,4}([.\-][0-9]{1,3}){0,2}", fullmatch=True)
SUBDIVISIONS = st.lists(st.sampled_from(("a", "b", "1", "2", "A", "aa")), max_size=3).map(lambda parts: "".join(f"({p})" for p in parts))
CITATIONS = st.builds(Citation, st.sampled_from(("CVC", "LAMC", "LACC", "UVC")), SECTIONS, SUBDIVISIONS)


@given(CITATIONS)
def test_what_is_printed_is_read_back(citation: Citation) -> None:
    assert parse_citation(str(citation)) == citation


@pytest.mark.parametrize(
    ("text", "short"),
    [
        ("Cal. Veh. Code § 21453(b)", "CVC 21453(b)"),
        ("CVC §21453 (b) (1)", "CVC 21453(b)(1)"), ("California Vehicle Code section 22350", "CVC 22350"),
        ("L.A. Mun. Code § 80.14", "LAMC 80.14"), ("UVC 11-202", "UVC 11-202"),
        ("  CVC  22349.5 ", "CVC 22349.5"), ("LACC 15.20.010", "LACC 15.20.010"),
    ],
)  # fmt: skip
def test_other_ways_to_write_one(text: str, short: str) -> None:
    assert str(parse_citation(text)) == short


@pytest.mark.parametrize("text", ["", "CVC", "21453", "CVC (a)", "CVC 21453(b", "CVC 21453 b)", "CVC 21453.", "?? 3"])
def test_what_is_no_citation_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(CitationError, match="write it as CVC"):
        parse_citation(text)


def test_containment_goes_down_the_levels() -> None:
    whole, part, deep = (Citation("CVC", "21453", end) for end in ("", "(b)", "(b)(1)"))
    assert whole.contains(part)
    assert part.contains(deep)
    assert part.contains(part)
    assert not deep.contains(part)
    assert not part.contains(Citation("CVC", "21453", "(c)(1)"))
    assert not whole.contains(Citation("CVC", "21454"))
    assert not whole.contains(Citation("UVC", "21453"))


def test_order_is_the_codes_own() -> None:
    wanted = ["CVC 275", "CVC 21453", "CVC 21453(a)", "CVC 21453(b)", "CVC 21453(b)(2)", "CVC 21453(b)(10)", "CVC 22349", "CVC 22349.5",
              "CVC 22350", "LAMC 80.2", "LAMC 80.14", "UVC 11-202", "UVC 11-1003"]  # fmt: skip
    found = [parse_citation(text) for text in wanted]
    random.Random(1).shuffle(found)
    assert [str(item) for item in sorted(found)] == wanted


@given(CITATIONS, CITATIONS)
def test_order_is_total(a: Citation, b: Citation) -> None:
    assert (a < b) + (b < a) + (a == b) >= 1
    assert not (a < b and b < a)


@given(SECTIONS, SECTIONS)
def test_section_keys_tell_sections_apart(a: str, b: str) -> None:
    numbers = [tuple(int(part) for part in text.replace("-", ".").split(".")) for text in (a, b)]
    assert (section_key(a) == section_key(b)) == (numbers[0] == numbers[1])
