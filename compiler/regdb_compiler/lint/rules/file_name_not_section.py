"""The file's name is not the number of the section in it.

Why:
    People and links look a section up by its file: `codes/cvc/21453.yaml`. A file that holds another section hides it.

Fails:
    section: "101"
    path: st/100.yaml

Passes:
    section: "101"
    path: st/101.yaml
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R111", "file-name-not-section"
LEVEL: Level = "error"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each file that is not called after its section."""
    for section in build.corpus.sections:
        name = PurePosixPath(section.file.path).name.removesuffix(".yaml")
        if name != section.doc.section:
            message = f"section {section.doc.section} stands in a file called {name}.yaml"
            help_ = f"rename the file to {section.doc.section}.yaml, or correct the number"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("section"), help=help_, law=str(section.citation))
