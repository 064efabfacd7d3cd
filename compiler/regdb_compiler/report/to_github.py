"""Findings as GitHub workflow commands, which show up beside the changed lines."""

from collections.abc import Mapping, Sequence

from regdb_compiler.diagnostics import Diagnostic, Level, in_order

COMMANDS: dict[Level, str] = {"error": "error", "warning": "warning", "info": "notice"}


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, str]) -> str:
    """One workflow command for each finding; nothing if there are none."""
    del sources
    return "".join(_command(d) + "\n" for d in in_order(diagnostics))


def _command(d: Diagnostic) -> str:
    properties = {
        "file": d.place.path,
        "line": str(d.place.line),
        "col": str(d.place.column),
        "endLine": str(d.place.end_line),
        "endColumn": str(d.place.end_column),
        "title": f"{d.code} {d.name}",
    }
    told = ",".join(f"{key}={_escape_property(value)}" for key, value in properties.items())
    words = "\n".join(part for part in (d.message, d.note, d.help, d.law) if part)
    return f"::{COMMANDS[d.level]} {told}::{_escape(words)}"


def _escape(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _escape_property(text: str) -> str:
    return _escape(text).replace(":", "%3A").replace(",", "%2C")
