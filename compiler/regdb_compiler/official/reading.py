"""A file, a folder or an address -> passages, whatever form they come in."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from regdb_compiler.official.fetching import MOST_BYTES, fetch, is_address
from regdb_compiler.official.from_pages import read_page
from regdb_compiler.official.from_plain import read_plain
from regdb_compiler.official.from_xml import read_xml
from regdb_compiler.official.passage import Passage, UnreadableTextError

SUFFIXES = frozenset((".html", ".htm", ".xhtml", ".xml", ".akn", ".txt", ".text"))
_CHARSET = re.compile(rb"charset\s*=\s*[\"']?([A-Za-z0-9_\-]+)", re.IGNORECASE)
_MARKUP = re.compile(r"\s*(?:<\?xml[^>]*>\s*)?(?:<!--.*?-->\s*)*<(!doctype\s+html|html|head|body|div|h[1-6]|p|span|section\s+class)\b", re.I | re.S)


@dataclass(frozen=True, slots=True)
class SourceText:
    """What one source holds: where it was (path or address), its form, the SHA-256 of its bytes, its sections."""

    source: str
    form: str
    sha256: str
    passages: tuple[Passage, ...]


def sources_in(named: str) -> tuple[str, ...]:
    """The source itself, or every readable file of a folder in order of names. Raises UnreadableTextError for what is not there."""
    if is_address(named):
        return (named,)
    path = Path(named)
    if path.is_dir():
        found = sorted(str(item) for item in path.rglob("*") if item.suffix.lower() in SUFFIXES and not _hidden(item, path))
        if not found:
            raise UnreadableTextError(f"{named} holds no file of the kinds {', '.join(sorted(SUFFIXES))}")
        return tuple(found)
    if not path.exists():
        raise UnreadableTextError(f"{named} is no file, no folder and no http address")
    return (named,)


def _hidden(item: Path, folder: Path) -> bool:
    return any(part.startswith(".") for part in item.relative_to(folder).parts)


def read_source_text(source: str) -> SourceText:
    """Read one file or address. Raises UnreadableTextError when it cannot be had or holds no section."""
    data = fetch(source) if is_address(source) else _file(Path(source))
    form, passages = read_bytes(data, "" if is_address(source) else Path(source).stem)
    if not passages:
        raise UnreadableTextError(f"{source}: no section begins in it (read as {form})")
    return SourceText(source, form, hashlib.sha256(data).hexdigest(), _whole(passages))


def read_bytes(data: bytes, name: str = "") -> tuple[str, tuple[Passage, ...]]:
    """Form and sections of what a file or page holds; `name` is the section of a plain text that has no number in it."""
    text = _decoded(data)
    if _MARKUP.match(text):
        return read_page(text)
    if text.lstrip("\ufeff \t\r\n").startswith("<"):
        return read_xml(data)
    return "plain", read_plain(text, name)


def _file(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise UnreadableTextError(f"{path} cannot be read: {error.strerror}") from error
    if len(data) > MOST_BYTES:
        raise UnreadableTextError(f"{path} is larger than {MOST_BYTES // 1_000_000} MB")
    return data


def _decoded(data: bytes) -> str:
    """Text in UTF-8, in what the page says, or in the encoding that old pages mean."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", "replace")
    said = _CHARSET.search(data[:2048])
    for name in ("utf-8-sig", said[1].decode("ascii") if said else "cp1252"):
        try:
            return data.decode(name)
        except (UnicodeDecodeError, LookupError):
            continue
    return data.decode("cp1252", "replace")


def _whole(passages: tuple[Passage, ...]) -> tuple[Passage, ...]:
    """Each text of a section once: lists of contents repeat numbers without words, pages repeat sections."""
    return tuple(_best(passages))


def _best(passages: tuple[Passage, ...]) -> Iterator[Passage]:
    kept: dict[tuple[str, str], Passage] = {}
    for item in passages:
        held = kept.get((item.section, item.version))
        if held is None or len(item.text) > len(held.text):
            kept[(item.section, item.version)] = item
    dated = {item.section for item in kept.values() if item.text}
    yield from (item for item in kept.values() if item.text or item.section not in dated)
