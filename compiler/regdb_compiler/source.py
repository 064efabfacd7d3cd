"""YAML read by libyaml's events into nodes that know their places; whatever is wrong with a file is a diagnostic."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from regdb_compiler.diagnostics import Diagnostic, Place, RuleText, in_order
from regdb_compiler.source_comments import Suppression, read_suppressions
from regdb_compiler.source_events import StopReading, read_events
from regdb_compiler.tree import Lines, Mapping, Node, Scalar, Sequence

__all__ = [
    "MAX_BYTES", "SOURCE_RULES", "Lines", "Mapping", "Node", "Scalar", "Sequence", "SourceFile", "Suppression",
    "parse_text", "read_source",
]  # fmt: skip

MAX_BYTES = 2_000_000
BYTE_ORDER_MARKS = {b"\xff\xfe": "UTF-16", b"\xfe\xff": "UTF-16"}
SOURCE_RULES: tuple[RuleText, ...] = (
    ("R001", "yaml-syntax", "The file is not YAML; the message says where reading stopped and the likely mistake."),
    ("R002", "unreadable-file", "The file cannot be opened: it is missing, a folder, or not permitted."),
    ("R003", "empty-file", "The file holds nothing, or nothing but comments."),
    ("R004", "not-text", "The file is not UTF-8 text, or holds control characters."),
    ("R005", "duplicate-key", "A key is written twice in one mapping, so one of the two would be lost silently."),
    ("R006", "anchor-or-alias", "Anchors (`&a`) and aliases (`*a`) are not used: law is read where it stands."),
    ("R007", "merge-key", "Merge keys (`<<`) are not used: law is read where it stands."),
    ("R008", "yaml-tag", "Tags (`!name`, `!!type`) are not used: the schema alone gives a value its type."),
    ("R009", "nesting-too-deep", "Lists and mappings are nested deeper than any law needs."),
    ("R010", "file-too-large", "The file is larger than a section of law can be."),
    ("R011", "several-documents", "The file holds more than one YAML document; one file is one document."),
    ("R012", "key-not-text", "A key is a list or a mapping; keys are words."),
)
NAMES = {code: name for code, name, _ in SOURCE_RULES}


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A file as read. `root` is None if the structure is not certain; `comments` are those that allow findings."""

    path: str
    text: str
    root: Node | None
    comments: tuple[Suppression, ...]
    diagnostics: tuple[Diagnostic, ...]


def read_source(path: Path, root: Path) -> SourceFile:
    """Read one file; its places carry its path relative to `root`. Never raises for what is in the file."""
    name = _relative(path, root)
    try:
        if not path.is_file():
            problem = "there is no such file" if not path.exists() else "this is not a regular file"
            return _unread(name, "R002", problem)
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        return _unread(name, "R002", f"the file cannot be read: {reason[:1].lower()}{reason[1:]}")
    if len(data) > MAX_BYTES:
        return _unread(name, "R010", f"the file is larger than {MAX_BYTES // 1_000_000} MB")
    return _parse_bytes(data, name)


def parse_text(text: str, path: str) -> SourceFile:
    """Read text as if it stood in the file `path`."""
    text = text.removeprefix("\ufeff")
    if len(text) > MAX_BYTES:
        return _unread(path, "R010", f"the file is larger than {MAX_BYTES // 1_000_000} MB")
    lines = Lines(path, text)
    with collector_paused():
        tree, problems, whole = _read(lines)
    if not problems and (tree is None or (isinstance(tree, Scalar) and tree.plain and not tree.text)):
        return _unread(path, "R003", "the file is empty", text, "write what belongs in it, or delete the file")
    comments = read_suppressions(lines, tree)
    return SourceFile(path, text, tree if whole else None, comments, in_order(problems))


def _read(lines: Lines) -> tuple[Node | None, list[Diagnostic], bool]:
    """The tree, the problems, and whether the tree is what the author meant."""
    problems: list[Diagnostic] = []
    try:
        tree, whole = read_events(lines, problems)
    except StopReading as stop:
        return None, [*problems, stop.diagnostic], False
    return tree, problems, whole


def _parse_bytes(data: bytes, name: str) -> SourceFile:
    encoding = BYTE_ORDER_MARKS.get(data[:2])
    if encoding:
        return _unread(name, "R004", f"the file is {encoding}, not UTF-8", advice="save it as UTF-8")
    try:
        return parse_text(data.decode("utf-8"), name)
    except UnicodeDecodeError as error:
        if b"\0" in data:
            return _unread(name, "R004", "the file is not text (it holds zero bytes)")
        good = data[: error.start].decode("utf-8")
        bad = Lines(name, good).place(len(good), len(good))
        place = Place(name, bad.line, bad.column, bad.line, bad.column + 1)
        message = f"the file is not UTF-8: byte 0x{data[error.start]:02x} belongs to no character"
        return _unread(name, "R004", message, data.decode("utf-8", "replace"), "save it as UTF-8", place)


def _relative(path: Path, root: Path) -> str:
    """The path from `root` with forward slashes; the path as given if it lies elsewhere."""
    try:
        return path.absolute().relative_to(root.absolute()).as_posix()
    except ValueError:
        return path.as_posix()


def _unread(path: str, code: str, message: str, text: str = "", advice: str = "", place: Place | None = None) -> SourceFile:
    """A file without a tree, and the reason."""
    problem = Diagnostic(code, NAMES[code], "error", message, place or Place(path, 1, 1, 1, 1), help=advice)
    return SourceFile(path, text, None, (), (problem,))


@contextmanager
def collector_paused() -> Iterator[None]:
    """Reading makes many objects and no garbage; with the cycle collector running it takes nearly twice as long."""
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            gc.enable()
