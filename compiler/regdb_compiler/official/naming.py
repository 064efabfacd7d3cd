"""Which code a source belongs to, and which section of which code a name means."""

from __future__ import annotations

import re
from collections.abc import Iterable

from regdb.front import FrontError
from regdb.jurisdiction import Jurisdiction
from regdb_compiler.corpus import Corpus
from regdb_compiler.official.passage import Passage
from regdb_compiler.official.shelf import Shelf

_SECTION = re.compile(r"(?P<code>.*?)[\s\-]*(?:\u00a7\s*)?(?P<number>\d[0-9.\-]*)\s*(?:\([A-Za-z0-9]+\)\s*)*\Z")
Name = tuple[str, str]
"""A code's folder and a section's number."""


def code_named(corpus: Corpus, word: str) -> str:
    """The code with this folder, id or short name. Raises FrontError with the codes there are."""
    for item in corpus.tree:
        if item.code and word.lower() in {item.code.lower(), item.id.lower(), item.short.lower(), item.long.rstrip("\u00a7 ").lower()}:
            return item.code
    raise FrontError(f"there is no code {word!r}; codes: {', '.join(_codes(corpus))}")


def code_of(corpus: Corpus, passages: Iterable[Passage]) -> str:
    """The code that has most of these sections. Raises FrontError when two have as many, or none has any."""
    numbers = {item.section for item in passages}
    known = {item.code: len(numbers & _numbers(corpus, item)) for item in corpus.tree if item.code}
    most = max(known.values(), default=0)
    best = [code for code, count in known.items() if count == most]
    if most and len(best) == 1:
        return best[0]
    if len(known) == 1:
        return next(iter(known))
    several = f"it may be of {' or '.join(best)}" if most else "no code has these sections"
    raise FrontError(f"{several}; name the code with `--code`: {', '.join(_codes(corpus))}")


def sections_named(corpus: Corpus, shelf: Shelf, words: Iterable[str]) -> tuple[Name, ...]:
    """Attached sections by names such as `CVC 21453`, `cvc-21453`, `21453`; a code's name after which no number follows means all of it.

    Raises FrontError for one that is not attached.
    """
    found: list[Name] = []
    listed = list(words)
    if len(listed) > 1 and not any(letter.isdigit() for letter in listed[0]):
        listed = [" ".join(listed[:2]), *listed[2:]]
    for word in listed:
        found += _attached(corpus, shelf, word)
    return tuple(dict.fromkeys(found))


def _attached(corpus: Corpus, shelf: Shelf, word: str) -> list[Name]:
    match = _SECTION.match(word)
    if match is None:
        raise FrontError(f"{word!r} names no section; write it as CVC 21453 or cvc-21453")
    code = code_named(corpus, match["code"]) if match["code"] else ""
    found = [(item.code, item.section) for item in shelf.texts if item.section == match["number"] and code in ("", item.code)]
    if not found:
        raise FrontError(f"no text of {word} is attached; attach one with `regdb text attach FILE`")
    return found


def _numbers(corpus: Corpus, jurisdiction: Jurisdiction) -> set[str]:
    """Section numbers of a code: its files, and its outline."""
    found = {section.doc.section for section in corpus.sections if section.jurisdiction.code == jurisdiction.code}
    for outline in corpus.outlines:
        if outline.jurisdiction.code == jurisdiction.code:
            for chapter in outline.doc.outline:
                found |= set(chapter.sections)
                found |= {number for article in chapter.articles for number in article.sections}
    return found


def _codes(corpus: Corpus) -> list[str]:
    return sorted(item.code for item in corpus.tree if item.code)
