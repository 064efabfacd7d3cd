"""Jurisdictions as a tree: who makes law where, and which codes govern a place."""

import difflib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass


class JurisdictionError(ValueError):
    """A jurisdiction that is not there, or a tree that is none."""


@dataclass(frozen=True, slots=True)
class Jurisdiction:
    """One maker of law. `status` is `law` or `model`; `short` and `long` are how its code is cited."""

    id: str
    name: str
    kind: str = "state"
    parent: str | None = None
    status: str = "law"
    code: str = ""
    short: str = ""
    long: str = ""
    territory: tuple[str, ...] = ()
    road_owners: tuple[str, ...] = ()
    source: str = ""

    @property
    def is_local(self) -> bool:
        """Whether its law needs authority from an ancestor."""
        return self.kind in {"county", "city", "district"}


class JurisdictionTree:
    """All jurisdictions by id; a code's short folder name stands for its jurisdiction too."""

    def __init__(self, jurisdictions: Iterable[Jurisdiction]) -> None:
        self._by_id = {item.id: item for item in jurisdictions}
        self._by_code = {item.code: item for item in self._by_id.values() if item.code}
        self._check()

    def _check(self) -> None:
        for item in self._by_id.values():
            seen = [item.id]
            while (parent := self._by_id[seen[-1]].parent) is not None:
                if parent not in self._by_id:
                    raise JurisdictionError(f"jurisdiction {seen[-1]!r} names a parent {parent!r} that is not declared")
                if parent in seen:
                    raise JurisdictionError(f"jurisdictions form a circle: {' -> '.join([*seen, parent])}")
                seen.append(parent)

    def __iter__(self) -> Iterator[Jurisdiction]:
        return iter(self._by_id.values())

    def __contains__(self, name: str) -> bool:
        return name in self._by_id or name in self._by_code

    def get(self, name: str) -> Jurisdiction:
        """The jurisdiction with this id or code. Raises JurisdictionError, listing the ones there are."""
        found = self._by_id.get(name) or self._by_code.get(name)
        if found is None:
            near = difflib.get_close_matches(name, [*self._by_id, *self._by_code], 1)
            hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(sorted(self._by_id))}"
            raise JurisdictionError(f"unknown jurisdiction {name!r}; {hint}")
        return found

    def path(self, name: str) -> tuple[Jurisdiction, ...]:
        """From the root down to the jurisdiction itself."""
        steps = [self.get(name)]
        while (parent := steps[-1].parent) is not None:
            steps.append(self._by_id[parent])
        return tuple(reversed(steps))

    def is_ancestor(self, ancestor: str, of: str) -> bool:
        """Whether `ancestor` stands strictly above `of`."""
        return self.get(ancestor).id in {item.id for item in self.path(of)[:-1]}

    def governing(self, place: str, loaded: frozenset[str]) -> frozenset[str]:
        """Ids whose rules decide at `place`: its path, without model codes where an enacted code on it is loaded."""
        path = self.path(place)
        enacted = any(item.status == "law" and item.id in loaded for item in path)
        return frozenset(item.id for item in path if item.status == "law" or not enacted)
