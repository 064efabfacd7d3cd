"""Findings as output: each format is a module with `render(diagnostics, sources)`, found here by its name."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.report import concise, text, to_github, to_json, to_junit, to_sarif


class Render(Protocol):
    """Findings, and the text of every file that was looked at by its path, to output that ends with a line feed."""

    def __call__(self, diagnostics: Sequence[Diagnostic], sources: Mapping[str, str], /) -> str: ...


FORMATS: Mapping[str, Render] = {
    "text": text.render,
    "concise": concise.render,
    "json": to_json.render,
    "sarif": to_sarif.render,
    "junit": to_junit.render,
    "github": to_github.render,
}

__all__ = ["FORMATS", "Render"]
