"""No other section has this topic, and it is nearly one that others have.

Why:
    Topics align sections of different codes, so that two jurisdictions can be compared. A topic of one section is often a second spelling.

Fails:
    topic: spead

Passes:
    topic: speed
"""

from __future__ import annotations

import difflib
from collections import Counter
from collections.abc import Iterator

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.view import view_of

CODE, NAME = "R913", "lonely-topic"
LEVEL: Level = "info"
NEAR = 0.75
MOST_TOPICS = 500  # more are no vocabulary that people keep in mind, and comparing all of them takes long


def check(build: Build) -> Iterator[Diagnostic]:
    """One finding for each topic of one section only that is nearly a topic of several; none while a file could not be read."""
    if not view_of(build).whole:
        return
    counts = Counter(section.doc.topic for section in build.corpus.sections)
    common = sorted(topic for topic, count in counts.items() if count > 1)
    for section in build.corpus.sections if len(common) < MOST_TOPICS else ():
        topic = section.doc.topic
        near = difflib.get_close_matches(topic, common, 1, NEAR) if counts[topic] == 1 else []
        if near:
            message = f"no other section has the topic `{topic}`"
            yield Diagnostic(CODE, NAME, LEVEL, message, section.place("topic"), note=f"did you mean {near[0]}?", law=str(section.citation))
