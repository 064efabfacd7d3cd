"""The attached text of a section is not the one that its annotation was checked against.

Why:
    Law is amended while its annotation stands still. `regdb text accept` notes which text an annotation was checked against; when a later
    copy differs, somebody has to read the section again.

Fails:
    texts: {"100": ["(a) A driver shall not change lanes.", "(a) A driver shall not change lanes or turn."]}

Passes:
    texts: {"100": ["(a) A driver shall not change lanes.", "(a)  A driver shall not change lanes."]}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.official.annotated import texts_of

CODE, NAME = "R210", "text-changed"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section with an accepted text and another one attached since."""
    texts = texts_of(build)
    for section in build.corpus.sections if texts else ():
        change = texts.change(section)
        if change is not None:
            law = str(section.citation)
            message = f"the text of {law} attached on {change.text.attached} is not the one accepted on {change.accepted}"
            note = f'"{change.before}" became "{change.after}"'
            help_ = f"read it (`regdb text show {law}`), annotate the change, then `regdb text accept {law}`"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("source", "checked"), note=note, help=help_, law=law)
