"""The rules of belief of every fact as rows of `fact_fusion`: SI numbers, NULL where nothing bounds, JSON where there are several."""

from __future__ import annotations

import math

from regdb.fusion_policy import FusionPolicy
from regdb.vocabulary import Vocabulary
from regdb_compiler.emit.rows import Line, compact


def fusion_rows(vocabulary: Vocabulary) -> list[Line]:
    """A row for each fact that has a policy, by name."""
    return [_row(name, policy) for name, fact in sorted(vocabulary.facts.items()) if (policy := fact.fusion) is not None]


def _row(name: str, policy: FusionPolicy) -> Line:
    allowed = policy.permissive
    return (
        name, policy.ages, _bound(policy.holds.seconds), _bound(policy.holds.metres), _bound(policy.fresh.seconds), _bound(policy.fresh.metres),
        policy.confirmations, policy.within, policy.apart, int(policy.replaced), compact(allowed.values), allowed.above, allowed.below,
        compact(policy.corroboration), compact(policy.strictest), policy.least, policy.most, policy.step, compact(policy.asks),
        policy.question, compact(policy.ends), compact(policy.places), policy.because,
    )  # fmt: skip


def _bound(value: float) -> float | None:
    return None if math.isinf(value) else value
