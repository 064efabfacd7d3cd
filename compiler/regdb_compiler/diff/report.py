"""A comparison as text at 80 columns, and as JSON."""

from __future__ import annotations

import json
import textwrap
from collections import Counter
from collections.abc import Sequence

from regdb_compiler.diff.compare import Change

WIDTH = 80


def to_text(old: str, new: str, changes: Sequence[Change]) -> str:
    """What was added, removed and changed, field by field, with a closing count."""
    lines = [f"{old} -> {new}", ""]
    for change in changes:
        lines += _change_lines(change)
    return "\n".join([*lines, summary(changes)])


def _change_lines(change: Change) -> list[str]:
    item = change.item
    name = item.id
    if change.old is not None and change.new is not None and change.old.id != change.new.id:
        name = f"{change.old.id} ~ {change.new.id}"
    lines = [f"{change.kind:<8} {name}  ({item.citation})  {change.impact}"]
    if not change.fields:
        told = f"{'may' if item.permission else 'unlawful'}: {item.fields.get('condition', '')}"
        lines += textwrap.wrap(told, WIDTH, initial_indent="    ", subsequent_indent="    ")
    for field, before, after in change.fields:
        lines.append(f"    {field}:")
        for sign, text in (("-", before), ("+", after)):
            if text:
                lines += textwrap.wrap(text, WIDTH, initial_indent=f"      {sign} ", subsequent_indent="        ")
    return [*lines, ""]


def summary(changes: Sequence[Change]) -> str:
    """`2 added, 1 removed, 3 changed (1 tighter, 2 text-only)`."""
    if not changes:
        return "no difference"
    kinds, impacts = Counter(change.kind for change in changes), Counter(change.impact for change in changes)
    told = ", ".join(f"{kinds[kind]} {kind}" for kind in ("added", "removed", "changed") if kinds[kind])
    return f"{told} ({', '.join(f'{count} {impact.lower()}' for impact, count in sorted(impacts.items()))})"


def to_json(old: str, new: str, changes: Sequence[Change]) -> str:
    """Stable JSON: `{old, new, changes: [{kind, impact, id, other_id, citation, topic, fields: {name: [old, new]}}]}`."""
    data = {"schema": "regdb-diff/1", "old": old, "new": new, "changes": [_change_data(change) for change in changes]}
    return json.dumps(data, indent=2, ensure_ascii=False)


def _change_data(change: Change) -> dict[str, object]:
    return {
        "kind": change.kind,
        "impact": change.impact,
        "id": change.old.id if change.old else change.item.id,
        "other_id": change.new.id if change.new else None,
        "citation": change.item.citation,
        "topic": change.item.topic,
        "fields": {name: [before, after] for name, before, after in change.fields},
    }
