"""Which regulations take part in a test: all law of the place and day, or what displacement connects with one regulation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from regdb.jurisdiction import JurisdictionTree
from regdb.meaning import governing
from regdb.regulation import Regulation


class Law:
    """The rows of a build, narrowed once for every place and day that tests ask for."""

    def __init__(self, regulations: Iterable[Regulation], tree: JurisdictionTree) -> None:
        self.regulations, self.tree = tuple(regulations), tree
        self._above: dict[str, set[str]] = {}
        self._below: dict[str, set[str]] = {}
        for rule in self.regulations:
            self._above.setdefault(rule.id, set()).update(rule.targets)
            for target in rule.targets:
                self._below.setdefault(target, set()).add(rule.id)
        self._all: dict[tuple[str, int], tuple[Regulation, ...]] = {}
        self._connected: dict[str, frozenset[str]] = {}
        self._beside: dict[tuple[str, str, int], tuple[Regulation, ...]] = {}

    def everything(self, place: str, day: int) -> tuple[Regulation, ...]:
        """All law in force at a place (a jurisdiction's id) on a day, by id."""
        key = place, day
        if key not in self._all:
            self._all[key] = governing(self.regulations, self.tree, place, day)
        return self._all[key]

    def beside(self, name: str, place: str, day: int) -> tuple[Regulation, ...]:
        """What of it takes part in the tests beside the regulation `name`."""
        key = name, place, day
        if key not in self._beside:
            ids = self.connected(name)
            self._beside[key] = tuple(rule for rule in self.everything(place, day) if rule.id in ids)
        return self._beside[key]

    def connected(self, name: str) -> frozenset[str]:
        """The regulation, what it displaces over any number of steps, and what displaces any of these over any number of steps."""
        if name not in self._connected:
            self._connected[name] = frozenset(_reach(_reach({name}, self._above), self._below))
        return self._connected[name]


def _reach(start: set[str], edges: Mapping[str, set[str]]) -> set[str]:
    found, queue = set(start), list(start)
    while queue:
        for other in edges.get(queue.pop(), ()):
            if other not in found:
                found.add(other)
                queue.append(other)
    return found
