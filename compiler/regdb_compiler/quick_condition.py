"""The common conditions read by one pass over their tokens: what the grammar gives, ten times as fast, or nothing.

The grammar (condition.lark) is the language. This reads the same words into the same tree and gives up (None) at whatever it does not
expect, so that the grammar's parser reads the text and says what is wrong. A test holds the two together.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.raw_condition import Raw, RawCompare, RawHas, RawJoin, RawKnown, RawName, RawNot, RawOneOf, RawTerm, RawWithin, Word

_TOKENS = re.compile(
    r"\s*(?:(?P<DATE>\d{4}-\d{2}-\d{2})"
    r"|(?P<TIME>\d{1,2}:\d{2}(?::\d{2})?)"
    r"|(?P<QUANTITY>\d+(?:\.\d+)?\s*(?:mph|km/h|m/s2|m/s|ft/s2|ft|in(?!\s*\{)|mi|min|m|s|h|lb|kg|deg|%)(?![A-Za-z0-9_/]))"
    r"|(?P<NUMBER>\d+(?:\.\d+)?)"
    r"|(?P<NAME>[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z0-9_]+)*)"
    r"|(?P<OPERATOR><=|>=|==|!=|<|>)"
    r"|(?P<SIGN>[+-])"
    r"|(?P<MARK>\.\.|[(){},*]))"
)
_KEYWORDS = frozenset({"and", "or", "not", "in", "within", "known"})
_LITERALS = frozenset({"QUANTITY", "NUMBER", "TIME", "DATE"})
_END = Word("", "END", 0, 0)


class _GiveUpError(Exception):
    """Something the common form does not have."""


def read_quickly(text: str) -> Raw | None:
    """The condition as the grammar would read it, or None when it is not in the common form."""
    try:
        reader = _Reader(_words(text))
        raw = reader.join()
        return raw if reader.word is _END else None
    except (_GiveUpError, RecursionError):
        return None


def read_linear_quickly(text: str) -> tuple[RawTerm, ...] | None:
    """A limit's bound as the grammar would read it, or None when it is not in the common form."""
    try:
        reader = _Reader(_words(text))
        terms = reader.linear()
        return terms if reader.word is _END else None
    except _GiveUpError:
        return None


def _words(text: str) -> Iterator[Word]:
    at, end = 0, len(text.rstrip())
    while at < end:
        match = _TOKENS.match(text, at)
        if match is None:
            raise _GiveUpError
        kind = match.lastgroup or ""
        word = match[kind]
        at = match.end()
        if (kind == "NAME" and word in _KEYWORDS) or kind == "MARK":
            kind = word
        yield Word(word, kind, at - len(word), at)


class _Reader:
    """Recursive descent over the words, one of look-ahead."""

    def __init__(self, words: Iterator[Word]) -> None:
        self.words = words
        self.word = next(words, _END)

    def take(self, kind: str) -> Word:
        word = self.word
        if word.kind != kind:
            raise _GiveUpError
        self.word = next(self.words, _END)
        return word

    def join(self) -> Raw:
        parts = [self.both()]
        while self.word.kind == "or":
            self.take("or")
            parts.append(self.both())
        return parts[0] if len(parts) == 1 else RawJoin("or", tuple(parts))

    def both(self) -> Raw:
        parts = [self.negation()]
        while self.word.kind == "and":
            self.take("and")
            parts.append(self.negation())
        return parts[0] if len(parts) == 1 else RawJoin("and", tuple(parts))

    def negation(self) -> Raw:
        if self.word.kind == "not":
            self.take("not")
            return RawNot(self.negation())
        return self.atom()

    def atom(self) -> Raw:
        kind = self.word.kind
        if kind == "(":
            self.take("(")
            inner = self.join()
            self.take(")")
            return inner
        if kind == "known":
            self.take("known")
            self.take("(")
            name = self.take("NAME")
            self.take(")")
            return RawKnown(name)
        if kind != "NAME":
            return self.compare(self.linear())
        name = self.take("NAME")
        return self.after_name(name)

    def after_name(self, name: Word) -> Raw:
        kind = self.word.kind
        if kind == "in":
            self.take("in")
            return self.one_of(name) if self.word.kind == "{" else RawHas(name, self.take("NAME"))
        if kind == "within":
            self.take("within")
            start = self.moment()
            self.take("..")
            return RawWithin(name, start, self.moment())
        if kind in {"OPERATOR", "SIGN", "*"}:
            return self.compare(self.linear(name))
        return RawName(name)

    def one_of(self, name: Word) -> Raw:
        self.take("{")
        words = [self.take("NAME")]
        while self.word.kind == ",":
            self.take(",")
            if self.word.kind == "}":
                break
            words.append(self.take("NAME"))
        self.take("}")
        return RawOneOf(name, tuple(words))

    def moment(self) -> Word:
        return self.take("TIME" if self.word.kind == "TIME" else "DATE")

    def compare(self, left: tuple[RawTerm, ...]) -> Raw:
        return RawCompare(self.take("OPERATOR"), left, self.linear())

    def linear(self, first: Word | None = None) -> tuple[RawTerm, ...]:
        sign = 1
        if first is None and self.word.kind == "SIGN":
            sign = self.sign()
        terms = [self.term(sign, first)]
        while self.word.kind == "SIGN":
            terms.append(self.term(self.sign(), None))
        return tuple(terms)

    def sign(self) -> int:
        return -1 if self.take("SIGN").text == "-" else 1

    def term(self, sign: int, first: Word | None) -> RawTerm:
        factors = [first if first is not None else self.factor()]
        if self.word.kind == "*":
            self.take("*")
            factors.append(self.factor())
        return RawTerm(sign, tuple(factors))

    def factor(self) -> Word:
        kind = self.word.kind
        return self.take(kind if kind in _LITERALS else "NAME")
