"""What a mutation run found, as text for people and as stable JSON."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable
from typing import Any

from regdb_compiler.mutation.run import Count, Mutation, Result

FORMAT_VERSION = 1
WIDTH = 80


def mutation_text(found: Mutation, seconds: float) -> str:
    """Scores by code and kind, survivors with their places, what nothing can notice; the score stands last."""
    heads = [*found.codes, "all"] if len(found.codes) > 1 else ["all"]
    lines = [f"{'mutants':<13}" + "".join(f"{head:>15}" for head in heads)]
    for kind in (*found.kinds, None):
        cells = [_cell(found.count(None if head == "all" else head, kind)) for head in heads]
        lines.append(f"{kind or 'all':<13}" + "".join(f"{cell:>15}" for cell in cells))
    if found.survivors:
        lines += ["", "no test notices:", *_listed((item.mutant.place.path, item.mutant.place.line, str(item.mutant)) for item in found.survivors)]
    equal = [item for item in found.results if item.equivalent]
    if equal:
        lines += ["", "not counted, because nothing can notice them:", *_listed(_equivalent(item) for item in equal)]
    count = found.count()
    drawn = f" ({len(found.results)} drawn of {found.generated})" if len(found.results) < found.generated else ""
    closing = f"mutation score {count.score:.1f} %: {count.killed} of {count.total} mutants noticed{drawn} in {seconds:.1f} s"
    return "\n".join([*lines, "", closing]) + "\n"


def _cell(count: Count) -> str:
    """`97% 230/236`; rounded down, so that 100% means all."""
    return f"{100 * count.killed // count.total}% {count.killed}/{count.total}" if count.total else "-"


def _equivalent(item: Result) -> tuple[str, int, str]:
    return item.mutant.place.path, item.mutant.place.line, f"{item.mutant} ({item.equivalent})"


def _listed(items: Iterable[tuple[str, int, str]]) -> list[str]:
    lines: list[str] = []
    for path, line, words in items:
        text = f"{path}:{line}: {words}"
        lines += textwrap.wrap(text, WIDTH, initial_indent="  ", subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    return lines


def mutation_json(found: Mutation) -> str:
    """The whole run as JSON: totals, by code, by kind, survivors and equivalent mutants."""
    return json.dumps(mutation_data(found), indent=2, ensure_ascii=False) + "\n"


def mutation_data(found: Mutation) -> dict[str, Any]:
    """The same as data. `killed_by` is left out: it is the first of many."""
    return {
        "version": FORMAT_VERSION,
        "generated": found.generated,
        "total": _count(found.count()),
        "codes": {code: _count(found.count(code)) for code in found.codes},
        "kinds": {kind: _count(found.count(kind=kind)) for kind in found.kinds},
        "survivors": [_mutant(item) for item in found.survivors],
        "equivalent": [{**_mutant(item), "because": item.equivalent} for item in found.results if item.equivalent],
    }


def _count(count: Count) -> dict[str, Any]:
    return {"score": round(count.score, 2), "killed": count.killed, "counted": count.total, "equivalent": count.equivalent}


def _mutant(item: Result) -> dict[str, Any]:
    mutant = item.mutant
    place = mutant.place
    return {
        "kind": mutant.kind, "code": mutant.code, "subject": mutant.subject, "what": mutant.what, "regulations": sorted(mutant.ids),
        "path": place.path, "line": place.line, "column": place.column,
    }  # fmt: skip
