"""What `regdb text` tells of attached texts, as data: their state beside the annotation, and what has been altered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict
from typing import Any

from regdb.front import FrontError
from regdb_compiler.corpus import Corpus
from regdb_compiler.official.annotated import number_key
from regdb_compiler.official.shelf import Accepted, Attached, Shelf, words_hash

Data = dict[str, Any]


def listed(shelf: Shelf, names: Iterable[tuple[str, str]] | None, corpus: Corpus) -> list[Data]:
    """Every attached text, or those of these sections, by code and number."""
    wanted = None if names is None else set(names)
    chosen = [item for item in shelf.texts if wanted is None or (item.code, item.section) in wanted]
    chosen.sort(key=lambda item: (item.code, number_key(item.section), item.version))
    annotated = {(section.jurisdiction.code, section.doc.section) for section in corpus.sections}
    return [{**asdict(item), "state": state(shelf, item), "annotated": (item.code, item.section) in annotated} for item in chosen]


def state(shelf: Shelf, item: Attached) -> str:
    """accepted, changed (another text was accepted) or attached (none was)."""
    known = {other.sha256 for other in shelf.accepted_of(item.code, item.section)}
    return "attached" if not known else "accepted" if item.sha256 in known else "changed"


def altered(shelf: Shelf) -> Iterator[str]:
    """One sentence for each file that is gone or no longer holds the words that were attached or accepted."""
    kept: list[Attached | Accepted] = [*shelf.texts, *shelf.accepted]
    for item in kept:
        try:
            if words_hash(shelf.words(item)) != item.sha256:
                yield f"{shelf.folder / item.file} was altered after it was attached"
        except FrontError as error:
            yield str(error)
