"""Coverage as text for people: a table for each code, then everything that no test has shown, with its place."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

from regdb_compiler.diagnostics import Place
from regdb_compiler.law_tests.coverage import KINDS, Coverage

_HEADS = ("rules", "branches", "states", "total")
_WIDTH = 80


def coverage_text(found: Coverage) -> str:
    """The table and the list of what is not covered; lines are 80 columns wide where words allow it."""
    width = max((len(code) for code in found.codes), default=0)
    width = max(width, len("total"))
    lines = [f"{'code':<{width}}  regulations  " + "  ".join(f"{head:>13}" for head in _HEADS)]
    lines += [_line(found, code, code, width) for code in found.codes]
    if len(found.codes) > 1:
        lines.append(_line(found, None, "total", width))
    listed = list(_uncovered(found))
    if listed:
        lines += ["", "not covered:", *listed]
    return "\n".join(lines) + "\n"


def _line(found: Coverage, code: str | None, name: str, width: int) -> str:
    rows = sum(1 for row in found.rows if code in (None, row.code))
    cells = [_cell(*found.count(code, kind)) for kind in (*KINDS, None)]
    return f"{name:<{width}}  {rows:>11}  " + "  ".join(f"{cell:>13}" for cell in cells)


def _cell(covered: int, total: int) -> str:
    """`97% 230/236`; rounded down, so that 100% means all."""
    return f"{100 * covered // total}% {covered}/{total}" if total else "-"


def _uncovered(found: Coverage) -> Iterator[str]:
    for row in found.rows:
        missing: dict[tuple[Place, str], list[str]] = {}
        for item in row.items:
            if not item.covered:
                head, _, tail = item.what.partition(": ")
                missing.setdefault((item.place, head), []).append(tail)
        for (place, head), tails in missing.items():
            listed = ", ".join(tail for tail in tails if tail)
            text = f"{place.path}:{place.line}: {row.regulation.id}: {head}" + (f": {listed}" if listed else "")
            yield from textwrap.wrap(text, _WIDTH, initial_indent="  ", subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
