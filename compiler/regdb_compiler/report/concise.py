"""One line for each finding: `path:line:column: error[R204] quote-not-in-text: message`."""

from collections.abc import Mapping, Sequence

from regdb_compiler.diagnostics import Diagnostic, in_order
from regdb_compiler.report.columns import visible


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, str]) -> str:
    """The findings, one to a line, as editors and `grep` like them; nothing if there are none."""
    del sources
    return "".join(visible(f"{d.place}: {d.level}[{d.code}] {d.name}: {' '.join(d.message.split())}") + "\n" for d in in_order(diagnostics))
