"""Facts of many plans at once: what all share, and columns with one value a plan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regdb.vocabulary import Value
from regdb_runtime.trajectory import Floats

Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Column:
    """One fact over k plans: truths (bool), numbers (float, NaN is not told), or words (int places in `words`, -1 is not told)."""

    values: NDArray[Any]
    words: tuple[Value, ...] = ()

    @property
    def is_number(self) -> bool:
        return self.values.dtype.kind == "f"

    def told(self, row: int) -> Value | None:
        """The fact as plans say it; None when this one does not."""
        value = self.values.item(row)
        if self.words:
            return None if value < 0 else self.words[value]
        return None if value != value else value


@dataclass(frozen=True, eq=False)
class OfStretch:
    """Facts of plans in one stretch: what all plans share there, and columns with one value a plan."""

    shared: Mapping[str, Value]
    columns: Mapping[str, Column]


@dataclass(frozen=True, eq=False)
class PlanFacts:
    """Facts of k plans under one manoeuvre.

    `shared` is the same for all; `columns` name -> one value a plan; `of_stretch` what differs between the S stretches; `reached` (S, k):
    whether the front bumper is within the stretch at any time of the plan. `speed`, `front` (k, T) and the stretches' `borders` are for what
    must be weighed over time.
    """

    shared: Mapping[str, Value]
    columns: Mapping[str, Column]
    of_stretch: Sequence[OfStretch]
    reached: Bools
    size: int = 0
    speed: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    front: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    borders: Sequence[tuple[float, float]] = ()

    def names(self, stretch: int) -> tuple[str, ...]:
        """Every fact that differs between plans."""
        return (*self.columns, *self.of_stretch[stretch].columns)

    def column(self, stretch: int, name: str) -> Column:
        found = self.of_stretch[stretch].columns.get(name)
        return self.columns[name] if found is None else found

    def beyond(self, stretch: int, name: str, rows: NDArray[np.intp], bound: float, direction: str) -> Floats:
        """How far some plans are past a bound: a speed on average over the plan, anything else as measured."""
        if name == "plan.speed" and direction == "max":
            (start, end), front = self.borders[stretch], self.front[rows]
            return np.asarray((np.maximum(self.speed[rows] - bound, 0.0) * ((front >= start) & (front < end))).mean(axis=1))
        values = self.column(stretch, name).values[rows]
        return np.asarray(values - bound if direction == "max" else bound - values)

    def one(self, stretch: int, row: int, roles: Mapping[str, Value]) -> dict[str, Value]:
        """All facts of one plan in one stretch, over those of its roles."""
        here = self.of_stretch[stretch]
        facts = {**roles, **self.shared, **here.shared}
        for columns in (self.columns, here.columns):
            for name, column in columns.items():
                value = column.told(row)
                if value is None:
                    facts.pop(name, None)
                else:
                    facts[name] = value
        return facts


def truth(values: ArrayLike) -> Column:
    """A column of truths."""
    return Column(np.asarray(values, dtype=np.bool_))


def number(values: Floats, decimals: int) -> Column:
    """A column of numbers, rounded; infinite ones are not told."""
    return Column(np.where(np.isfinite(values), np.round(values, decimals), np.nan))


def word(places: NDArray[Any], words: tuple[Value, ...]) -> Column:
    """A column of words by their places; -1 is not told."""
    return Column(np.asarray(places, dtype=np.intp), words)
