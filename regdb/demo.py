"""`regdb demo`: lint, test and compile the codes, then decide the paper's situations and drive its experiment by the database just written."""

from __future__ import annotations

import datetime
import json
import textwrap
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from regdb.explanation import show_bound
from regdb.front import FrontError, author_side, codes_folder, vehicle_side
from regdb.situation import read_plan, read_scene

SITUATIONS = "paper.yaml"
"""The file of cases that holds the paper's situations; every code may have one."""

PLACE = "los_angeles"
"""Where the paper's drive takes place."""


@dataclass(frozen=True)
class Situation:
    """One decided situation: what was asked, what the law said, and whether that is what its case expects."""

    group: str
    name: str
    place: str
    date: str
    verdict: Any
    as_expected: bool


def command(
    codes: Annotated[Path | None, typer.Option(help="Folder of codes.")] = None,
    out: Annotated[Path, typer.Option("-o", "--out", help="Where the database and tables go.")] = Path("out"),
    format_: Annotated[str, typer.Option("--format", help="text or json.")] = "text",
) -> None:
    if format_ not in {"text", "json"}:
        raise typer.BadParameter("--format is text or json")
    tell: Callable[[str], None] = typer.echo if format_ == "text" else _silent
    started = time.perf_counter()
    build = author_side("driver").build(codes_folder(codes))
    tell("1. Lint, test, compile\n")
    sound = _lint(build, tell)
    passed = _test(build, tell)
    if not sound:
        raise FrontError("the codes have errors, so nothing was compiled; `regdb lint` shows them")
    outputs = author_side("emit.outputs").write_outputs(build, out, None)
    tell(_wrapped(f"compile  {outputs.folder}: {', '.join(item.name for item in outputs.files)}", 3, 12))
    decided = list(_decide(build, outputs.folder / "regulations.sqlite"))
    wrong = [item for item in decided if not item.as_expected]
    if format_ == "text":
        _show(decided, tell)
    driven = _drive(outputs.folder, tell)
    if format_ == "json":
        typer.echo(json.dumps(_data(decided, outputs) | {"drive": driven}, indent=2, ensure_ascii=False))
    else:
        tell(f"\n{len(decided)} situations decided by law {outputs.database.content_hash[:12]}, {time.perf_counter() - started:.1f} s in all")
        tell(f"ask your own:  regdb check --db {outputs.folder / 'regulations.sqlite'} --help")
    arrived = driven is None or driven["as_expected"]
    raise typer.Exit(0 if passed and not wrong and arrived else 1)


def _silent(_: str) -> None:
    return


def _lint(build: Any, tell: Callable[[str], None]) -> bool:
    found = author_side("lint.run").lint(build)
    counts = {level: sum(1 for item in found if item.level == level) for level in ("error", "warning", "info")}
    told = ", ".join(f"{counts[level] or 'no'} {level}s" for level in ("error", "warning")) + f", {counts['info']} notes"
    rules = len(author_side("lint.registry").all_rules())
    tell(f"   lint     {told} ({len(build.corpus.files)} files, {rules} rules)")
    return not counts["error"]


def _test(build: Any, tell: Callable[[str], None]) -> bool:
    outcomes = tuple(author_side("law_tests.judge").judge_tests(build, build.law_tests))
    tally = author_side("law_tests.outcome").tally(outcomes)
    failed = tally.failed + tally.broken
    tell(f"   test     {tally.passed:,} law tests pass" + (f", {failed} do not" if failed else ""))
    return not failed


def _decide(build: Any, path: Path) -> Iterator[Situation]:
    """Every case of the paper's files, judged by the runtime on the database."""
    database = vehicle_side("database").RegulationDatabase.open(path)
    for entry in build.corpus.cases:
        if Path(entry.file.path).name != SITUATIONS:
            continue
        doc = entry.doc
        place = doc.in_ or entry.jurisdiction.id
        day = (doc.on or datetime.date.today()).isoformat()
        scene = read_scene(doc.scene, database.vocabulary)
        plan = read_plan(doc.plan, database.vocabulary, database.machine)
        verdict = database.at(place, day).judge(scene, plan)
        group, _, name = doc.name.partition(": ")
        yield Situation(group, name or group, place, day, verdict, doc.expect.verdict in {None, verdict.verdict})


def _show(decided: list[Situation], tell: Callable[[str], None]) -> None:
    tell("\n2. The paper's situations")
    group = ""
    for item in decided:
        if item.group != group:
            group = item.group
            tell(f"\n   {group}")
        tell(f"   {item.verdict.verdict.upper():<8} {item.name}" + ("" if item.as_expected else "   <- not what its case expects"))
        tell(_wrapped(_because(item.verdict), 12, 12))


def _drive(folder: Path, tell: Callable[[str], None]) -> dict[str, Any] | None:
    """The paper's drive by the database just written; None where its codes do not know the place."""
    database = vehicle_side("database").RegulationDatabase.open(folder / "regulations.sqlite")
    tell("\n3. The paper's drive\n")
    if PLACE not in {item.id for item in database.tree}:
        tell(f"   these codes know no {PLACE}, where it takes place")
        return None
    row, files = vehicle_side("drive.outputs").drive_variant("paper", database, folder / "drive" / "paper")
    summary = vehicle_side("drive.summary")
    tell(textwrap.indent(summary.block(row), "   "))
    tell(_wrapped(f"files    {folder / 'drive' / 'paper'}: {', '.join(file.name for file in files)}", 3, 12))
    tell("   variants: regdb drive list")
    return dict(summary.row_data(row))


def _wrapped(text: str, indent: int, hanging: int) -> str:
    return textwrap.fill(text, 80, initial_indent=" " * indent, subsequent_indent=" " * hanging)


def _because(verdict: Any) -> str:
    """One line of reasons: the citations that decided, the limit in force, or what to look for."""
    cited = ", ".join(dict.fromkeys(rule.citation for rule in verdict.deciding))
    if verdict.verdict == "unknown":
        return f"{cited} hangs on it; look for {', '.join(verdict.missing)}"
    limit = verdict.combined.get("max_speed")
    bound = f"limit {show_bound(limit.bound, limit.limit)} by {limit.regulation.citation}" if limit is not None else ""
    told = {"illegal": f"broken: {cited}", "legal": f"allowed by {cited}" if cited else "nothing forbids it"}[verdict.verdict]
    return f"{told}; {bound}" if bound else told


def _data(decided: list[Situation], outputs: Any) -> dict[str, Any]:
    return {
        "schema": "regdb-demo/1",
        "content_hash": outputs.database.content_hash,
        "folder": str(outputs.folder),
        "files": [item.name for item in outputs.files],
        "situations": [
            {"group": item.group, "name": item.name, "as_expected": item.as_expected, **item.verdict.to_dict()} for item in decided
        ],
    }
