"""Defeat among the rules that may hold: effective = holds and not defeated, with exceptions looked at only when they matter."""

from __future__ import annotations

from collections.abc import Collection

from regdb.truth import Truth
from regdb_runtime.index.bucket import Bucket
from regdb_runtime.index.slots import Values


class Tangle:
    """The rules of a bucket that defeat each other; one `settle` per decision in which one of them may hold."""

    def __init__(self, bucket: Bucket) -> None:
        self.bucket, self.parts = bucket, bucket.parts
        self._waits = frozenset(part.index for part in bucket.parts if part.waits)

    def settle(
        self, sure: list[int], maybe: list[int], values: Values, broken: list[int], undecided: list[int], limiting: list[int]
    ) -> Collection[int]:
        """File the rules that surely or maybe hold under broken, undecided, limiting. The exceptions in effect come back."""
        holding: dict[int, Truth] = dict.fromkeys(maybe)
        for index in sure:
            holding[index] = True
        effective: dict[int, Truth] = {}
        for index in (*sure, *maybe):
            truth = self._effective(index, holding, effective, values)
            if truth is not False:
                self.file(index, truth, values, broken, undecided, limiting)
        if broken or undecided:
            return ()
        return self._excepting(sure, holding, effective, values)

    def file(
        self, index: int, truth: Truth, values: Values, broken: list[int], undecided: list[int], limiting: list[int]
    ) -> None:
        part = self.parts[index]
        if part.limiting and truth is True:
            limiting.append(index)
        if not part.breakable:
            return
        past = self.bucket.beyond(index)(values) if part.rule.limits else True
        if past is not False:
            (broken if truth is True and past is True else undecided).append(index)

    def _effective(self, index: int, holding: dict[int, Truth], effective: dict[int, Truth], values: Values) -> Truth:
        if index in effective:
            return effective[index]
        truth = self.bucket.condition(index)(values) if index in self._waits else holding.get(index, False)
        if truth is not False:
            for other in self.parts[index].defeaters:
                defeated = self._effective(other, holding, effective, values)
                if defeated is True:
                    truth = False
                    break
                if defeated is None:
                    truth = None
        effective[index] = truth
        return truth

    def _excepting(
        self, sure: list[int], holding: dict[int, Truth], effective: dict[int, Truth], values: Values
    ) -> Collection[int]:
        """The exceptions in effect against a rule that holds."""
        return {
            other
            for index in sure
            for other in self.parts[index].defeaters
            if self._effective(other, holding, effective, values) is True
        }
