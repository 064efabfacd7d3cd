"""Writes the generated pages of docs/reference: command line, lint rules, vocabulary, states, database, codes.

    python docs/generate.py            write them
    python docs/generate.py --check    exit 1 if one of them is not as it would be written
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path

from regdb_compiler.driver import Build, build
from regdb_compiler.entries import SectionEntry
from regdb_compiler.ledger import MEANINGS, STATUSES, Account, count, ledgers

from regdb import schema
from regdb.cli import COMMANDS
from regdb.fusion_policy import Reach
from regdb.state_diagram import to_mermaid
from regdb.vocabulary import Fact

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs" / "reference"
NOTE = "<!-- Written by docs/generate.py; do not edit. -->\n\n"


@cache
def law() -> Build:
    """The shipped codes."""
    return build(ROOT / "codes", added=())


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


def fusion() -> str:
    """How statements on every fact are believed and forgotten, by class."""
    facts = law().corpus.vocabulary
    fused = [fact for fact in facts if fact.fusion is not None]
    parts = ["# Fusion\n", _ABOUT_FUSION.format(count=len(fused))]
    head = (
        "fact", "what permits", "restriction holds", "permission counts", "confirmed by", "corroborated by", "ends", "matters with",
        "refused beyond",
    )  # fmt: skip
    for name in sorted({fact.fusion.ages for fact in fused if fact.fusion is not None}):
        own = [fact for fact in fused if fact.fusion is not None and fact.fusion.ages == name]
        parts.append(f"## {name}\n\n" + table(head, map(_fusion_row, own)))
    return "\n".join(parts)


_ABOUT_FUSION = """{count} facts can be told by several sources or at several times. [How facts age](../explanation/how-facts-age.md) says why,
[the file format](format.md#fusion) how it is written.
"""


def _fusion_row(fact: Fact) -> tuple[object, ...]:
    policy = fact.fusion
    assert policy is not None
    permitting = ", ".join("true" if value is True else "false" if value is False else value for value in policy.permissive.values)
    for sign, bound in (("above", policy.permissive.above), ("below", policy.permissive.below)):
        permitting += f"{sign} {fact.show(bound)}" if bound is not None else ""
    if not permitting:
        permitting = "every number" if fact.is_numeric else "nothing"
    confirmed = f"{policy.confirmations} within {policy.within:g} s"
    bounds = [fact.show(bound) for bound in (policy.least, policy.most) if bound is not None]
    step = f", in steps of {fact.show(policy.step)}" if policy.step else ""
    replaced = ", or till replaced" if policy.replaced else ""
    return (
        f"`{fact.name}`", permitting, _reach(policy.holds) + replaced, _reach(policy.fresh), confirmed, " or ".join(policy.corroboration),
        ", ".join(policy.ends), ", ".join(policy.places), " to ".join(bounds) + step,
    )  # fmt: skip


def _reach(reach: Reach) -> str:
    bounds = [f"{value:g} {unit}" for value, unit in ((reach.seconds, "s"), (reach.metres, "m")) if value != float("inf")]
    return ", ".join(bounds) or "for ever"


def states() -> str:
    """The state machine as a table, and as a picture."""
    machine = law().corpus.machine
    parts = ["# The state machine\n"]
    for item in machine.super_states.values():
        own = [state for state in machine.states.values() if state.super_state == item.name]
        parts.append(f"## {item.name}\n\n{item.meaning} Prompt: {item.prompt or '(none: it asks no model)'}\n")
        rows = ((f"`{s.name}`", s.meaning + (" (extension)" if s.extension else ""), ", ".join(f"`{n}`" for n in s.next)) for s in own)
        parts.append(table(("state", "meaning", "next"), rows))
    parts.append("## The whole machine\n\nAs `regdb show states --format mermaid` writes it; a star marks an extension.\n")
    parts.append(f"```mermaid\n{to_mermaid(machine)}```\n")
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
    """What is encoded and what is not, per code and section, and how sure we are of it."""
    corpus = law().corpus
    found = ledgers(corpus)
    parts = ["# The codes as encoded\n", _ABOUT_CODES, _shares("code", ((item.jurisdiction.name, item.accounts) for item in found))]
    for ledger in found:
        jurisdiction = ledger.jurisdiction
        own = [section for section in corpus.sections if section.jurisdiction is jurisdiction]
        count = len({entry.id for entry in corpus.regulations if entry.jurisdiction is jurisdiction})
        parts.append(f"## {jurisdiction.name}\n\n{len(own)} sections have a file ({_sure(own)}), {count} regulations.\n")
        if ledger.outline is not None:
            read = f" Read at <{ledger.outline.source}>." if ledger.outline.source else ""
            parts.append(f"The list of sections itself is {ledger.outline.listing}.{read} {ledger.outline.note}\n")
        parts.append(_shares("part", ((": ".join(part for part in group if part), items) for group, items in ledger.groups.items())))
        rows = (_section_row(item.entry, MEANINGS[item.status]) for item in ledger.accounts if item.entry is not None)
        parts.append("### Sections with a file\n\n" + table(("section", "title", "regulations", "versions", "confidence", "stands"), rows))
        rest = ((item.section, item.heading, MEANINGS[item.status], item.why) for item in ledger.accounts if item.why)
        parts.append("### What is not encoded, and why\n\n" + table(("section", "heading", "stands", "why"), rest))
    return "\n".join(parts)


_ABOUT_CODES = """Every section of the chapters that matter is accounted for: encoded, partly encoded (what is missing), not for a driving ADS
(why), or not expressible (why); `regdb coverage` prints the same. How sure we are of a section: *verified* (two sources seen and
compared), *seen* (one), *recalled* (none: no number of such a section has been verified). A section without a file is not shown as law.
"""


def _shares(head: str, groups: Iterable[tuple[str, tuple[Account, ...]]]) -> str:
    """How many sections stand how, in each group."""
    counted = [(name, count(items), len(items)) for name, items in groups]
    rows = ((name, *(by[status] or "" for status in STATUSES), total) for name, by, total in counted)
    return table((head, *(MEANINGS[status] for status in STATUSES), "all"), rows)


def _sure(sections: list[SectionEntry]) -> str:
    sure = Counter(section.doc.source.confidence for section in sections)
    return ", ".join(f"{sure[level]} {level}" for level in ("verified", "seen", "recalled") if sure[level])


def _section_row(section: SectionEntry, stands: str) -> tuple[object, ...]:
    rules = len({entry.doc.id for version in section.versions for entry in version.regulations})
    return section.doc.section, section.doc.title, rules, len(section.versions), section.doc.source.confidence, stands


def lint_rules() -> str:
    """Every rule with its page, and what reading and resolving report."""
    from regdb_compiler.lint.catalogue import FAMILIES, Listed, catalogue
    from regdb_compiler.lint.registry import shipped_rules

    items = catalogue(shipped_rules())
    parts = ["# Lint rules\n", f"{len(items)} things that `regdb lint` can find. `regdb rule <code>` shows a page in the terminal.\n"]
    for family, about in FAMILIES.items():
        own = [item for item in items if item.code.startswith(family)]
        rows = (
            (f"[{item.code}](#{item.code.lower()}-{item.name})", item.name, item.level, item.page.fix_kind, item.page.summary) for item in own
        )
        parts.append(f"## {family}: {about}\n\n" + table(("code", "name", "level", "fix", "what it finds"), rows))

    def page(item: Listed) -> str:
        lines = [f"### {item.code} {item.name}", f"{item.page.summary} ({item.level})", item.page.why]
        lines += [f"{title}:\n\n```yaml\n{text}\n```" for title, text in (("Fails", item.page.fails), ("Passes", item.page.passes)) if text]
        lines += [f"Fix ({item.page.fix_kind}): {item.page.fix or 'see the finding'}"] if item.page.fix_kind else []
        return "\n\n".join(line for line in lines if line) + "\n"

    return "\n".join([*parts, *map(page, items)])


GENERATED: dict[str, Callable[[], str]] = {
    "command-line.md": command_line,
    "lint-rules.md": lint_rules,
    "vocabulary.md": vocabulary,
    "fusion.md": fusion,
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
