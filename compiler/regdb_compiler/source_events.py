"""libyaml's events made into a tree in one loop, which is where reading spends its time."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import yaml
from yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.source_errors import syntax_error
from regdb_compiler.tree import Lines, Mapping, Node, Scalar, Sequence

MAX_DEPTH = 60
MAX_PROBLEMS = 20
NOT_TEXT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]")
ADVICE = {
    "R006": "write the value out where it is needed; if the `&` or `*` is text, put it in quotes",
    "R007": "write the keys out where they are needed",
    "R008": "remove the tag; if the `!` is text, put it in quotes",
}


class StopReading(Exception):  # noqa: N818 - says what to do, and never leaves the package
    """Reading cannot go on."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


_Opened = tuple[list[Any], Any, bool]
"""A collection being read: what stood around it so far, its start event, and whether it is a mapping."""


class _Reading:
    """One file being read: its lines, the problems so far, and whether the tree is what the author meant."""

    def __init__(self, lines: Lines, problems: list[Diagnostic]) -> None:
        self.lines = lines
        self.problems = problems
        self.whole = True
        self.documents = 0

    def report(self, code: str, name: str, message: str, start: int, end: int, advice: str = "") -> None:
        """Note a problem; after too many the file is given up, as more would help nobody."""
        self.add(Diagnostic(code, name, "error", message, self.lines.place(start, end), help=advice))

    def add(self, problem: Diagnostic) -> None:
        self.problems.append(problem)
        if len(self.problems) >= MAX_PROBLEMS:
            raise StopReading(Diagnostic("R001", "yaml-syntax", "error", "too many problems; reading stops here", problem.place))


def read_events(lines: Lines, problems: list[Diagnostic]) -> tuple[Node | None, bool]:
    """The tree of a text, and whether its structure is certain; problems are added to the list.

    Raises StopReading with one diagnostic where the text is not YAML or not acceptable at all.
    """
    reading = _Reading(lines, problems)
    try:
        roots = _build(getattr(yaml, "CLoader", yaml.Loader)(lines.text).get_event, reading)
    except yaml.MarkedYAMLError as error:
        raise StopReading(_explained(lines, error)) from None
    except (yaml.YAMLError, UnicodeEncodeError):
        raise StopReading(_control_character(lines)) from None
    return (roots[0] if roots else None), reading.whole


def _build(next_event: Callable[[], Any], reading: _Reading) -> list[Any]:
    """The loop. What is rare is handed out to functions; what is common stays here, as calls are what costs."""
    lines = reading.lines
    around: list[_Opened] = []
    items: list[Any] = []
    append = items.append
    for event in iter(next_event, None):
        kind = event.__class__
        if kind is ScalarEvent:
            if event.anchor is not None or event.tag is not None:
                _refuse_properties(event, reading)
            append(Scalar(event.value, not event.style, lines, event.start_mark.index, event.end_mark.index))
        elif kind is MappingStartEvent or kind is SequenceStartEvent:
            if event.anchor is not None or event.tag is not None:
                _refuse_properties(event, reading)
            if len(around) >= MAX_DEPTH:
                _refuse_depth(event, reading)
            around.append((items, event, kind is MappingStartEvent))
            items = []
            append = items.append
        elif kind is MappingEndEvent or kind is SequenceEndEvent:
            outer, start, keyed = around.pop()
            node = (_mapping if keyed else _sequence)(items, start, event.end_mark.index, reading)
            items = outer
            append = items.append
            append(node)
        elif kind is AliasEvent:
            append(_refuse_alias(event, reading))
        elif kind is DocumentStartEvent and _is_second(event, reading):
            break
    return items


def _sequence(items: list[Any], start: Any, end: int, reading: _Reading) -> Sequence:
    return Sequence(tuple(items), start.flow_style, reading.lines, start.start_mark.index, end)


def _mapping(items: list[Any], start: Any, end: int, reading: _Reading) -> Mapping:
    entries = tuple(zip(items[::2], items[1::2], strict=True))
    try:
        index = {key.text: value for key, value in entries}
    except AttributeError:
        entries = _only_text_keys(entries, reading)
        index = {key.text: value for key, value in entries}
    if len(index) != len(entries):
        entries = _first_of_each(entries, reading)
        index = {key.text: value for key, value in entries}
    if "<<" in index:
        _refuse_merge(entries, reading)
    return Mapping(entries, index, start.flow_style, reading.lines, start.start_mark.index, end)


