"""The compiled index answers what the reference answers, in both of its forms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from regdb_runtime.database import RegulationDatabase

from regdb.meaning import decide, governing
from regdb.situation import Situation

SCENES = 100_000


def shown(limits: Any) -> list[tuple[str, str, float]]:
    return [(item.regulation.id, item.limit.attribute, item.bound) for item in limits]


@pytest.mark.parametrize("threshold", [10_000, -1], ids=["generated", "bitmaps"])
def test_agrees_with_the_reference(random_law: Callable[[int], Any], threshold: int) -> None:
    verdicts = {"legal": 0, "illegal": 0, "unknown": 0}
    done, seed = 0, 0
    while done < SCENES // 2:
        seed += 1
        law = random_law(seed)
        rules = law.rules(law.dice.choice((3, 6, 12)))
        database = RegulationDatabase(law.vocabulary, law.machine, law.tree, rules, threshold=threshold)
        for place, day in (("city", 739003), ("county", 739007), ("state", 739012)):
            view = database.at(place, day)
            for _ in range(100):
                scene, plan = law.scene(), law.plan()
                got = view.judge(scene, plan)
                want = decide(governing(rules, law.tree, place, day), Situation(law.vocabulary, scene, plan))
                assert got.verdict == want.verdict, (seed, scene, plan)
                assert got.deciding == want.deciding, (seed, scene, plan)
                assert shown(got.limits) == shown(want.limits), (seed, scene, plan)
                if done % 20 == 0:
                    assert (shown(got.possible), got.missing, got.assumed) == (shown(want.possible), want.missing, want.assumed)
                assert not got.errors
                verdicts[got.verdict] += 1
                done += 1
    assert min(verdicts.values()) > SCENES // 50, verdicts


def test_large_buckets_agree_in_both_forms(random_law: Callable[[int], Any]) -> None:
    """300 rules that all concern the transition: many share a gate, many cut points fall on one fact."""
    for seed in (1, 2, 3):
        law = random_law(seed)
        rules = law.rules(300)
        forms = [RegulationDatabase(law.vocabulary, law.machine, law.tree, rules, threshold=size).at("city", 739003) for size in (-1, 999)]
        for _ in range(40):
            scene, plan = law.scene(), law.plan()
            want = decide(governing(rules, law.tree, "city", 739003), Situation(law.vocabulary, scene, plan))
            for view in forms:
                got = view.judge(scene, plan)
                assert (got.verdict, got.deciding, shown(got.limits)) == (want.verdict, want.deciding, shown(want.limits))
                assert (shown(got.possible), got.missing, got.assumed) == (shown(want.possible), want.missing, want.assumed)
