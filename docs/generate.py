"""Writes the generated pages of docs/reference: command line, lint rules, vocabulary, states, database, codes.

    python docs/generate.py            write them
    python docs/generate.py --check    exit 1 if one of them is not as it would be written
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from regdb_compiler.driver import Build, build

from regdb import schema
from regdb.cli import COMMANDS
from regdb.vocabulary import Fact

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs" / "reference"
NOTE = "<!-- Written by docs/generate.py; do not edit. -->\n\n"


@cache
def law() -> Build:
    """The shipped codes."""
    return build(ROOT / "codes")


def cell(text: object) -> str:
    """Text inside a table."""
    return " ".join(str(text).replace("|", "\\|").split())


def table(head: tuple[str, ...], rows: Iterator[tuple[object, ...]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(map(cell, row)) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def command_line() -> str:
    """Every command's own help, as a terminal of 80 columns shows it."""
    environment = {**os.environ, "COLUMNS": "80", "TERMINAL_WIDTH": "80", "NO_COLOR": "1"}
    parts = ["# The command line\n"]
    for name in ("", *COMMANDS):
        arguments = [sys.executable, "-m", "regdb", *([name] if name else []), "--help"]
        text = subprocess.run(arguments, capture_output=True, text=True, check=True, env=environment).stdout
        parts.append(f"## regdb {name}".rstrip() + f"\n\n```\n{text.strip()}\n```\n")
    return "\n".join(parts)


def vocabulary() -> str:
    """Every fact and attribute, by the first part of its name."""
    facts = law().corpus.vocabulary
    parts = [f"# Vocabulary\n\n{len(facts)} facts, {len(facts.attributes)} attributes.\n"]
    for group in sorted({fact.name.partition(".")[0] for fact in facts}):
        own = [fact for fact in facts if fact.name.partition(".")[0] == group]
        parts.append(f"## {group}\n\n" + table(("fact", "type", "source", "unknown", "meaning"), map(_fact_row, own)))
    rows = ((f"`{a.name}`", a.kind, f"`{a.fact}`", a.direction, a.meaning) for a in facts.attributes.values())
    parts.append("## Attributes\n\n" + table(("attribute", "kind", "fact", "direction", "meaning"), rows))
    return "\n".join(parts)


def _fact_row(fact: Fact) -> tuple[object, ...]:
    kind = fact.kind + (f": {', '.join(fact.values)}" if fact.values else f" ({fact.unit})" if fact.unit else "")
    held = fact.assumption
    unknown = "strict"
    if held is not None:
        within = f" within {held.within}" if held.within else ""
        unknown = f"assume {fact.show(held.value)}{within}: {held.because}"
    return f"`{fact.name}`", kind, fact.source, unknown, fact.meaning


def states() -> str:
    """The state machine as a table, and as a picture."""
    machine = law().corpus.machine
    parts = ["# The state machine\n"]
    for item in machine.super_states.values():
        own = [state for state in machine.states.values() if state.super_state == item.name]
        parts.append(f"## {item.name}\n\n{item.meaning} Prompt: {item.prompt or '(none: it asks no model)'}\n")
        rows = ((f"`{s.name}`", s.meaning + (" (extension)" if s.extension else ""), ", ".join(f"`{n}`" for n in s.next)) for s in own)
        parts.append(table(("state", "meaning", "next"), rows))
    edges = "\n".join(f"    {a} --> {b}" for a, item in machine.super_states.items() for b in item.next)
    parts.append(f"```mermaid\nstateDiagram-v2\n    [*] --> {machine.initial}\n{edges}\n```\n")
    return "\n".join(parts)


def database() -> str:
    """Tables, indexes and views as they stand in the schema."""
    parts = [
        "# The database\n",
        f'One SQLite file. `application_id` is 0x{schema.APPLICATION_ID:08X} ("RGDB"), `user_version` {schema.USER_VERSION}',
        f"(schema {schema.MAJOR}.{schema.MINOR}).",
        "A reader refuses another major version. JSON stands in text columns, dates are ISO text, NULL where open.\n",
    ]
    for name, columns in schema.TABLES.items():
        lines = "\n".join(f"    {column}" for column in columns)
        parts.append(f"## {name}\n\n```\n{lines}\n```\n")
    parts.append("## Full-text search\n")
    parts.append(f"`{schema.SEARCH_TABLE}` (FTS5) over {', '.join(f'`{name}`' for name in schema.SEARCH_COLUMNS)}.\n")
    for name, text in schema.VIEWS.items():
        parts.append(f"## View {name}\n\n```sql\n{text.strip()}\n```\n")
    return "\n".join(parts)


def codes() -> str:
    """What is encoded, per code and section, and how sure we are of it."""
    corpus = law().corpus
    parts = ["# The codes as encoded\n"]
    for jurisdiction in corpus.tree:
        own = [section for section in corpus.sections if section.jurisdiction is jurisdiction]
        if not own:
            continue
        sure = Counter(section.doc.source.confidence for section in own)
        count = len({entry.id for entry in corpus.regulations if entry.jurisdiction is jurisdiction})
        told = ", ".join(f"{sure[level]} {level}" for level in ("verified", "seen", "recalled") if sure[level])
        parts.append(f"## {jurisdiction.name}\n\n{len(own)} sections ({told}), {count} regulations.\n")
        rows = (
            (str(s.citation), s.doc.title, len({r.doc.id for v in s.versions for r in v.regulations}), len(s.versions), s.doc.source.confidence)
            for s in sorted(own, key=lambda section: section.citation)
        )
        parts.append(table(("section", "title", "regulations", "versions", "confidence"), rows))
    return "\n".join(parts)


def lint_rules() -> str:
    """Every rule with its page."""
    from regdb_compiler.lint.catalogue import CATALOGUE

    parts = ["# Lint rules\n"]
    rows = ((f"[{page.code}](#{page.code.lower()}-{page.name})", page.name, page.level, page.summary) for page in CATALOGUE)
    parts.append(table(("code", "name", "level", "what it finds"), rows))
    parts += [f"## {page.code} {page.name}\n\n{page.text.strip()}\n" for page in CATALOGUE]
    return "\n".join(parts)


GENERATED: dict[str, Callable[[], str]] = {
    "command-line.md": command_line,
    "lint-rules.md": lint_rules,
    "vocabulary.md": vocabulary,
    "states.md": states,
    "database.md": database,
    "codes.md": codes,
}


def main() -> int:
    check = "--check" in sys.argv
    stale = []
    for name, make in GENERATED.items():
        text, path = NOTE + make().rstrip() + "\n", PAGES / name
        if not path.exists() or path.read_text("utf-8") != text:
            stale.append(name)
            if not check:
                path.write_text(text, "utf-8")
    if stale:
        sys.stdout.write(("stale: " if check else "written: ") + ", ".join(stale) + "\n")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