def _only_text_keys(entries: tuple[tuple[Any, Any], ...], reading: _Reading) -> tuple[tuple[Any, Any], ...]:
    """Report the keys that are lists or mappings, and leave their entries out."""
    for key, _ in entries:
        if not isinstance(key, Scalar):
            shape = "list" if isinstance(key, Sequence) else "mapping"
            advice = "write one word as key; put it in quotes if the brackets or braces are text"
            reading.report("R012", "key-not-text", f"this key is a {shape}", key.start, key.content_end, advice)
    return tuple(pair for pair in entries if isinstance(pair[0], Scalar))


def _first_of_each(entries: tuple[tuple[Scalar, Node], ...], reading: _Reading) -> tuple[tuple[Scalar, Node], ...]:
    """Report keys written twice, with both places, and keep the first entry of each."""
    kept: dict[str, tuple[Scalar, Node]] = {}
    for key, value in entries:
        first = kept.setdefault(key.text, (key, value))[0]
        if first is not key:
            message = f"`{key.text[:40]}` is written twice in one mapping"
            reading.add(
                Diagnostic(
                    "R005", "duplicate-key", "error", message, key.place, note="written again here",
                    help="keep one of the two", related=((first.place, "first written here"),),
                )
            )  # fmt: skip
    return tuple(kept.values())


def _refuse_merge(entries: tuple[tuple[Scalar, Node], ...], reading: _Reading) -> None:
    for key, _ in entries:
        if key.text == "<<" and key.plain:
            reading.whole = False
            message = "merge keys are not used: law is read where it stands"
            reading.report("R007", "merge-key", message, key.start, key.end, ADVICE["R007"])


def _refuse_properties(event: Any, reading: _Reading) -> None:
    """An anchor or a tag before a value; its place begins at the first of them."""
    start, text = event.start_mark.index, reading.lines.text
    for sign, given, code, name in (
        ("&", event.anchor, "R006", "anchor-or-alias"),
        ("!", event.tag, "R008", "yaml-tag"),
    ):
        at = text.find(sign, start)
        if given is not None and at >= 0:
            word = text[at:].split(None, 1)[0][:60]
            thing = "anchors are not used" if sign == "&" else "tags are not used: the schema gives a value its type"
            reading.report(code, name, f"`{word}`: {thing}", at, at + len(word), ADVICE[code])


def _refuse_alias(event: Any, reading: _Reading) -> Scalar:
    """An alias is reported and not followed, so that ten lines cannot stand for ten million."""
    start, end = event.start_mark.index, event.end_mark.index
    word = reading.lines.text[start:end]
    reading.whole = False
    message = f"`{word[:40]}`: aliases are not used: law is read where it stands"
    reading.report("R006", "anchor-or-alias", message, start, end, ADVICE["R006"])
    return Scalar(word, plain=True, lines=reading.lines, start=start, end=end)


def _refuse_depth(event: Any, reading: _Reading) -> None:
    at = event.start_mark.index
    message = f"lists and mappings are nested deeper than {MAX_DEPTH} here"
    raise StopReading(Diagnostic("R009", "nesting-too-deep", "error", message, reading.lines.place(at, at + 1)))


def _is_second(event: Any, reading: _Reading) -> bool:
    """Whether another document begins; it is not read, as nothing says which of the two is meant."""
    reading.documents += 1
    if reading.documents < 2:
        return False
    at = event.start_mark.index
    message = "a second document begins here; one file is one document"
    advice = "remove the `---` line, or put what follows into a file of its own"
    reading.report("R011", "several-documents", message, at, at + 3, advice)
    return True


def _explained(lines: Lines, error: yaml.MarkedYAMLError) -> Diagnostic:
    """libyaml's error in our words."""
    context = error.context_mark.index if error.context_mark else None
    at = error.problem_mark.index if error.problem_mark else context or 0
    return syntax_error(lines, error.problem or "", at, error.context or "", context)


def _control_character(lines: Lines) -> Diagnostic:
    """libyaml says that some character is not text, but not on which line."""
    bad = NOT_TEXT.search(lines.text)
    at = bad.start() if bad else 0
    what = f"the character U+{ord(bad[0]):04X}" if bad else "a character"
    message = f"{what} is not text" if bad and bad[0] != "\0" else "the file is not text (it holds zero bytes)"
    return Diagnostic("R004", "not-text", "error", message, lines.place(at, at + 1), help="delete the character")
