"""What the scenes around the law's numbers showed, as text for people and as stable JSON."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable

from regdb_compiler.law_tests.boundaries import Boundaries, Boundary

FORMAT_VERSION = 1
WIDTH = 80


def boundaries_text(found: Boundaries) -> str:
    """What came out wrong, what could not be built, what no law test shows; counts stand last."""
    lines: list[str] = []
    one_sided = [item for item in found.numbers if item.missing]
    lines += _listed("answers otherwise than the number says:", ((item, "; ".join(item.wrong)) for item in found.wrong))
    lines += _listed("no scene in which the number decides:", ((item, "") for item in found.not_built))
    lines += _listed("sides no law test shows:", ((item, ", ".join(item.missing)) for item in one_sided))
    total, judged = len(found.numbers), sum(3 for item in found.numbers if item.built)
    lines.append(f"{total} numbers: {judged} scenes judged, {len(found.wrong)} numbers wrong, {len(found.not_built)} without a scene,")
    lines.append(f"{total - len(one_sided)} shown by law tests below, at and above")
    return "\n".join(lines) + "\n"


def _listed(head: str, items: Iterable[tuple[Boundary, str]]) -> list[str]:
    lines: list[str] = []
    for item, more in items:
        text = f"{item.place.path}:{item.place.line}: {item.regulation}: {item.what}" + (f": {more}" if more else "")
        lines += textwrap.wrap(text, WIDTH, initial_indent="  ", subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    return [head, *lines, ""] if lines else []


def boundaries_json(found: Boundaries) -> str:
    """Every number with what its scenes showed."""
    data = {
        "version": FORMAT_VERSION,
        "numbers": len(found.numbers),
        "wrong": len(found.wrong),
        "not_built": len(found.not_built),
        "each": [_number(item) for item in found.numbers],
    }
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def _number(item: Boundary) -> dict[str, object]:
    return {
        "regulation": item.regulation, "number": item.what, "path": item.place.path, "line": item.place.line, "built": item.built,
        "wrong": list(item.wrong), "not_shown": list(item.missing),
    }  # fmt: skip
