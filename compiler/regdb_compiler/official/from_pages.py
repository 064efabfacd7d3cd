"""Pages of the state's site and of the two code publishers -> passages: how each marks where a section begins and ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from regdb_compiler.official.from_plain import head_of, whole_passage
from regdb_compiler.official.html_blocks import Block, read_blocks
from regdb_compiler.official.passage import Passage

Starts = Callable[[Block], bool]
_LEGINFO = frozenset(("#codeLawSectionNoHead", "#manylawsections", "#single_law_section", "#displayCodeSection"))
_DIVIDERS = frozenset((".Chapter", ".Article", ".Division", ".Part", ".Title", ".Subchapter"))
_INCREMENTS = tuple(f".incr{level}" for level in range(10))


def read_page(page: str) -> tuple[str, tuple[Passage, ...]]:
    """The kind of page (leginfo, amlegal, municode, html) and its sections."""
    blocks = read_blocks(page)
    marks = frozenset().union(*(block.marks for block in blocks)) if blocks else frozenset()
    if marks & _LEGINFO or "leginfo.legislature.ca.gov" in page:
        return "leginfo", tuple(_leginfo(blocks))
    if marks & {".chunk-title", ".chunk-content", ".chunk"}:
        return "municode", tuple(_municode(blocks))
    if ".rbox" in marks or "codelibrary.amlegal.com" in page:
        return "amlegal", tuple(_amlegal(blocks))
    return "html", tuple(_sections(blocks, lambda block: head_of(block.text) is not None))


def _leginfo(blocks: Iterable[Block]) -> Iterator[Passage]:
    """The state's site: the number stands alone in an h6, before the first words; other headings belong to articles and chapters."""
    inside = [block for block in blocks if block.marks & _LEGINFO] or list(blocks)
    return _sections(inside, lambda block: "h6" in block.marks, lambda block: block.is_heading)


def _amlegal(blocks: Iterable[Block]) -> Iterator[Passage]:
    """American Legal: `SEC. 80.36. TITLE.` in a box of the class Section, paragraphs in boxes beside it."""
    listed = list(blocks)
    if any(".Section" in block.marks for block in listed):
        return _sections(listed, lambda block: ".Section" in block.marks, lambda block: bool(block.marks & _DIVIDERS))
    return _sections(listed, lambda block: block.is_heading, lambda block: bool(block.marks & _DIVIDERS))


def _municode(blocks: Iterable[Block]) -> Iterator[Passage]:
    """Municode: `15.76.010 - Title.` in a chunk's title; a paragraph's mark stands in a block of its own before its words."""
    return _sections(_joined(blocks), lambda block: ".chunk-title" in block.marks)


def _joined(blocks: Iterable[Block]) -> Iterator[Block]:
    mark = ""
    for block in blocks:
        if block.marks.intersection(_INCREMENTS):
            mark = f"{mark} {block.text}".strip()
            continue
        yield Block(f"{mark} {block.text}".strip(), block.marks)
        mark = ""


def _sections(blocks: Iterable[Block], starts: Starts, ends: Starts = lambda _: False) -> Iterator[Passage]:
    """A section from each block that starts one and bears a number, up to the next start or end."""
    number, heading, lines = "", "", list[str]()
    for block in blocks:
        head = head_of(block.text) if starts(block) else None
        if head is None and not (starts(block) or ends(block)):
            lines.append(block.text)
            continue
        if number and (lines or heading):
            yield whole_passage(number, heading, lines)
        number, heading = head or ("", "")
        lines = []
    if number and (lines or heading):
        yield whole_passage(number, heading, lines)
