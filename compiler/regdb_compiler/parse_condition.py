"""Condition text -> condition tree, typed by the vocabulary; each problem says where, what was expected, and the likely mistake."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from lark import Lark, Token, Transformer, UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, UnexpectedToken, v_args

from regdb.condition import Node
from regdb.units import UNITS
from regdb.vocabulary import Vocabulary
from regdb_compiler.quick_condition import read_linear_quickly, read_quickly
from regdb_compiler.raw_condition import Raw, RawCompare, RawHas, RawJoin, RawKnown, RawName, RawNot, RawOneOf, RawTerm, RawWithin, Word
from regdb_compiler.type_condition import Problem, Typer

CONDITION_RULES = (
    ("R017", "condition-syntax", "The condition cannot be read; the message says what was expected and the likely mistake."),
    ("R301", "missing-unit", "A number stands where a quantity with a unit is needed; a bare 25 could be mph, km/h or m/s."),
    ("R302", "unknown-unit", "A unit the language does not have."),
    ("R303", "dimension-mismatch", "Two quantities of different dimensions are compared or added: a speed with a length."),
    ("R401", "unknown-fact", "A fact or definition that nothing declares."),
    ("R402", "unknown-word", "A word the enumeration or set does not have."),
    ("R403", "wrong-type", "A fact is used as something it is not: a quantity as a condition, a boolean as a number."),
)
_FRIENDLY = {
    "NAME": "a fact", "OPERATOR": "a comparison (==, !=, <, <=, >, >=)", "QUANTITY": "a quantity with its unit", "NUMBER": "a number",
    "TIME": "a time (07:00)", "DATE": "a date (2026-03-02)", "SIGN": "+ or -", "LPAR": "(", "RPAR": ")", "LBRACE": "{", "RBRACE": "}",
    "COMMA": ",", "STAR": "*", "AND": "`and`", "OR": "`or`", "NOT": "`not`", "IN": "`in`", "WITHIN": "`within`", "KNOWN": "known(",
    "__ANON_0": "..", "$END": "the end",
}  # fmt: skip
MAX_DEPTH = 30
"""How deep `not`, `and` and `or` may stand inside each other: far beyond law, and well within what every reader can walk."""

_MISTAKES: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"="), "write == to compare"),
    (re.compile(r"&&?"), "write `and`"),
    (re.compile(r"\|\|?"), "write `or`"),
    (re.compile(r"!(?!=)"), "write `not`"),
    (re.compile(r"/"), "division is not in the language; multiply the other side"),
    (re.compile(r"[\"']"), "words need no quotes"),
    (re.compile(r"\["), "a choice of words stands in braces: {a, b}"),
    (re.compile(r"≤"), "write <="),
    (re.compile(r"≥"), "write >="),
)


@dataclass(frozen=True, slots=True)
class Parsed:
    """A condition as read: its tree, or None with the problems; `uses` are the definitions it names."""

    node: Node | None
    problems: tuple[Problem, ...] = ()
    uses: tuple[str, ...] = ()


def parse_condition(text: str, vocabulary: Vocabulary, definition: Callable[[str], Node | None] | None = None) -> Parsed:
    """Read a condition. `definition` gives the tree a bare name stands for, None when there is none."""
    raw = read_raw(text)
    if isinstance(raw, Problem):
        return Parsed(None, (raw,))
    typer = Typer(vocabulary, definition or (lambda _: None))
    node = typer.truth(raw)
    if typer.problems:
        return Parsed(None, tuple(typer.problems), tuple(typer.uses))
    return Parsed(node, (), tuple(typer.uses))


def read_raw(text: str) -> Raw | Problem:
    """The condition before types: words with their offsets, or the one reason why it cannot be read."""
    raw = read_quickly(text) or read_by_grammar(text)
    if not isinstance(raw, Problem) and _is_deep(raw):
        message = f"the condition is nested deeper than {MAX_DEPTH} levels"
        return Problem("R017", "condition-syntax", message, 0, min(len(text), 40), "name parts of it as definitions")
    return raw


def read_by_grammar(text: str) -> Raw | Problem:
    """The condition by the grammar itself, however deep: the reference for the quick reader, and the source of every message."""
    try:
        return _parser().parse(text, start="start")  # type: ignore[return-value]  # the transformer returns Raw
    except UnexpectedInput as error:
        return _syntax_problem(text, error)


def _is_deep(raw: Raw) -> bool:
    """Whether the condition is deeper than `MAX_DEPTH`, found level by level as recursion could not."""
    level: list[Raw] = [raw]
    for _ in range(MAX_DEPTH):
        level = [part for item in level for part in _inner(item)]
        if not level:
            return False
    return True


def _inner(raw: Raw) -> tuple[Raw, ...]:
    return raw.parts if isinstance(raw, RawJoin) else (raw.part,) if isinstance(raw, RawNot) else ()


def read_linear(text: str) -> tuple[RawTerm, ...] | Problem:
    """A limit's bound before types: `25 mph`, `posted.speed - 5 mph`."""
    return read_linear_quickly(text) or read_linear_by_grammar(text)


