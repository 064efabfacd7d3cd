"""Position -> whose law governs there: the innermost jurisdiction whose area and territory hold the place, and who else may while GNSS is unsure."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb_runtime.errors import MapError
from regdb_runtime.perception.areas import Area, Point

LOCAL = ("city", "town")
"""Kinds of area whose land is incorporated."""


@dataclass(frozen=True, slots=True)
class Governing:
    """`place`: the jurisdiction to ask the law of. `also`: others that the position's accuracy leaves possible; judge by each of them, and let
    the strictest stand. `incorporated`: None while that is open."""

    place: str
    also: tuple[str, ...] = ()
    incorporated: bool | None = None


class JurisdictionMap:
    """Areas with a property `jurisdiction` (an id of the tree), or `kind: city` for cities whose law is not encoded.

    `fallback` governs outside every area (the state, say). Raises MapError for an area that names a jurisdiction which is not there.
    """

    def __init__(self, tree: JurisdictionTree, areas: Iterable[Area], fallback: str) -> None:
        self._tree, self._fallback = tree, tree.get(fallback)
        self._areas = tuple((area, self._named(area, number)) for number, area in enumerate(areas))

    def _named(self, area: Area, number: int) -> Jurisdiction | None:
        name = area.properties.get("jurisdiction")
        if name is None:
            if area.properties.get("kind") not in LOCAL:
                raise MapError(f"area {number} has neither a `jurisdiction` nor `kind: city`: it would govern nothing")
            return None
        if not isinstance(name, str) or name not in self._tree:
            raise MapError(f"area {number} names a jurisdiction {name!r} that is not in the database")
        return self._tree.get(name)

    def at(self, point: Point, accuracy: float = 0.0) -> Governing:
        """Who governs a longitude and latitude known to `accuracy` metres."""
        inside = [(area, item) for area, item in self._areas if area.contains(point)]
        place, incorporated = self._innermost(inside)
        near = self._areas if accuracy > 0 else ()
        doubtful = [pair for pair in near if pair[0].may_contain(point, accuracy) and not pair[0].surely_contains(point, accuracy)]
        sure = [(area, item) for area, item in inside if all(area is not other for other, _ in doubtful)]
        others = {self._innermost([*sure, *some])[0].id for some in _subsets(doubtful)} - {place.id}
        settled = {self._innermost([*sure, *some])[1] for some in _subsets(doubtful)} | {incorporated}
        return Governing(place.id, tuple(sorted(others)), incorporated if len(settled) == 1 else None)

    def _innermost(self, inside: list[tuple[Area, Jurisdiction | None]]) -> tuple[Jurisdiction, bool]:
        """The deepest jurisdiction whose territory this is, and whether it is incorporated."""
        city = any(item is None or item.kind == "city" for _, item in inside)
        land = "incorporated" if city else "unincorporated"
        fitting = [item for _, item in inside if item is not None and (not item.territory or land in item.territory)]
        return max([self._fallback, *fitting], key=lambda item: (len(self._tree.path(item.id)), item.id)), city


def _subsets(items: list[tuple[Area, Jurisdiction | None]]) -> list[list[tuple[Area, Jurisdiction | None]]]:
    """What may be so: of the areas whose border is too near, none, each one alone, or all of them."""
    return [[], *([item] for item in items), items]
