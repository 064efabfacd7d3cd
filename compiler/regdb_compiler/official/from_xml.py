"""USLM and Akoma Ntoso -> passages; documents that declare entities are refused before anything of them is expanded."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from xml.parsers import expat

from regdb_compiler.official.from_plain import NUMBER, whole_passage
from regdb_compiler.official.passage import Passage, UnreadableTextError

_LINES = frozenset(
    ("p", "content", "chapeau", "continuation", "subsection", "paragraph", "subparagraph", "clause", "subclause", "item", "subitem",
     "level", "point", "list", "intro", "wrapUp", "wrap", "proviso")
)  # fmt: skip
_NOTES = frozenset(("sourceCredit", "note", "notes", "authorialNote", "footnote", "editorialContent"))
_DATES = ("startPeriod", "effectiveDate", "start")


def read_xml(data: bytes) -> tuple[str, tuple[Passage, ...]]:
    """The dialect (uslm, akn, xml) and its sections. Raises UnreadableTextError for a DTD or broken XML."""
    _refuse_declarations(data)
    try:
        root = ElementTree.fromstring(data)
    except ElementTree.ParseError as error:
        raise UnreadableTextError(f"it is not well-formed XML: {error}") from error
    space = root.tag.partition("}")[0].lower()
    dialect = "uslm" if "uslm" in space else "akn" if "akn" in space or "akomantoso" in space else "xml"
    said = _document_date(root)
    return dialect, tuple(_passage(item, said) for item in root.iter() if _name(item) == "section" and _number(item))


def _refuse_declarations(data: bytes) -> None:
    """Entities are how a small file becomes a huge one or reads another; official XML needs none."""

    def refuse(*_: object) -> None:
        raise UnreadableTextError("it declares a document type; save it without its DTD")

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(data, True)  # noqa: FBT003  # expat takes no names
    except expat.ExpatError as error:
        raise UnreadableTextError(f"it is not well-formed XML: {error}") from error


def _name(item: ElementTree.Element) -> str:
    return item.tag.rpartition("}")[2] if isinstance(item.tag, str) else ""


def _number(section: ElementTree.Element) -> str:
    """The section's number as its `num` gives it."""
    for child in section:
        if _name(child) == "num":
            match = re.search(NUMBER, child.get("value") or "".join(child.itertext()))
            return match[0] if match else ""
    return ""


def _passage(section: ElementTree.Element, document_date: str) -> Passage:
    heading = next((_words(child) for child in section if _name(child) in {"heading", "subheading"}), "")
    lines = [line for line in _lines(section) if line]
    notes = [_words(item) for item in section.iter() if _name(item) in _NOTES]
    given = next((value[:10] for key in _DATES if (value := section.get(key))), "")
    return whole_passage(_number(section), heading, lines, given or document_date, notes)


def _lines(section: ElementTree.Element) -> Iterator[str]:
    """The words of a section, a line for each paragraph or level, its number before it."""
    words: list[str] = []
    skipped = {id(child) for child in section if _name(child) in {"num", "heading", "subheading"}}
    stack: list[tuple[str, ElementTree.Element | str]] = [("open", section)]
    while stack:
        kind, item = stack.pop()
        if isinstance(item, str):
            words.append(item)
        elif id(item) not in skipped and _name(item) not in _NOTES:
            if kind == "close" or (_name(item) in _LINES and _name(item) not in {"content", "p", "chapeau"}):
                yield " ".join("".join(words).split())
                words = []
            if kind == "open":
                stack += reversed(_inside(item))
    yield " ".join("".join(words).split())


def _inside(item: ElementTree.Element) -> list[tuple[str, ElementTree.Element | str]]:
    parts: list[tuple[str, ElementTree.Element | str]] = [("text", item.text or "")]
    for child in item:
        parts += [("open", child), ("text", " " + (child.tail or "") if _name(child) == "num" else child.tail or "")]
    return [*parts, ("close", item)] if _name(item) in _LINES else parts


def _words(item: ElementTree.Element) -> str:
    return " ".join("".join(item.itertext()).split())


def _document_date(root: ElementTree.Element) -> str:
    """The date of the text that the document's metadata give: Akoma Ntoso's expression."""
    for item in root.iter():
        if _name(item) == "FRBRExpression":
            return next((date[:10] for part in item.iter() if (date := part.get("date"))), "")
    return ""