def read_linear_by_grammar(text: str) -> tuple[RawTerm, ...] | Problem:
    """A limit's bound by the grammar itself."""
    try:
        return _parser().parse(text, start="linear")  # type: ignore[return-value]
    except UnexpectedInput as error:
        return _syntax_problem(text, error)


@cache
def _parser() -> Lark:
    grammar = files(__package__).joinpath("condition.lark").read_text("utf-8")
    return Lark(grammar, parser="lalr", start=["start", "linear"], transformer=_Build(), maybe_placeholders=False, propagate_positions=False)


def _word(token: Token) -> Word:
    return Word(str(token), token.type, token.start_pos or 0, token.end_pos or 0)


@v_args(inline=True)
class _Build(Transformer[Token, Raw]):
    """Raw nodes straight from the parser's reductions."""

    def either(self, *parts: Raw) -> Raw:
        return RawJoin("or", parts) if len(parts) > 1 else parts[0]

    def both(self, *parts: Raw) -> Raw:
        return RawJoin("and", parts) if len(parts) > 1 else parts[0]

    def negated(self, part: Raw) -> Raw:
        return RawNot(part)

    def known(self, name: Token) -> Raw:
        return RawKnown(_word(name))

    def name(self, name: Token) -> Raw:
        return RawName(_word(name))

    def one_of(self, name: Token, *words: Token) -> Raw:
        return RawOneOf(_word(name), tuple(map(_word, words)))

    def has(self, word: Token, fact: Token) -> Raw:
        return RawHas(_word(word), _word(fact))

    def within(self, name: Token, start: Token, end: Token) -> Raw:
        return RawWithin(_word(name), _word(start), _word(end))

    def compare(self, left: tuple[RawTerm, ...], op: Token, right: tuple[RawTerm, ...]) -> Raw:
        return RawCompare(_word(op), left, right)

    def linear(self, *parts: Token | tuple[Word, ...]) -> tuple[RawTerm, ...]:
        terms, sign = [], 1
        for part in parts:
            if isinstance(part, Token):
                sign = -1 if part == "-" else 1
            else:
                terms.append(RawTerm(sign, part))
        return tuple(terms)

    def term(self, factor: Token) -> tuple[Word, ...]:
        return (_word(factor),)

    def product(self, first: Token, second: Token) -> tuple[Word, ...]:
        return (_word(first), _word(second))


def _syntax_problem(text: str, error: UnexpectedInput) -> Problem:
    at = error.pos_in_stream if error.pos_in_stream is not None and error.pos_in_stream >= 0 else len(text)
    if isinstance(error, UnexpectedEOF) or (isinstance(error, UnexpectedToken) and error.token.type == "$END"):
        at = len(text.rstrip())
        return Problem("R017", "condition-syntax", "the condition ends too early", max(at - 1, 0), at, f"expected {_expected(error)}")
    hint = _mistake(text, at)
    unit = _unit_problem(text, at)
    if unit is not None:
        return unit
    if isinstance(error, UnexpectedCharacters):
        end, got = at + 1, repr(text[at])
    else:
        token = error.token if isinstance(error, UnexpectedToken) else Token("", text[at : at + 1])
        end, got = at + max(len(token), 1), f"`{token}`"
    return Problem("R017", "condition-syntax", f"{got} cannot stand here", at, end, hint or f"expected {_expected(error)}")


def _mistake(text: str, at: int) -> str:
    for pattern, hint in _MISTAKES:
        if pattern.match(text, at):
            return hint
    return ""


def _unit_problem(text: str, at: int) -> Problem | None:
    """A word right after a number is a unit the language does not have."""
    before, word = re.search(r"\d\s*\Z", text[:at]), re.match(r"[A-Za-z/]+", text[at:])
    if before is None or word is None or word[0] in {"and", "or", "in", "within", "not"}:
        return None
    near = difflib.get_close_matches(word[0], [u for u in UNITS if u], 1, 0.6)
    hint = f"did you mean {near[0]}? " if near else ""
    known = ", ".join(u for u in UNITS if u)
    return Problem("R302", "unknown-unit", f"unknown unit `{word[0]}`", at, at + len(word[0]), f"{hint}units: {known}")


def _expected(error: UnexpectedInput) -> str:
    names = getattr(error, "accepts", None) or getattr(error, "allowed", None) or getattr(error, "expected", None) or ()
    words = sorted({_FRIENDLY.get(str(name), str(name).lower()) for name in names} - {"+ or -", "*"})
    return ", ".join(words[:-1]) + " or " + words[-1] if len(words) > 1 else "".join(words) or "nothing more"
