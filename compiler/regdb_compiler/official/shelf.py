"""The folder of attached texts: one file per section and an index of where each came from, what its hash is, which was accepted."""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import re
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from regdb.front import FrontError, shipped_codes
from regdb_compiler.fixes import write_beside
from regdb_compiler.official.comparing import normal
from regdb_compiler.official.passage import Passage
from regdb_compiler.official.reading import SourceText

FORMAT = 1
TEXTS = "REGDB_TEXTS"
"""Environment variable that names the folder of attached texts."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._\-]*\Z")


@dataclass(frozen=True, slots=True)
class Attached:
    """One attached text. `version` is the day its text took effect where the source says it, `attached` the day it was put here;
    `sha256` is the hash of its words (spacing and typography aside), `source_sha256` that of the page or file."""

    code: str
    section: str
    heading: str
    version: str
    note: str
    source: str
    format: str
    source_sha256: str
    sha256: str
    attached: str
    file: str

    @property
    def id(self) -> str:
        return f"{self.code}-{self.section}"


@dataclass(frozen=True, slots=True)
class Accepted:
    """A text against which a section's annotation has been checked: the hash of its words, the day, and a copy."""

    code: str
    section: str
    sha256: str
    on: str
    file: str


@dataclass(frozen=True, slots=True)
class Shelf:
    """Everything attached. Nothing in it changes: each step gives a new shelf, `write_shelf` keeps it."""

    folder: Path
    texts: tuple[Attached, ...] = ()
    accepted: tuple[Accepted, ...] = ()

    def of(self, code: str, section: str) -> tuple[Attached, ...]:
        """The texts of a section, one for each date that its sources give."""
        return tuple(item for item in self.texts if (item.code, item.section) == (code, section))

    def accepted_of(self, code: str, section: str) -> tuple[Accepted, ...]:
        return tuple(item for item in self.accepted if (item.code, item.section) == (code, section))

    def words(self, item: Attached | Accepted) -> str:
        """The words of an attached text. Raises FrontError when its file is gone."""
        try:
            return (self.folder / item.file).read_text("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise FrontError(f"{self.folder / item.file} cannot be read; attach the text again, or forget it") from error


def texts_folder(codes: Path, named: Path | None = None) -> Path:
    """The folder of attached texts: the one named, else REGDB_TEXTS, else `texts/` beside the codes (in the working directory
    where the codes are those inside the installed package)."""
    if named is not None:
        return named
    if os.environ.get(TEXTS):
        return Path(os.environ[TEXTS])
    installed = codes.resolve() == shipped_codes().resolve() and (shipped_codes().parent / "schema.py").exists()
    return Path("texts") if installed else codes.resolve().parent / "texts"


def read_shelf(folder: Path) -> Shelf:
    """What is attached; nothing where there is no index. Raises FrontError for an index that cannot be read."""
    index = folder / "index.json"
    if not index.exists():
        return Shelf(folder)
    try:
        data = json.loads(index.read_text("utf-8"))
        if data["format"] != FORMAT:
            raise FrontError(f"{index} has format {data['format']}; this regdb reads {FORMAT}")
        texts = tuple(Attached(**item) for item in data["texts"])
        accepted = tuple(Accepted(**item) for item in data["accepted"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise FrontError(f"{index} cannot be read: {error}") from error
    for name in (*(item.file for item in texts), *(item.file for item in accepted)):
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise FrontError(f"{index} names {name}, which lies outside {folder}")
    return Shelf(folder, texts, accepted)


def write_shelf(shelf: Shelf) -> None:
    """Write the index in one step. Raises FrontError when the folder cannot be written."""
    data: dict[str, Any] = {
        "format": FORMAT,
        "texts": [asdict(item) for item in sorted(shelf.texts, key=lambda item: (item.code, item.section, item.version))],
        "accepted": [asdict(item) for item in sorted(shelf.accepted, key=lambda item: (item.code, item.section, item.on))],
    }
    _write(shelf.folder / "index.json", json.dumps(data, indent=1, ensure_ascii=False) + "\n")


def attach(shelf: Shelf, code: str, source: SourceText, today: datetime.date) -> Shelf:
    """The shelf with a source's sections on it, in place of what it had of the same sections and dates; their files are written.

    A text of another date stays: it shows another version of its section.
    """
    put = [_put(shelf.folder, code, item, source, today) for item in source.passages]
    replaced = {(item.code, item.section, item.version) for item in put}
    kept = [item for item in shelf.texts if (item.code, item.section, item.version) not in replaced]
    return replace(shelf, texts=(*kept, *put))


def accept(shelf: Shelf, code: str, section: str, today: datetime.date) -> Shelf:
    """The shelf with the present texts of a section accepted as what its annotation was checked against."""
    kept = [item for item in shelf.accepted if (item.code, item.section) != (code, section)]
    old = [item.file for item in shelf.accepted_of(code, section)]
    new = []
    for item in shelf.of(code, section):
        file = f"{code}/accepted/{Path(item.file).name}"
        _write(shelf.folder / file, shelf.words(item))
        new.append(Accepted(code, section, item.sha256, today.isoformat(), file))
    _drop(shelf.folder, (name for name in old if name not in {item.file for item in new}))
    return replace(shelf, accepted=(*kept, *new))


def forget(shelf: Shelf, code: str, section: str) -> Shelf:
    """The shelf without a section; its files are removed."""
    _drop(shelf.folder, (item.file for item in shelf.of(code, section)))
    _drop(shelf.folder, (item.file for item in shelf.accepted_of(code, section)))
    texts = tuple(item for item in shelf.texts if (item.code, item.section) != (code, section))
    accepted = tuple(item for item in shelf.accepted if (item.code, item.section) != (code, section))
    return replace(shelf, texts=texts, accepted=accepted)


def words_hash(text: str) -> str:
    """Hex SHA-256 of a text's words; the same for two copies that differ in spacing or typography alone."""
    return hashlib.sha256(normal(text).encode()).hexdigest()


def _put(folder: Path, code: str, item: Passage, source: SourceText, today: datetime.date) -> Attached:
    if not _NAME.match(code) or not _NAME.match(item.section):
        raise FrontError(f"{code} {item.section} cannot be the name of a section")
    file = f"{code}/{item.section}{'@' if item.version else ''}{item.version}.txt"
    _write(folder / file, item.text + "\n")
    return Attached(
        code, item.section, item.heading, item.version, item.note, source.source, source.form, source.sha256, words_hash(item.text),
        today.isoformat(), file,
    )  # fmt: skip


def _write(path: Path, text: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_beside(path, text)
    except OSError as error:
        raise FrontError(f"{path} cannot be written: {error.strerror}") from error


def _drop(folder: Path, files: Iterable[str]) -> None:
    for name in files:
        (folder / name).unlink(missing_ok=True)
