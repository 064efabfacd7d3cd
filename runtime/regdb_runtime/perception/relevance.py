"""Which facts matter here: a light only where the map has one, a train only where it has rails; what the map leaves open matters."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from regdb.vocabulary import Value, Vocabulary


@lru_cache(maxsize=8)
def _placed(vocabulary: Vocabulary) -> tuple[tuple[str, tuple[tuple[str, str], ...]], ...]:
    """Each fused fact with the facts (and words) of which one must be so for it to matter."""
    return tuple(
        (fact.name, tuple((name, word) for name, _, word in (text.partition("=") for text in fact.fusion.places)))
        for fact in vocabulary
        if fact.fusion is not None
    )


def relevant_facts(vocabulary: Vocabulary, known: Mapping[str, Value]) -> frozenset[str]:
    """The facts that matter where `known` is so: all but those each of whose places is known not to be here.

    `known`: what the map says of the place (`signal.present: False`); a place it leaves out may be here, so its facts matter.
    """
    return frozenset(name for name, places in _placed(vocabulary) if not places or any(_may_be(known, place, word) for place, word in places))


def _may_be(known: Mapping[str, Value], place: str, word: str) -> bool:
    value = known.get(place)
    if value is None:
        return True
    return value == word if word else value not in (False, "none")
