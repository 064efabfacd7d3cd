"""`regdb lint`: check the codes, mend what can be mended, and report the rest."""

import datetime
import gc
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from regdb.front import FrontError, codes_folder
from regdb_compiler import baseline as known_findings
from regdb_compiler.baseline import Baseline
from regdb_compiler.diagnostics import Diagnostic, FixKind, RegdbInputError
from regdb_compiler.driver import Build, build
from regdb_compiler.fixes import SAFE, write_beside
from regdb_compiler.lint.mend import Mended, mend, unified_diff
from regdb_compiler.lint.registry import all_rules
from regdb_compiler.lint.rule import Rule, RuleError
from regdb_compiler.lint.run import lint
from regdb_compiler.lint.selection import Selection, UnknownRuleError
from regdb_compiler.lint.statistics import statistics
from regdb_compiler.report import FORMATS
from regdb_compiler.report import text as text_report
from regdb_compiler.source import collector_paused


@contextmanager
def _until_the_process_ends() -> Iterator[None]:
    """All that is read lives until the command ends, so looking for garbage in it, also while Python shuts down, is time lost."""
    with collector_paused():
        try:
            yield
        finally:
            gc.freeze()


@_until_the_process_ends()
def command(
    paths: Annotated[list[Path] | None, typer.Argument(help="Files or folders to report on; default: all.")] = None,
    codes: Annotated[Path | None, typer.Option(help="Folder of codes.")] = None,
    format_: Annotated[str, typer.Option("--format", help="text, concise, json, sarif, junit or github.")] = "text",
    select: Annotated[list[str] | None, typer.Option(help="Only these rules: codes, names, families (R6); commas or repeated.")] = None,
    ignore: Annotated[list[str] | None, typer.Option(help="Not these rules.")] = None,
    fix: Annotated[bool, typer.Option("--fix", help="Make the safe fixes.")] = False,
    unsafe_fixes: Annotated[bool, typer.Option("--unsafe-fixes", help="With --fix or --diff: the unsafe ones too.")] = False,
    diff: Annotated[bool, typer.Option("--diff", help="Show what --fix would change, and change nothing.")] = False,
    baseline: Annotated[Path | None, typer.Option(help="Let the findings of this file be.")] = None,
    write_baseline: Annotated[Path | None, typer.Option(help="Write the findings down as known.")] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Warnings count as findings for the exit code.")] = False,
    statistics_: Annotated[bool, typer.Option("--statistics", help="Only count the findings of each rule.")] = False,
    on: Annotated[datetime.datetime | None, typer.Option(formats=["%Y-%m-%d"], help="The day that rules about time judge by.")] = None,
) -> None:
    if format_ not in FORMATS:
        raise typer.BadParameter(f"{format_!r} is none of: {', '.join(FORMATS)}", param_hint="--format")
    folder = codes_folder(codes)
    job = _Job(folder, _wanted(folder, paths or ()), _selection(select, ignore), _rules(), _known(baseline), _day(on))
    if fix or unsafe_fixes or diff:
        kinds: tuple[FixKind, ...] = ("safe", "unsafe") if unsafe_fixes else SAFE
        mended = job.mend(kinds, write=not diff)
        if diff:
            typer.echo(unified_diff(mended), nl=False)
            raise typer.Exit(1 if mended.texts else 0)
    found = build(folder)
    findings = job.findings(found)
    if write_baseline is not None:
        count = known_findings.write(write_baseline, findings, found.corpus.texts)
        typer.echo(f"{count} findings written to {write_baseline}", err=True)
        raise typer.Exit(0)
    typer.echo(statistics(findings) if statistics_ else _rendered(format_, findings, found), nl=False)
    counted = {"error", "warning"} if strict else {"error"}
    raise typer.Exit(2 if job.is_unreadable(found) else 1 if any(item.level in counted for item in findings) else 0)


@dataclass(frozen=True)
class _Job:
    """What to lint, by which rules, on which day, and what to let be."""

    folder: Path
    wanted: tuple[str, ...]
    selection: Selection
    rules: tuple[Rule, ...]
    known: Baseline | None
    today: datetime.date

    def findings(self, found: Build) -> tuple[Diagnostic, ...]:
        """The findings on the files asked for."""
        every = lint(found, self.selection.select, self.selection.ignore, baseline=self.known, today=self.today, rules=self.rules)
        return tuple(item for item in every if self._concerns(item.place.path))

    def mend(self, kinds: tuple[FixKind, ...], *, write: bool) -> Mended:
        """Make the fixes, again and again while one uncovers the next; writes the files unless told not to."""
        mended = mend(self.folder, self.findings, kinds)
        base = self.folder.resolve().parent
        for path, text in mended.texts.items() if write else ():
            write_beside(base / path, text)
        if write or mended.skipped:
            files = len(mended.texts)
            typer.echo(f"{mended.applied} fixed in {files} {'file' if files == 1 else 'files'}", err=True)
        return mended

    def is_unreadable(self, found: Build) -> bool:
        """Whether there was nothing to lint: no jurisdictions, so no law."""
        return not found.corpus.sections and not tuple(found.corpus.tree)

    def _concerns(self, path: str) -> bool:
        return not self.wanted or any(path == name or path.startswith(f"{name}/") for name in self.wanted)


def _wanted(folder: Path, paths: Sequence[Path]) -> tuple[str, ...]:
    """The paths as findings name them. Raises FrontError for one that is not there, or not in the codes."""
    base, wanted = folder.resolve().parent, []
    for path in paths:
        full = path.resolve()
        if not full.exists():
            raise FrontError(f"{path} is not there")
        if not full.is_relative_to(folder.resolve()):
            raise FrontError(f"{path} is not in {folder}; name its codes with `--codes DIR`")
        wanted.append(full.relative_to(base).as_posix())
    return tuple(wanted)


def _rules() -> tuple[Rule, ...]:
    try:
        return all_rules()
    except RuleError as error:
        raise FrontError(str(error)) from error


def _selection(select: Sequence[str] | None, ignore: Sequence[str] | None) -> Selection:
    """The rules named, all of which there must be."""
    selection = Selection(_words(select), _words(ignore))
    if not selection.is_everything:
        from regdb_compiler.lint.catalogue import catalogue

        try:
            selection.check((item.code, item.name) for item in catalogue())
        except UnknownRuleError as error:
            raise FrontError(str(error)) from error
    return selection


def _words(items: Sequence[str] | None) -> tuple[str, ...]:
    return tuple(word for item in items or () for word in item.replace(",", " ").split())


def _known(path: Path | None) -> Baseline | None:
    try:
        return None if path is None else known_findings.read(path)
    except RegdbInputError as error:
        raise FrontError("; ".join(f"{path}: {item.message}" for item in error.diagnostics)) from error


def _day(on: datetime.datetime | None) -> datetime.date:
    """The day asked for; today, said so, when none is."""
    if on is not None:
        return on.date()
    today = datetime.date.today()
    typer.echo(f"as of {today.isoformat()} (today)", err=True)
    return today


def _rendered(format_: str, findings: Sequence[Diagnostic], found: Build) -> str:
    """The findings in a format; in colour on a terminal that wants it."""
    if format_ == "text":
        color = sys.stdout.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
        return text_report.render(findings, found.corpus.texts, color=color)
    return FORMATS[format_](findings, found.corpus.texts)
