"""What permits is declared in the vocabulary and follows from the law: nothing that only ever frees is believed from one statement."""

from __future__ import annotations

from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from regdb_compiler.driver import Build, build
from regdb_compiler.lint.view import view_of
from regdb_runtime.scenes.merging import PERMISSIVE

from regdb.condition import And, Has, Is, Node, Not, OneOf, Or
from regdb.vocabulary import Vocabulary

ROOT = Path(__file__).resolve().parents[2]
Use = tuple[str, bool | str]


@cache
def law() -> Build:
    return build(ROOT / "codes", added=())


@pytest.fixture(scope="module")
def vocabulary() -> Vocabulary:
    return law().corpus.vocabulary


@cache
def uses() -> tuple[Counter[Use], Counter[Use]]:
    """How often each value makes a rule forbid, and how often it makes one permit or lifts a prohibition."""
    binds: Counter[Use] = Counter()
    frees: Counter[Use] = Counter()
    for rule in view_of(law()).first:
        permission = bool(rule.entry.doc.legality)
        _count(rule.when, permission, binds, frees)
        if rule.unless is not None:
            _count(rule.unless, not permission, binds, frees)
    return binds, frees


def _count(node: Node, freeing: bool, binds: Counter[Use], frees: Counter[Use]) -> None:
    if isinstance(node, Not):
        _count(node.part, not freeing, binds, frees)
    elif isinstance(node, (And, Or)):
        for part in node.parts:
            _count(part, freeing, binds, frees)
    elif isinstance(node, (Is, OneOf, Has)):
        values: tuple[bool | str, ...] = (True,) if isinstance(node, Is) else node.words if isinstance(node, OneOf) else (node.word,)
        (frees if freeing else binds).update((node.fact, value) for value in values)


def test_the_law_is_read_by_its_signs() -> None:
    binds, frees = uses()
    assert binds["signal.color", "red"] > 0
    assert frees["stationary_hazard_vehicle.behind_barrier", True] > 0


def test_what_only_ever_frees_waits_for_confirmation_or_says_why_not(vocabulary: Vocabulary) -> None:
    binds, frees = uses()
    wrong = []
    for name, value in sorted(frees.keys() - binds.keys(), key=str):
        policy = vocabulary.fact(name).fusion
        if policy is not None and value not in policy.permissive and not policy.because:
            wrong.append(f"{name} {value}")
    assert wrong == []


def test_no_boolean_that_only_ever_forbids_waits_for_confirmation(vocabulary: Vocabulary) -> None:
    binds, frees = uses()
    wrong = []
    for name, value in sorted(binds.keys() - frees.keys(), key=str):
        policy = vocabulary.fact(name).fusion
        if value is True and policy is not None and value in policy.permissive and not policy.because:
            wrong.append(name)
    assert wrong == []


def test_two_tellers_and_two_looks_agree_on_what_frees(vocabulary: Vocabulary) -> None:
    """Where map and eye differ the scene takes the stricter reading: by the same side that fusion confirms."""
    assert [name for name in sorted(PERMISSIVE) if True not in vocabulary.fact(name).fusion.permissive] == []  # type: ignore[union-attr]


def test_every_fact_that_perception_tells_has_a_policy(vocabulary: Vocabulary) -> None:
    assert [fact.name for fact in vocabulary if (fact.fusion is None) == (fact.source in ("perception", "map"))] == []


def test_confirmations_can_be_had_within_their_time(vocabulary: Vocabulary) -> None:
    for fact in vocabulary:
        policy = fact.fusion
        if policy is not None:
            assert policy.confirmations >= 2, fact.name
            needed = (policy.confirmations - 1) * max(policy.apart, 0.5)
            assert needed <= policy.within, f"{fact.name}: a model at 2 Hz never confirms it"
            assert needed <= policy.fresh.seconds, f"{fact.name}: the first look is stale before the last"


def test_what_is_asked_about_asks_back_or_is_no_sign(vocabulary: Vocabulary) -> None:
    for fact in vocabulary:
        for other in fact.fusion.asks if fact.fusion else ():
            assert other in fact.confusables or fact.name in vocabulary.fact(other.partition("=")[0]).confusables, f"{fact.name} asks {other}"
