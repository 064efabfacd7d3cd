"""Where zones end: by a sign that says so, or by the map; distance ends them by itself (their `holds`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from regdb.vocabulary import Vocabulary
from regdb_runtime.perception.evidence import Statement
from regdb_runtime.perception.policies import Belief, Held

MAP = "map"
"""In a policy's `ends`: the map's word that it is over ends it."""


class ZoneEnds:
    """Remembers for each fact the capture time before which what was said of it is over."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._ends: Mapping[str, tuple[str, ...]] = {fact.name: fact.fusion.ends for fact in vocabulary if fact.fusion and fact.fusion.ends}
        self._over: dict[str, float] = {}

    def note(self, said: Mapping[str, Sequence[Statement]], believe: Callable[[str], Belief | None]) -> None:
        """Look whether what was just said ends something: `believe` gives what is held of a fact with it."""
        for name, ends in self._ends.items():
            for end in ends:
                moment = self._by_map(said.get(name, ())) if end == MAP else self._by_sign(end, said, believe)
                if moment is not None and moment > self._over.get(name, float("-inf")):
                    self._over[name] = moment

    def _by_map(self, statements: Sequence[Statement]) -> float | None:
        over = [item.captured for item in statements if item.source == MAP and item.value in (False, "none")]
        return max(over, default=None)

    def _by_sign(self, end: str, said: Mapping[str, Sequence[Statement]], believe: Callable[[str], Belief | None]) -> float | None:
        """The first of the looks that confirmed the sign; what was seen of the zone after it stays, or begins another."""
        name, _, word = end.partition("=")
        if name not in said:
            return None
        belief = believe(name)
        if belief is None or belief.value != (word or True):
            return None
        return min(item.captured for item in belief.evidence)

    def open(self, fact: str, held: Sequence[Held]) -> Sequence[Held]:
        """Without the restrictive statements that are over."""
        moment = self._over.get(fact)
        return held if moment is None else [item for item in held if item.captured >= moment or item.statement.value in (False, "none")]
