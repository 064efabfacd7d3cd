"""What holds of the fusion whatever is said: one statement permits nothing, stricter evidence never loosens, order and age decide as declared."""

from __future__ import annotations

import random
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.perception.evidence import Reading, Statement
from regdb_runtime.perception.fusion import Fusion
from regdb_runtime.perception.policies import Held, Moment, believe, restricts

from regdb.front import database
from regdb.vocabulary import Fact, Value

VOCABULARY = RegulationDatabase.open(database()).vocabulary
FUSED = [fact for fact in VOCABULARY if fact.fusion is not None]
LOOKING = ("model", "detector", "scripted")
TIMES = [0.25 * step for step in range(17)]
SPEED = 20.0


def possible(fact: Fact) -> list[Value]:
    """Values of every kind that a statement may bear."""
    assert fact.fusion is not None
    if fact.kind == "boolean":
        return [False, True]
    if fact.kind == "enumeration":
        return list(fact.values)
    if fact.kind == "set":
        return [frozenset(), *(frozenset([word]) for word in fact.values), frozenset(fact.values[:2])]
    low, high = fact.fusion.least or 0.0, fact.fusion.most or 100.0
    step = fact.fusion.step or (high - low) / 6
    return [low + step * count for count in (0, 1, 3, 5)]


@st.composite
def evidence(draw: st.DrawFn, sources: tuple[str, ...] = (*LOOKING, "map")) -> tuple[Fact, list[Held]]:
    """A fact and what was said of it within four seconds and eighty metres."""
    fact = draw(st.sampled_from(FUSED))
    said = draw(st.lists(st.tuples(
        st.sampled_from(possible(fact)), st.sampled_from(TIMES), st.sampled_from(sources), st.sampled_from(["asserted", "asserted", "hedged"]),
        st.sampled_from(["", "", "choice"]),
    ), max_size=9))  # fmt: skip
    return fact, [Held(Statement(fact.name, value, sure, source, at, rule=rule), SPEED * at) for value, at, source, sure, rule in said]  # type: ignore[arg-type]


def value_of(fact: Fact, held: list[Held], time: float = 4.0) -> Value | None:
    assert fact.fusion is not None
    found = believe(fact, fact.fusion, held, Moment(time, SPEED * time))
    return None if found is None else found.value


def strictness(fact: Fact, value: Value | None) -> float:
    """Permissive below unknown below restrictive; among the restrictive as the policy ranks them."""
    policy = fact.fusion
    assert policy is not None
    if value is None:
        return 0.0
    if isinstance(value, frozenset):
        return sum(1.0 for word in value if word not in policy.permissive) or -1.0
    numeric = isinstance(value, (int, float)) and not isinstance(value, bool)
    ranked = (-value if policy.permissive.above is not None else value) / 1e6 if numeric else 0.0
    if not restricts(policy, value):
        return -1.0 + ranked
    order = [*policy.strictest, *(word for word in fact.values if word not in policy.strictest)]
    return 2.0 + (ranked if numeric else 1.0 - order.index(value) / 100 if isinstance(value, str) else 0.0)


@settings(max_examples=600, deadline=None)
@given(evidence(), st.randoms(use_true_random=False))
def test_the_order_in_which_statements_arrive_changes_nothing(found: tuple[Fact, list[Held]], mixed: random.Random) -> None:
    fact, held = found
    other = list(held)
    mixed.shuffle(other)
    assert value_of(fact, held) == value_of(fact, other)


@settings(max_examples=400, deadline=None)
@given(st.lists(st.sampled_from(FUSED), min_size=1, max_size=4), st.data())
def test_the_order_of_statements_within_one_answer_changes_nothing(facts: list[Fact], data: st.DataObject) -> None:
    said = [Statement(fact.name, data.draw(st.sampled_from(possible(fact))), captured=1.0) for fact in facts for _ in range(2)]
    snapshots = []
    for order in (said, said[::-1]):
        fusion = Fusion(VOCABULARY)
        fusion.update(Reading("", tuple(order)), 0.0, 1.0)
        fusion.update(Reading("", tuple(replace(item, captured=1.5) for item in order)), 0.0, 1.5)
        snapshots.append(fusion.snapshot(1.5, 0.0))
    assert snapshots[0] == snapshots[1]


