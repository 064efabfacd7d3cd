"""A boolean fact is compared with true or false.

Why:
    `sign.stop` and `not sign.stop` say the same, read aloud like the law, and are what the rest of the codes use.

Fails:
    condition: {when: children.present == true and signal.flashing == false}

Passes:
    condition: {when: children.present and not signal.flashing}

Fix (safe):
    Writes the fact alone, or `not` before it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Fix, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.edits import replace_words

CODE, NAME = "R442", "boolean-compared"
LEVEL: Level = "info"
_COMPARED = re.compile(r"(?<![\w.])(?P<fact>[a-z_]\w*(?:\.\w+)*)\s*(?P<op>==|!=)\s*(?P<value>true|false)\b")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each such comparison."""
    for entry in build.corpus.regulations:
        for key, text in (("when", entry.doc.condition.when), ("unless", entry.doc.condition.unless)):
            if "true" not in text and "false" not in text:
                continue
            for match in _COMPARED.finditer(text):
                wanted = (match["value"] == "true") == (match["op"] == "==")
                short = match["fact"] if wanted else f"not {match['fact']}"
                edit = replace_words(entry.field("condition", key), match.start(), match.end(), short)
                fix = Fix("safe", f"write `{short}`", (edit,)) if edit else None
                place = entry.text_place(match.start(), match.end(), "condition", key)
                yield Diagnostic(CODE, NAME, LEVEL, f"`{match[0]}` is `{short}`", place, law=str(entry.citation), fix=fix)
