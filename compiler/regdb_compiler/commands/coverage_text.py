"""The ledger as text at 80 columns: a table for each code, what is missing, one section with its reason."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence

from regdb_compiler.ledger import MEANINGS, STATUSES, Account, CodeLedger, count, percent

WIDTH = 80
_NAME = 41
_HEADS = ("enc", "part", "not ADS", "inexpr", "open", "all")
_WIDTHS = tuple(max(len(head), 3) + 2 for head in _HEADS)


def table(found: Sequence[CodeLedger]) -> str:
    """Every code by chapter and article, and all of them together."""
    parts = ["\n".join(_code(code)) for code in found]
    every = tuple(item for code in found for item in code.accounts)
    if len(found) > 1:
        parts.append("\n".join((_line("all codes", every), _shares(every))))
    return "\n\n".join([*parts, _legend(every)])


def _code(code: CodeLedger) -> Iterator[str]:
    jurisdiction, outline = code.jurisdiction, code.outline
    listing = "no outline" if outline is None else f"list {outline.listing}"
    yield f"{jurisdiction.short}: {jurisdiction.name} ({listing})"
    yield f"{'':<{_NAME}}" + "".join(f"{head:>{width}}" for head, width in zip(_HEADS, _WIDTHS, strict=True))
    chapter = ""
    for (name, article), items in code.groups.items():
        if name != chapter and article:
            yield f"  {_short(name, WIDTH - 2)}"
        chapter = name
        yield _line(f"    {article}" if article else f"  {name}", items)
    yield _line("in all", code.accounts)
    yield _shares(code.accounts)


def _line(name: str, accounts: tuple[Account, ...]) -> str:
    by_status = count(accounts)
    numbers = [*(by_status[status] for status in STATUSES), len(accounts)]
    cells = "".join(f"{number or '-':>{width}}" for number, width in zip(numbers, _WIDTHS, strict=True))
    return f"{_short(name, _NAME):<{_NAME}}{cells}"


def _shares(accounts: tuple[Account, ...]) -> str:
    by_status = count(accounts)
    shares = [f"{percent(by_status[status], len(accounts))}%" for status in STATUSES]
    accounted = percent(len(accounts) - by_status["unaccounted"], len(accounts))
    cells = "".join(f"{share:>{width}}" for share, width in zip([*shares, ""], _WIDTHS, strict=True))
    return f"{f'{accounted}% accounted for':<{_NAME}}{cells}".rstrip()


def _legend(accounts: tuple[Account, ...]) -> str:
    told = ", ".join(f"{head}: {MEANINGS[status]}" for head, status in zip(_HEADS, STATUSES, strict=False))
    ranges = sum(item.is_range for item in accounts)
    unlisted = sum(not item.listed for item in accounts)
    told += f". {ranges} entries stand for sections that are not listed one by one and count as one each." if ranges else "."
    told += f" {unlisted} files are listed in no outline; see --missing." if unlisted else ""
    return textwrap.fill(told, WIDTH)


def missing(items: Sequence[Account]) -> str:
    """What is not accounted for, and what is listed nowhere."""
    if not items:
        return "every section is accounted for"
    lines = []
    for item in items:
        told = "has a file, but no outline lists it" if not item.listed else "neither a file nor a reason" if item.entry is None else (
            "its file carries no rule and no reason")  # fmt: skip
        text = f"{item.place.path}:{item.place.line}: {item.jurisdiction.short} {item.section} ({item.heading}): {told}"
        lines.append(textwrap.fill(text, WIDTH, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False))
    return "\n".join([*lines, f"{len(items)} missing"])


def one(item: Account) -> str:
    """One section: heading, status, reason, and where both stand."""
    rows = [("status", MEANINGS[item.status]), ("why", item.why), ("stands in", ", ".join(part for part in item.group if part))]
    rows.append(("listed at" if item.listed else "listed", f"{item.place.path}:{item.place.line}" if item.listed else "nowhere"))
    rows.append(("file", "" if item.entry is None else item.entry.file.path))
    lines = [f"{item.jurisdiction.short} {item.section}: {item.heading}"]
    for name, text in rows:
        if text:
            lines.append(textwrap.fill(text, WIDTH, initial_indent=f"  {name:<10} ", subsequent_indent=" " * 13, break_on_hyphens=False))
    return "\n".join(lines)


def _short(text: str, width: int) -> str:
    """The name at a width; the kinds of parts are abbreviated before anything is cut."""
    for word, abbreviation in (("Division ", "Div. "), ("Chapter ", "Ch. "), ("Article ", "Art. ")) if len(text) > width else ():
        text = text.replace(word, abbreviation)
    return text if len(text) <= width else f"{text[: width - 3].rstrip()}..."
