"""Quotes found in texts whatever the typography, and the passage nearest to one that is not there."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_compiler.official.comparing import Match, contains, nearest, normal

TEXT = "(a) The driver shall give the right-of-way to “all” pedestrians, at less than three feet (§ 21760)."


@pytest.mark.parametrize(
    "quote",
    [
        "shall give the right-of-way", "right\u2011of\u2011way to \"all\"", "less  than\nthree\u00a0feet", "Section 21760",
        "shall give ... three feet", "shall give … three feet", "right\u00ad-of-way",
    ],
)  # fmt: skip
def test_a_quote_is_found_in_any_typography(quote: str) -> None:
    assert contains(TEXT, quote)


@pytest.mark.parametrize("quote", ["Shall give", "less than 3 feet", "right of way", "three feet ... shall give", "givethe"])
def test_other_words_are_not_found(quote: str) -> None:
    assert not contains(TEXT, quote)


@pytest.mark.parametrize(
    ("quote", "near"),
    [
        ("less than 3 feet", Match("less than three feet", typographic=False)),
        ("the right of way to all", Match('the right-of-way to "all', typographic=True)),
        ("Shall give the right-of-way", Match("shall give the right-of-way", typographic=False)),
        ("drivers of buses always sing", None),
    ],
)
def test_the_nearest_passage(quote: str, near: Match | None) -> None:
    assert nearest(TEXT, quote) == near


def test_part_of_a_word_is_not_the_same_words() -> None:
    found = nearest("the overtaken bicycle", "taken bicycle")
    assert found is None or not found.typographic


@given(st.text("ab -\u2013\u201c\u00a7\n", max_size=30))
def test_normal_form_settles(text: str) -> None:
    assert normal(normal(text)) == normal(text)


@given(st.lists(st.sampled_from(["shall", "not", "pass", "lane"]), min_size=3, max_size=20), st.data())
def test_every_run_of_words_is_contained(words: list[str], data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(words) - 2))
    quote = " ".join(words[start : start + 2])
    assert contains("  ".join(words), quote)
