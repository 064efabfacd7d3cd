"""The rows of interpretations: profiles, and how each decides each fact it speaks of."""

from __future__ import annotations

from collections.abc import Iterable

from regdb.interpretation import Decision
from regdb_compiler.emit.rows import Line, Tables, compact
from regdb_compiler.read_interpretations import InterpretationEntry


def interpretation_rows(entries: Iterable[InterpretationEntry]) -> Tables:
    """Rows of the two tables, profiles and facts in order of their names."""
    profiles = sorted((entry.profile for entry in entries), key=lambda item: item.name)
    return {
        "interpretation": [
            (item.name, item.title, item.meaning, item.source_url, compact(item.source_also), item.checked, item.confidence, item.note)
            for item in profiles
        ],
        "interpretation_rule": [_decision(item.name, item.decisions[fact]) for item in profiles for fact in sorted(item.decisions)],
    }


def _decision(profile: str, item: Decision) -> Line:
    numbers = {name: {"text": number.text, "si": number.si} for name, number in sorted(item.parameters.items())}
    return profile, item.fact, item.formula, item.true_when, compact(numbers), item.because, item.source
