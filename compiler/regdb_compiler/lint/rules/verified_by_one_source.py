"""A text is called verified, but only one place is named.

Why:
    Verified means that two places were compared: public mirrors print texts that are not yet, or no longer, in force.

Fails:
    source: {url: "https://example.org/100", also: null, confidence: verified}

Passes:
    source: {url: "https://example.org/100", also: ["https://example.com/100"], confidence: verified}
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build

CODE, NAME = "R117", "verified-by-one-source"
LEVEL: Level = "warning"


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each section that names fewer than two different places."""
    for section in build.corpus.sections:
        source = section.doc.source
        places = {url for url in (source.url, *source.also) if url.strip()}
        if source.confidence == "verified" and len(places) < 2:
            message = f"verified takes two places, and {len(places)} is named"
            help_ = "name the second place under `also`, or call it seen"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("source", "confidence"), help=help_, law=str(section.citation))
