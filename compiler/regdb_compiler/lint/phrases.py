"""Phrases of the vocabulary as the rules about them see them: in small letters, without articles, one for each fact and value."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from regdb.vocabulary import Fact, Vocabulary

_WORD = re.compile(r"\{[^}]*\}|[\w|']+|~")
_ARTICLES = frozenset(("a", "an", "the"))


@dataclass(frozen=True)
class Spoken:
    """A phrase of a fact, or of one of its values (empty: the fact is true); `words` are what it is compared by."""

    fact: Fact
    value: str
    text: str
    words: tuple[str, ...]

    @property
    def name(self) -> str:
        """The fact, with the value where the phrase is for one."""
        return f"{self.fact.name} == {self.value}" if self.value else self.fact.name


def spoken(vocabulary: Vocabulary) -> Iterator[Spoken]:
    """Every phrase of every fact, as declared."""
    for fact in vocabulary:
        for value, phrases in fact.phrases.items():
            for text in phrases:
                legend = ("^",) if text.startswith("^") else ()  # said alone, it is another phrase than within a sentence
                words = (*legend, *(word for word in _WORD.findall(text.lower()) if word not in _ARTICLES))
                if words:
                    yield Spoken(fact, value, text, words)


def names(one: Fact, other: Fact) -> bool:
    """Whether one of these facts names the other, or a value of it, as confusable."""
    return _named(one, other) or _named(other, one)


def _named(one: Fact, other: Fact) -> bool:
    return any(text.partition("=")[0].strip() == other.name for text in one.confusables)
