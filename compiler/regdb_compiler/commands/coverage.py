"""`regdb coverage`: how every section of the codes' outlines stands: encoded, partly, not for a driving ADS, not expressible."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from regdb.front import FrontError, codes_folder
from regdb.jurisdiction import JurisdictionError, JurisdictionTree
from regdb_compiler.commands import coverage_text
from regdb_compiler.commands.options import Codes, Format, In, Output
from regdb_compiler.corpus import Corpus
from regdb_compiler.ledger import STATUSES, Account, CodeLedger, count, ledgers, percent
from regdb_compiler.read_corpus import read_corpus

FORM = "urn:regdb:coverage:1.0"


def command(
    codes: Codes = None,
    in_: In = "",
    missing: Annotated[bool, typer.Option("--missing", help="List what is not accounted for, or is listed nowhere.")] = False,
    section: Annotated[str, typer.Option("--section", metavar="NUMBER", help="How one section stands, and why: 21804, CVC 21804.")] = "",
    format_: Output = Format.text,
) -> None:
    folder = codes_folder(codes)
    corpus = read_corpus(folder)
    found = _wanted(ledgers(corpus), corpus.tree, in_)
    _check(corpus, found, folder)
    open_ = [item for code in found for item in code.accounts if item.status == "unaccounted" or not item.listed]
    if section:
        _show_section([item for code in found for item in code.accounts if section in _names(item)], section, format_)
        return
    if format_ is Format.json:
        typer.echo(json.dumps(_document(found), indent=1, ensure_ascii=False))
    else:
        typer.echo(coverage_text.missing(open_) if missing else coverage_text.table(found))
    raise typer.Exit(1 if open_ else 0)


def _wanted(found: Sequence[CodeLedger], tree: JurisdictionTree, place: str) -> tuple[CodeLedger, ...]:
    """The codes that govern a place; all of them where none is named. Raises FrontError."""
    if not place:
        return tuple(found)
    try:
        path = tree.path(place)
    except JurisdictionError as error:
        raise FrontError(str(error)) from error
    return tuple(item for item in found if item.jurisdiction in path)


def _check(corpus: Corpus, found: Sequence[CodeLedger], folder: Path) -> None:
    """An outline that cannot be read, or none at all, is no ledger. Raises FrontError."""
    for item in corpus.diagnostics:
        if item.level == "error" and item.place.path.endswith("/outline.yaml"):
            raise FrontError(f"{item.place}: {item.message}; see `regdb lint`")
    if not any(item.outline for item in found):
        raise FrontError(f"no code in {folder} has an outline.yaml")


def _names(item: Account) -> tuple[str, ...]:
    return item.section, f"{item.jurisdiction.short} {item.section}"


def _show_section(items: Sequence[Account], name: str, format_: Format) -> None:
    """One section in each code that has the number. Raises FrontError."""
    if not items:
        raise FrontError(f"no outline lists {name!r}, and it has no file; see `regdb coverage --missing`")
    if format_ is Format.json:
        typer.echo(json.dumps({"schema": FORM, "sections": [_account(item) for item in items]}, indent=1, ensure_ascii=False))
    else:
        typer.echo("\n\n".join(coverage_text.one(item) for item in items))


def _document(found: Sequence[CodeLedger]) -> dict[str, Any]:
    every = tuple(item for code in found for item in code.accounts)
    return {"schema": FORM, "total": _counts(every), "codes": [_code(item) for item in found]}


def _code(code: CodeLedger) -> dict[str, Any]:
    groups = [
        {"chapter": chapter, "article": article, "counts": _counts(items), "sections": [_account(item) for item in items]}
        for (chapter, article), items in code.groups.items()
    ]
    outline = code.outline
    return {
        "jurisdiction": code.jurisdiction.id,
        "code": code.jurisdiction.code,
        "cited": code.jurisdiction.short,
        "listing": None if outline is None else {"confidence": outline.listing, "source": outline.source, "note": outline.note},
        "counts": _counts(code.accounts),
        "groups": groups,
    }


def _counts(accounts: tuple[Account, ...]) -> dict[str, int]:
    by_status = count(accounts)
    told: dict[str, int] = {status: by_status[status] for status in STATUSES}
    return {
        **told,
        "unlisted": sum(not item.listed for item in accounts),
        "ranges": sum(item.is_range for item in accounts),
        "all": len(accounts),
        "percent_accounted": percent(len(accounts) - by_status["unaccounted"], len(accounts)),
    }


def _account(item: Account) -> dict[str, Any]:
    return {
        "section": item.section,
        "citation": f"{item.jurisdiction.short} {item.section}",
        "heading": item.heading,
        "status": item.status,
        "why": item.why,
        "listed": item.listed,
        "file": None if item.entry is None else item.entry.file.path,
    }
