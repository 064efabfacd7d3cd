"""The address of a source is not one that a browser opens.

Why:
    The pages link to the source. An address without `https://`, or with spaces in it, is a dead link.

Fails:
    source: {url: example.org/100}

Passes:
    source: {url: "https://example.org/100"}
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R123", "malformed-url"
LEVEL: Level = "warning"
_URL = re.compile(r"https?://[^\s/]+\.[^\s/]+(/\S*)?\Z")


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each address that is none."""
    for section in build.corpus.sections:
        source = section.doc.source
        places = [(source.url, ("source", "url")), *((url, ("source", "also", at)) for at, url in enumerate(source.also))]
        for url, path in places:
            if url and not _URL.match(url):
                message = f"{url!r} is no address"
                yield Diagnostic(CODE, NAME, LEVEL, message, section.place(*path), help="write it with https://", law=str(section.citation))
