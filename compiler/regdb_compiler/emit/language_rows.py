"""The language's rows: jurisdictions, states with their transitions, facts and attributes."""

from __future__ import annotations

from collections.abc import Iterator

from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.states import StateMachine
from regdb.vocabulary import Fact, Value, Vocabulary
from regdb_compiler.emit.fusion_rows import fusion_rows
from regdb_compiler.emit.rows import Line, Tables, compact


def language_rows(tree: JurisdictionTree, machine: StateMachine, vocabulary: Vocabulary) -> Tables:
    """Rows of the eight tables that hold the language. Names are in order, parents before children, states as declared."""
    places = sorted(tree, key=lambda item: tuple(step.id for step in tree.path(item.id)))
    return {
        "jurisdiction": [_jurisdiction(item) for item in places],
        "super_state": _super_states(machine),
        "state": _states(machine),
        "transition": [(state.id, following) for state in machine.states.values() for following in state.next],
        "fact": [_fact(vocabulary.facts[name]) for name in sorted(vocabulary.facts)],
        "attribute": [
            (item.name, item.kind, item.fact, item.direction, item.meaning)
            for _, item in sorted(vocabulary.attributes.items())
        ],
        "fact_fusion": fusion_rows(vocabulary),
        "lexicon": sorted(_lexicon(vocabulary)),
    }  # fmt: skip


def _lexicon(vocabulary: Vocabulary) -> Iterator[Line]:
    """Word classes, and which facts others entail."""
    yield from (("words", name, compact(members)) for name, members in vocabulary.words.items())
    yield from (("entails", fact.name, compact(fact.entails)) for fact in vocabulary if fact.entails)


def _jurisdiction(item: Jurisdiction) -> Line:
    return (
        item.id, item.name, item.kind, item.status, item.parent, item.code, item.short, item.long,
        compact(item.territory), compact(item.road_owners), item.source,
    )  # fmt: skip


def _super_states(machine: StateMachine) -> list[Line]:
    return [
        (
            item.name, position, item.meaning, item.prompt, compact(item.next), item.entry, item.exit, compact(item.aliases),
            int(item.from_anywhere), int(item.name == machine.initial),
        )
        for position, item in enumerate(machine.super_states.values())
    ]  # fmt: skip


def _states(machine: StateMachine) -> list[Line]:
    return [
        (state.id, position, state.super_state, state.name, state.meaning, state.prompt, compact(state.aliases), int(state.extension))
        for position, state in enumerate(machine.states.values())
    ]


def _fact(fact: Fact) -> Line:
    stands = fact.assumption
    return (
        fact.name, fact.kind, fact.meaning, fact.source, compact(fact.values), fact.unit, fact.dimension,
        None if stands is None else value_json(stands.value), stands.within if stands else "", stands.because if stands else "",
        None if fact.quiet is None else value_json(fact.quiet), compact(dict(sorted(fact.phrases.items()))), compact(fact.confusables),
        compact(dict(sorted(fact.codes.items()))),
    )  # fmt: skip


def value_json(value: Value) -> str:
    """A known value as JSON: numbers in SI, a set as its words in order."""
    return compact(sorted(value) if isinstance(value, frozenset) else value)
