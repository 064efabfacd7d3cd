"""How often each rule found something, most frequent first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.report.summary import summarize


def statistics(findings: Iterable[Diagnostic]) -> str:
    """A table of count, code, name and level, with fixable ones marked, and the sum."""
    found = tuple(findings)
    counts = Counter((item.code, item.name, item.level) for item in found)
    fixable = {item.code for item in found if item.fix is not None and item.fix.kind == "safe"}
    rows = [
        f"{count:>6}  {code:<6}{name:<31}{level:<9}{'[*]' if code in fixable else ''}".rstrip()
        for (code, name, level), count in sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    ]
    return "\n".join([*rows, str(summarize(found))]) + "\n"
