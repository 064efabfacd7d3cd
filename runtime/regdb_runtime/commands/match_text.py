"""A reading as people and programs see it: the text with its evidence underlined, the facts, and what was set aside."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from typing import Any

from regdb.front import WIDTH
from regdb.vocabulary import Vocabulary
from regdb_runtime.perception.evidence import Reading, Statement

ASSERTED, DENIED, UNSURE = "^", "-", "~"
"""Under words that assert a fact, that deny one, and that were set aside or are doubted."""
_PIECE = re.compile(r"\s*\S+")


def reading_data(reading: Reading, vocabulary: Vocabulary) -> dict[str, Any]:
    """The reading for programs: values as people write them, spans as [start, end) in characters of the text."""
    return {
        "text": reading.text,
        "statements": [
            {
                "fact": item.fact, "value": vocabulary.fact(item.fact).show(item.value), "certainty": item.certainty, "rule": item.rule,
                "spans": [[span.start, span.end] for span in item.spans],
            }
            for item in reading.statements
        ],
        "set_aside": [{"fact": name, "span": [span.start, span.end], "why": why} for name, span, why in reading.set_aside],
    }  # fmt: skip


def reading_text(reading: Reading, vocabulary: Vocabulary) -> str:
    """The reading for people, at most 80 columns wide."""
    lines = [*_underlined(reading), ""]
    lines += [*_table(reading, vocabulary)] or ["The text states no fact of the vocabulary; silence is unknown, never absent."]
    if reading.set_aside:
        lines += ["", "set aside:"]
        seen = dict.fromkeys((name, reading.text[span.start : span.end], why) for name, span, why in reading.set_aside)
        for name, words, why in seen:
            lines += _wrapped(f"  {name}  {why}: {_one_line(words)}")
    return "\n".join(lines)


def _marks(reading: Reading) -> list[str]:
    """The mark under each character of the text."""
    marks = [" "] * len(reading.text)
    for _, span, _ in reading.set_aside:
        marks[span.start : span.end] = UNSURE * (span.end - span.start)
    for item in sorted(reading.statements, key=lambda item: item.certainty == "asserted"):
        mark = UNSURE if item.certainty == "hedged" else DENIED if item.value is False else ASSERTED
        for span in item.spans:
            marks[span.start : span.end] = mark * (span.end - span.start)
    return marks


def _underlined(reading: Reading) -> Iterator[str]:
    marks = _marks(reading)
    for start, end in _lines(reading.text):
        yield reading.text[start:end].replace("\t", " ")
        below = "".join(marks[start:end]).rstrip()
        if below:
            yield below


def _lines(text: str) -> Iterator[tuple[int, int]]:
    """[start, end) of lines of at most 80 columns, broken at spaces."""
    at = 0
    for line in text.split("\n"):
        start = end = at
        for piece in _PIECE.finditer(line):
            stop = at + piece.end()
            if stop - start > WIDTH and end > start:
                yield start, end
                start = at + piece.start() + len(piece[0]) - len(piece[0].lstrip())
            end = stop
        yield start, end
        at += len(line) + 1


def _table(reading: Reading, vocabulary: Vocabulary) -> Iterator[str]:
    for item in reading.statements:
        value = vocabulary.fact(item.fact).show(item.value)
        doubt = " (only perhaps)" if item.certainty == "hedged" else ""
        yield from _wrapped(f"{item.fact} = {value}{doubt}  {_evidence(item, reading.text)}")


def _evidence(item: Statement, text: str) -> str:
    words = " ... ".join(_one_line(text[span.start : span.end]) for span in item.spans)
    return f"{words}  by {item.rule}"


def _one_line(words: str) -> str:
    return '"' + " ".join(words.split()) + '"'


def _wrapped(line: str) -> list[str]:
    return textwrap.wrap(line, WIDTH, subsequent_indent="    ", break_on_hyphens=False)
