"""`regdb text`: keep a copy of the official text beside the codes, and hold the annotation against it."""

import datetime
import json
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from regdb.front import FrontError, codes_folder
from regdb_compiler.commands.options import Codes, Format, Output, asked_day, has_color
from regdb_compiler.commands.progress import working
from regdb_compiler.commands.sheet import Sheet

RULES = ("R204", "R210", "R211")
"""Rules that look at attached texts."""

MANY = 20
"""Texts listed before `and ... more`."""


class Verb(StrEnum):
    """What to do."""

    attach = "attach"
    list = "list"
    show = "show"
    check = "check"
    accept = "accept"
    forget = "forget"


def command(
    verb: Annotated[Verb, typer.Argument(help="attach a copy; list, show, check what is attached; accept, forget sections.")],
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[SOURCE|SECTION]...", help="attach: files, folders, http addresses; else: sections.")
    ] = None,
    code: Annotated[str, typer.Option(help="The code that the sources are of, such as cvc; default: the one with their sections.")] = "",
    codes: Codes = None,
    texts: Annotated[
        Path | None, typer.Option("--texts", metavar="DIR", help="Where texts are kept; default: texts/ beside the codes, or $REGDB_TEXTS.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="With accept and forget: every attached section; with list: all lines.")] = False,
    on: Annotated[str, typer.Option("--on", metavar="DATE", help="The day on which the copy was made, 2026-03-02; default: today.")] = "",
    format_: Output = Format.text,
) -> None:
    # Loaded here so that the shell's completion, which loads this module, need not wait for them.
    from regdb_compiler.official.shelf import read_shelf, texts_folder
    from regdb_compiler.read_corpus import read_corpus

    root = codes_folder(codes)
    folder = texts_folder(root, texts)
    if verb is Verb.check:
        raise typer.Exit(_check(root, folder, names or (), format_))
    with working("reading the codes"):
        corpus = read_corpus(root)
    job = _Job(corpus, read_shelf(folder), asked_day(on), format_)
    if verb is Verb.attach:
        job.attach(names or (), code)
    else:
        job.look(verb, names or (), every=every)


class _Job:
    """One call: the codes, what is attached, the day, the form of the answer."""

    def __init__(self, corpus: Any, shelf: Any, day: Any, format_: Format) -> None:
        self.corpus, self.shelf, self.day, self.format = corpus, shelf, day, format_
        self.date = datetime.date.fromisoformat(day.iso)

    def attach(self, sources: Sequence[str], code: str) -> None:
        """Attach every source that can be read; those that cannot are told on stderr, and are an error in the end."""
        from regdb_compiler.official.naming import code_named, code_of
        from regdb_compiler.official.passage import UnreadableTextError
        from regdb_compiler.official.reading import read_source_text, sources_in
        from regdb_compiler.official.shelf import attach, write_shelf

        if not sources:
            raise FrontError("name what to attach: `regdb text attach FILE`, a folder, or an http address")
        named = code_named(self.corpus, code) if code else ""
        told: list[dict[str, Any]] = []
        problems: list[str] = []
        for source in sources:
            try:
                for one in sources_in(source):
                    with working(f"reading {one}"):
                        read = read_source_text(one)
                    owner = named or code_of(self.corpus, read.passages)
                    before = self.shelf
                    self.shelf = attach(self.shelf, owner, read, self.date)
                    told += _news(before, self.shelf, owner, read)
            except UnreadableTextError as error:
                problems.append(str(error))
        if told:
            write_shelf(self.shelf)
            self._tell_attached(told)
        if problems:
            raise FrontError("; ".join(problems))

    def _tell_attached(self, told: list[dict[str, Any]]) -> None:
        if self.format is Format.json:
            _json({"folder": str(self.shelf.folder), "on": self.day.iso, "attached": told})
            return
        for item in told[:MANY]:
            dated = f"of {item['version']}" if item["version"] else "undated"
            typer.echo(f"{item['id']:<20} {dated:<14} {item['format']:<9} {item['news']}")
        if len(told) > MANY:
            typer.echo(f"and {len(told) - MANY} more")
        counts = {news: sum(1 for item in told if item["news"] == news) for news in ("new", "same", "changed")}
        words = ", ".join(f"{count} {news}" for news, count in counts.items() if count)
        typer.echo(f"{len(told)} {'text' if len(told) == 1 else 'texts'} in {self.shelf.folder}: {words}; as of {self.day}")

    def look(self, verb: Verb, words: Sequence[str], *, every: bool) -> None:
        """list, show, accept or forget."""
        from regdb_compiler.official.naming import sections_named
        from regdb_compiler.official.report import listed

        if not words and not every and verb is not Verb.list:
            raise FrontError(f"name the sections: `regdb text {verb.value} CVC 21453`" + ("" if verb is Verb.show else ", or --all"))
        names = sections_named(self.corpus, self.shelf, words) if words else None
        items = listed(self.shelf, names, self.corpus)
        if verb is Verb.list:
            self._list(items, every=every)
        elif verb is Verb.show:
            self._show(items)
        else:
            self._change(verb, items)

    def _list(self, items: list[dict[str, Any]], *, every: bool) -> None:
        if self.format is Format.json:
            _json({"folder": str(self.shelf.folder), "texts": items})
            return
        for item in items if every else items[:MANY]:
            typer.echo(f"{item['code'] + '-' + item['section']:<20} {item['version'] or 'undated':<11} {item['state']:<9} {item['source']}")
        if len(items) > MANY and not every:
            typer.echo(f"and {len(items) - MANY} more; --all lists them")
        typer.echo(f"{len(items)} {'text' if len(items) == 1 else 'texts'} in {self.shelf.folder}")

    def _show(self, items: list[dict[str, Any]]) -> None:
        shown = [{**item, "text": (self.shelf.folder / item["file"]).read_text("utf-8")} for item in items]
        if self.format is Format.json:
            _json({"folder": str(self.shelf.folder), "texts": shown})
            return
        sheet = Sheet(color=has_color())
        for item in shown:
            sheet.heading(f"{item['code']} {item['section']}  {item['heading']}".rstrip())
            sheet.field("Version", item["version"] or "the source gives no date")
            sheet.field("Source", item["source"])
            sheet.field("Attached", f"{item['attached']} as {item['format']}, {item['state']}")
            sheet.field("SHA-256", item["sha256"])
            sheet.field("History", item["note"])
            sheet.gap()
            sheet.passage(item["text"])
        typer.echo(sheet.render(), nl=False)

    def _change(self, verb: Verb, items: list[dict[str, Any]]) -> None:
        from regdb_compiler.official.shelf import accept, forget, write_shelf

        names = list(dict.fromkeys((item["code"], item["section"]) for item in items))
        for code, section in names:
            self.shelf = accept(self.shelf, code, section, self.date) if verb is Verb.accept else forget(self.shelf, code, section)
        write_shelf(self.shelf)
        done = "accepted" if verb is Verb.accept else "forgotten"
        if self.format is Format.json:
            _json({"folder": str(self.shelf.folder), done: [f"{code}-{section}" for code, section in names]})
        else:
            on = f" on {self.day}" if verb is Verb.accept else ""
            typer.echo(f"{done}{on}: {', '.join(f'{code}-{section}' for code, section in names) or 'nothing is attached'}")


def _check(root: Path, folder: Path, names: Sequence[str], format_: Format) -> int:
    """Hold the annotation against what is attached; 1 where something is found."""
    from regdb_compiler.driver import build
    from regdb_compiler.lint.run import lint
    from regdb_compiler.official.annotated import texts_of
    from regdb_compiler.official.naming import sections_named
    from regdb_compiler.official.report import altered, listed
    from regdb_compiler.report import FORMATS

    with working("reading the codes"):
        found = build(root)
        texts = texts_of(found, folder)
    wanted = sections_named(found.corpus, texts.shelf, names) if names else None
    paths = None if wanted is None else {s.file.path for s in found.corpus.sections if (s.jurisdiction.code, s.doc.section) in wanted}
    findings = [item for item in lint(found, RULES) if item.code in RULES and (paths is None or item.place.path in paths)]
    damage = list(altered(texts.shelf))
    if format_ is Format.json:
        report = json.loads(FORMATS["json"](findings, found.corpus.texts))
        _json({"folder": str(folder), "texts": listed(texts.shelf, wanted, found.corpus), "altered": damage, "lint": report})
    else:
        typer.echo(FORMATS["text"](findings, found.corpus.texts), nl=False)
        for line in damage:
            typer.echo(f"error: {line}")
        typer.echo(f"{len(listed(texts.shelf, wanted, found.corpus))} attached texts in {folder} looked at")
    return 1 if findings or damage else 0


def _news(before: Any, after: Any, code: str, read: Any) -> list[dict[str, Any]]:
    """What each section of a source is beside what was attached before."""
    old = {(item.section, item.version): item.sha256 for item in before.texts if item.code == code}
    new = {(item.section, item.version): item for item in after.texts if item.code == code}
    told = []
    for passage in read.passages:
        item = new[(passage.section, passage.version)]
        held = old.get((passage.section, passage.version))
        news = "new" if held is None else "same" if held == item.sha256 else "changed"
        told.append({"id": item.id, "version": item.version, "format": item.format, "source": item.source, "news": news})
    return told


def _json(data: dict[str, Any]) -> None:
    typer.echo(json.dumps(data, indent=1, ensure_ascii=False))
