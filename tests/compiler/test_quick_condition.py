"""The quick reader of conditions against the grammar: the same tree, or nothing."""

import random
from pathlib import Path

import pytest
from regdb_compiler.driver import build
from regdb_compiler.parse_condition import read_by_grammar, read_linear_by_grammar
from regdb_compiler.quick_condition import read_linear_quickly, read_quickly

COMMON = (
    "sign.stop",
    "not sign.stop",
    "signal.color == red and ego.speed > 25 mph and not sign.stop",
    "signal.color in {red, green,} or known(sign.stop)",
    "highway in road.types and (a or b) and not (c or not d)",
    "clock.time within 22:00..5:00 and clock.date within 2026-01-01..2027-01-01",
    "ego.speed <= posted.speed - 5 mph + 2 * lane.speed",
    "-2 * a.b < 3 and 3.5 ft >= lane.width",
    "lane.width > 36 in and x in {a}",
    "  spaces   ==  everywhere\n and more ",
)
PIECES = (
    "sign.stop", "and", "or", "not", "(", ")", "{", "}", "in", "within", "known", "==", "<", "=", "+", "-", "*", ",", "..",
    "25", "25 mph", "3 in", "07:00", "2026-01-01", "red", "a.b", "&&", "25 mhp", "1.5ft", "in{", "%",
)  # fmt: skip


@pytest.mark.parametrize("text", COMMON)
def test_common_conditions_are_read_as_the_grammar_reads_them(text: str) -> None:
    raw = read_quickly(text)
    assert raw is not None
    assert raw == read_by_grammar(text)


def test_whatever_it_accepts_the_grammar_reads_the_same() -> None:
    chooser = random.Random(7)
    accepted = 0
    for _ in range(20_000):
        text = chooser.choice((" ", "")).join(chooser.choices(PIECES, k=chooser.randint(1, 7)))
        raw = read_quickly(text)
        if raw is not None:
            accepted += 1
            assert raw == read_by_grammar(text), text
    assert accepted > 500


def test_every_shipped_condition_is_common(codes: Path) -> None:
    told = [entry.doc.condition for entry in build(codes).corpus.regulations]
    texts = {text for doc in told for text in (doc.when, doc.unless) if text}
    assert len(texts) > 100
    for text in texts:
        raw = read_quickly(text)
        assert raw is not None, text
        assert raw == read_by_grammar(text), text


@pytest.mark.parametrize("text", ["", "a and", "a = b", "ego.speed > 25 mhp", "(a", "a b", "known(a", "a in {", "x within 07:00..", "1 +"])
def test_what_is_wrong_is_left_to_the_grammar(text: str) -> None:
    assert read_quickly(text) is None


@pytest.mark.parametrize("text", ["25 mph", "posted.speed", "posted.speed - 5 mph", "-3", "2 * lane.width + 1 ft", "7"])
def test_bounds_too(text: str) -> None:
    terms = read_linear_quickly(text)
    assert terms is not None
    assert terms == read_linear_by_grammar(text)
    assert read_linear_quickly(text + " and") is None