@settings(max_examples=600, deadline=None)
@given(st.sampled_from(FUSED), st.data())
def test_one_statement_of_who_looks_permits_nothing(fact: Fact, data: st.DataObject) -> None:
    assert fact.fusion is not None
    value = data.draw(st.sampled_from(possible(fact)))
    rule = data.draw(st.sampled_from(["", "choice"]))
    known = value_of(fact, [Held(Statement(fact.name, value, "asserted", data.draw(st.sampled_from(LOOKING)), 4.0, rule=rule), 80.0)])  # type: ignore[arg-type]
    assert known is None or restricts(fact.fusion, known)
    if not isinstance(value, frozenset):
        assert (known is not None) == restricts(fact.fusion, value), "what restricts is known at once"


@settings(max_examples=1500, deadline=None)
@given(evidence(), st.data())
def test_stricter_evidence_never_makes_a_fact_less_strict(found: tuple[Fact, list[Held]], data: st.DataObject) -> None:
    fact, held = found
    assert fact.fusion is not None
    strictest = max(possible(fact), key=lambda value: strictness(fact, value))
    if not restricts(fact.fusion, strictest):
        return
    before = strictness(fact, value_of(fact, held))
    more = Held(Statement(fact.name, strictest, "asserted", data.draw(st.sampled_from(LOOKING)), data.draw(st.sampled_from(TIMES))), 0.0)  # type: ignore[arg-type]
    more = replace(more, travelled=SPEED * more.captured)
    assert strictness(fact, value_of(fact, [*held, more])) >= before
    if held:
        place = data.draw(st.integers(0, len(held) - 1))
        if held[place].statement.certainty == "asserted" and fact.kind != "set":
            stricter = replace(held[place], statement=replace(held[place].statement, value=strictest))
            assert strictness(fact, value_of(fact, [*held[:place], stricter, *held[place + 1 :]])) >= before


@settings(max_examples=600, deadline=None)
@given(evidence())
def test_everything_is_forgotten(found: tuple[Fact, list[Held]]) -> None:
    fact, held = found
    assert fact.fusion is not None
    far = Moment(1e5, 1e5)
    assert believe(fact, fact.fusion, held, far) is None


@settings(max_examples=800, deadline=None)
@given(evidence(sources=("model", "scripted")))
def test_where_corroboration_is_declared_the_model_alone_permits_nothing(found: tuple[Fact, list[Held]]) -> None:
    fact, held = found
    assert fact.fusion is not None
    known = value_of(fact, held)
    if fact.fusion.corroboration:
        words = known if isinstance(known, frozenset) else [known]
        assert known is None or (words and all(word not in fact.fusion.permissive for word in words))


@settings(max_examples=600, deadline=None)
@given(evidence())
def test_hedged_words_alone_make_nothing_known(found: tuple[Fact, list[Held]]) -> None:
    fact, held = found
    hedged = [replace(item, statement=replace(item.statement, certainty="hedged", source="model")) for item in held]
    assert value_of(fact, hedged) is None


@settings(max_examples=600, deadline=None)
@given(evidence())
def test_a_belief_rests_on_statements_that_were_made(found: tuple[Fact, list[Held]]) -> None:
    fact, held = found
    assert fact.fusion is not None
    belief = believe(fact, fact.fusion, held, Moment(4.0, SPEED * 4.0))
    if belief is not None:
        assert belief.evidence
        assert set(belief.evidence) <= {item.statement for item in held}
        assert fact.kind in ("set", "quantity", "count") or all(item.value == belief.value for item in belief.evidence)


@settings(max_examples=300, deadline=None)
@given(evidence())
def test_what_the_fusion_lets_go_of_would_have_changed_nothing(found: tuple[Fact, list[Held]]) -> None:
    fact, held = found
    assert fact.fusion is not None
    if fact.fusion.ends:
        return
    fusion = Fusion(VOCABULARY)
    ordered = sorted(held, key=lambda item: item.captured)
    for item in ordered:
        fusion.update(Reading("", (item.statement,)), item.travelled, item.captured)
    assert fusion.snapshot(4.0, SPEED * 4.0).facts.get(fact.name) == value_of(fact, held)
