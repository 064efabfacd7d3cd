"""JSON as models write it: fenced, with words around it, or cut off in the middle; what is whole is kept, with its place in the text."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass

DEPTH = 6
"""Answers are two levels deep; deeper nesting is garbage, and must not exhaust the stack."""

_SPACE = re.compile(r"[ \t\r\n]*")
_NUMBER = re.compile(r"(-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)(?=[,\]}\s])")
"""A number is whole only where something that cannot belong to it follows."""
_STRING = re.compile(r'"(?:[^"\\]|\\.)*"', re.DOTALL)
_WORDS: Mapping[str, object] = {"true": True, "false": False, "null": None}


class NotJson(ValueError):  # noqa: N818  # reads as what it says
    """Text that goes on as no JSON value can."""


@dataclass(frozen=True)
class Piece:
    """A value at [start, end) of the text. Lists hold Pieces, objects name -> Piece. `cut`: the text ended, or went wrong, within it."""

    value: object
    start: int
    end: int
    cut: bool = False

    def items(self) -> tuple[Piece, ...]:
        """The whole items of a list."""
        return tuple(item for item in self.value if isinstance(item, Piece)) if isinstance(self.value, list) else ()

    def members(self) -> dict[str, Piece]:
        """The members of an object that have begun; of one cut off, what is whole in it."""
        return {str(name): item for name, item in self.value.items() if isinstance(item, Piece)} if isinstance(self.value, dict) else {}


def first_object(text: str) -> Piece | None:
    """The first object of the text that has a whole member, else the first that is whole and empty; None where there is none."""
    start, empty = text.find("{"), None
    while start >= 0:
        piece = _object(text, start, 1)
        if piece.members():
            return piece
        if not piece.cut and empty is None:
            empty = piece
        start = text.find("{", start + 1) if piece.cut else text.find("{", piece.end)
        if start > _FAR:
            break
    return empty


_FAR = 8192
"""Characters in which an answer must begin; text that opens braces for longer is garbage."""


def _skip(text: str, at: int) -> int:
    match = _SPACE.match(text, at)
    return match.end() if match else at


def _value(text: str, at: int, depth: int) -> Piece:
    """The value at a place. Raises NotJson where nothing whole can be had of it."""
    if depth > DEPTH or at >= len(text):
        raise NotJson
    mark = text[at]
    if mark == "{":
        return _object(text, at, depth + 1)
    if mark == "[":
        return _array(text, at, depth + 1)
    if mark == '"':
        return _string(text, at)
    number = _NUMBER.match(text, at)
    if number:
        return Piece(json.loads(number[0]) if _sane(number[0]) else None, at, number.end())
    for word, value in _WORDS.items():
        if text.startswith(word, at):
            return Piece(value, at, at + len(word))
    raise NotJson


def _sane(number: str) -> bool:
    """Whether a number may be converted: leading zeros are none of JSON's, and thousands of digits nobody's."""
    return len(number) <= 32 and not re.match(r"-?0\d", number)


def _string(text: str, at: int) -> Piece:
    match = _STRING.match(text, at)
    if match is None:
        raise NotJson
    try:
        return Piece(json.loads(match[0], strict=False), at, match.end())
    except ValueError:
        raise NotJson from None


def _array(text: str, start: int, depth: int) -> Piece:
    items: list[Piece] = []
    at = _skip(text, start + 1)
    while at < len(text):
        if text[at] == "]":
            return Piece(items, start, at + 1)
        try:
            item = _value(text, at, depth)
        except NotJson:
            break
        items.append(item)
        if item.cut:
            at = item.end
            break
        at = _skip(text, item.end)
        if text[at : at + 1] == ",":
            at = _skip(text, at + 1)
        elif text[at : at + 1] != "]":
            break
    return Piece(items, start, at, cut=True)


def _object(text: str, start: int, depth: int) -> Piece:
    members: dict[str, Piece] = {}
    at = _skip(text, start + 1)
    while at < len(text):
        if text[at] == "}":
            return Piece(members, start, at + 1)
        try:
            name = _string(text, at)
            colon = _skip(text, name.end)
            if text[colon : colon + 1] != ":":
                break
            item = _value(text, _skip(text, colon + 1), depth)
        except NotJson:
            break
        members[str(name.value)] = item
        at = _skip(text, item.end)
        if item.cut:
            break
        if text[at : at + 1] == ",":
            at = _skip(text, at + 1)
        elif text[at : at + 1] != "}":
            break
    return Piece(members, start, at, cut=True)
