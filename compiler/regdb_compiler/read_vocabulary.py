"""Vocabulary, jurisdiction and state documents -> the types both sides speak, with every inconsistency reported."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from regdb.jurisdiction import Jurisdiction, JurisdictionError, JurisdictionTree
from regdb.states import State, StateMachine, SuperState
from regdb.units import UnitError, unit_named
from regdb.vocabulary import Assumption, Attribute, Fact, FactError, Value
from regdb_compiler import documents
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.parse import place_at
from regdb_compiler.source import SourceFile

VOCABULARY_RULES = (
    ("R110", "bad-jurisdiction", "The jurisdictions are no tree, or one names what is not there."),
    ("R410", "bad-fact", "A fact's declaration does not fit together: unit, values, quiet or assumed value."),
    ("R411", "duplicate-fact", "A fact or attribute is declared twice."),
    ("R412", "bad-attribute", "An attribute bounds or matches a fact that is not there or has the wrong type."),
    ("R420", "bad-state-machine", "A state or super-state leads to one that is not there, or cannot be reached."),
)


def read_fact(name: str, doc: documents.Fact, file: SourceFile) -> tuple[Fact | None, list[Diagnostic]]:
    """One declared fact with its values typed."""
    problem = _shape_problem(doc)
    if problem:
        return None, [_bad(file, "R410", "bad-fact", f"fact `{name}`: {problem}", ("facts", name))]
    bare = Fact(name, doc.type, doc.meaning, doc.source, doc.values, doc.unit)
    try:
        quiet = _quiet(bare, doc.quiet)
        assumption = None
        if isinstance(doc.unknown, documents.Assumed):
            assumed = bare.read(doc.unknown.assume)
            if assumed is None:
                raise FactError("`assume` needs a value")
            assumption = Assumption(assumed, doc.unknown.within, doc.unknown.because)
    except FactError as error:
        return None, [_bad(file, "R410", "bad-fact", f"fact `{name}`: {error}", ("facts", name))]
    phrases: dict[str, tuple[str, ...]] = doc.phrases if isinstance(doc.phrases, dict) else {"": doc.phrases} if doc.phrases else {}
    wrong = [word for word in phrases if word and word not in (*doc.values, "true", "false")]
    if wrong:
        return None, [_bad(file, "R410", "bad-fact", f"fact `{name}`: phrases for {wrong[0]!r}, which is no value of it", ("facts", name))]
    fact = Fact(
        name, doc.type, doc.meaning, doc.source, doc.values, doc.unit, assumption, quiet, phrases, doc.confusables, doc.codes, doc.entails
    )
    return fact, []


_CLASS = re.compile(r"\{([^}]*)\}")


def word_problems(facts: Mapping[str, Fact], words: Mapping[str, tuple[str, ...]], places: Mapping[str, Place]) -> Iterator[Diagnostic]:
    """Phrases that name a class of words nobody declares, and entailed facts that are no boolean facts."""
    for fact in facts.values():
        named = {name for phrases in fact.phrases.values() for phrase in phrases for name in _CLASS.findall(phrase)}
        for name in sorted(named - set(words) - {"n"}):
            near = difflib.get_close_matches(name, words, 1)
            found = Diagnostic("R410", "bad-fact", "error", f"fact `{fact.name}`: no class of words `{name}` is declared", places[fact.name])
            yield replace(found, note=f"did you mean {near[0]}?" if near else "")
        for name in fact.entails:
            if name not in facts or facts[name].kind != "boolean":
                message = f"fact `{fact.name}` entails `{name}`, which is no boolean fact"
                yield Diagnostic("R410", "bad-fact", "error", message, places[fact.name])


def _shape_problem(doc: documents.Fact) -> str:
    if (doc.type in {"enumeration", "set"}) != bool(doc.values):
        return f"{'an' if doc.type == 'enumeration' else 'a'} {doc.type} {'needs' if not doc.values else 'has no'} values"
    if len(set(doc.values)) != len(doc.values):
        return "a value is listed twice"
    if doc.type == "quantity":
        try:
            return "" if unit_named(doc.unit).symbol else "a quantity needs a unit"
        except UnitError as error:
            return str(error)
    return "only quantities have a unit" if doc.unit else ""


def _quiet(fact: Fact, written: Any) -> Value | None:
    if written is not None:
        return fact.read(written)
    if fact.kind == "boolean":
        return False
    if fact.kind == "set":
        return frozenset()
    return "none" if fact.kind == "enumeration" and "none" in fact.values else None


def read_attributes(
    declared: Iterable[tuple[str, documents.Attribute, SourceFile]], facts: dict[str, Fact]
) -> tuple[list[Attribute], list[Diagnostic]]:
    """The attributes, each against the fact it bounds or matches."""
    found, problems = [], []
    for name, doc, file in declared:
        target = doc.quantity if doc.kind == "limit" else doc.fact
        fact = facts.get(target)
        problem = ""
        if fact is None:
            problem = f"names `{target}`, which is no fact"
        elif doc.kind == "limit" and (not fact.is_numeric or not doc.direction):
            problem = "a limit bounds a number and says max or min"
        if problem:
            problems.append(_bad(file, "R412", "bad-attribute", f"attribute `{name}` {problem}", ("attributes", name)))
        else:
            found.append(Attribute(name, doc.kind, target, doc.direction, doc.meaning))
    return found, problems


def read_jurisdictions(doc: documents.JurisdictionsFile, file: SourceFile) -> tuple[JurisdictionTree | None, list[Diagnostic]]:
    """The tree, or why it is none."""
    orphans = [_orphan(name, item.parent, doc, file) for name, item in doc.jurisdictions.items() if item.parent not in (None, *doc.jurisdictions)]
    if orphans:
        return None, orphans
    try:
        return JurisdictionTree(jurisdictions_of(doc)), []
    except JurisdictionError as error:
        return None, [_bad(file, "R110", "bad-jurisdiction", str(error), ("jurisdictions",))]


def _orphan(name: str, parent: str | None, doc: documents.JurisdictionsFile, file: SourceFile) -> Diagnostic:
    near = difflib.get_close_matches(str(parent), doc.jurisdictions, 1)
    found = _bad(file, "R110", "bad-jurisdiction", f"`{name}` names a parent that is not declared", ("jurisdictions", name, "parent"))
    return replace(found, note=f"did you mean {near[0]}?" if near else f"declared: {', '.join(doc.jurisdictions)}")


def jurisdictions_of(doc: documents.JurisdictionsFile) -> list[Jurisdiction]:
    """The jurisdictions of a file, in its order."""
    return [_jurisdiction(name, item) for name, item in doc.jurisdictions.items()]


def _jurisdiction(name: str, doc: documents.Jurisdiction) -> Jurisdiction:
    code = doc.code or name
    style = doc.citation or documents.CitationStyle(short=code.upper())
    governs = doc.governs
    return Jurisdiction(
        name, doc.name, doc.kind, doc.parent, doc.status, code, style.short, style.long, governs.territory, governs.road_owners, doc.source
    )


def read_states(doc: documents.StatesFile, file: SourceFile) -> tuple[StateMachine | None, list[Diagnostic]]:
    """The machine with every transition spelled out, or why it is none."""
    problems = list(_state_problems(doc, file))
    if problems:
        return None, problems
    states, supers = [], []
    for name, item in doc.super_states.items():
        supers.append(SuperState(name, item.meaning, item.prompt, item.next, item.entry, item.exit, item.aliases, item.from_anywhere))
        for short, state in item.states.items():
            following = _next_states(doc, name, short)
            states.append(State(name, short, state.meaning, state.aliases, state.extension, state.prompt or item.prompt, following))
    return StateMachine(supers, states, doc.initial), []


def _next_states(doc: documents.StatesFile, name: str, short: str) -> tuple[str, ...]:
    """Own super-state's successors; at the exit also the entries of the super-states that may follow; emergencies from anywhere."""
    item = doc.super_states[name]
    following = [f"{name}.{target}" for target in item.states[short].next]
    if short == item.exit:
        following += [f"{other}.{doc.super_states[other].entry}" for other in item.next if other != name]
    for other, emergency in doc.super_states.items():
        if emergency.from_anywhere and other != name:
            following += [f"{other}.{target}" for target in emergency.states]
    return tuple(dict.fromkeys(following))


def _state_problems(doc: documents.StatesFile, file: SourceFile) -> Iterator[Diagnostic]:
    def bad(message: str, *path: str) -> Diagnostic:
        return _bad(file, "R420", "bad-state-machine", message, path)

    if doc.initial not in doc.super_states:
        yield bad(f"initial super-state `{doc.initial}` is not declared", "initial")
    for name, item in doc.super_states.items():
        for other in item.next:
            if other not in doc.super_states:
                yield bad(f"`{name}` leads to super-state `{other}`, which is not declared", "super_states", name, "next")
        for role, door in (("entry", item.entry), ("exit", item.exit)):
            if door not in item.states:
                yield bad(f"the {role} of `{name}`, `{door}`, is none of its states", "super_states", name, role)
        lost = [(short, target) for short, state in item.states.items() for target in state.next if target not in item.states]
        for short, target in lost:
            yield bad(f"`{name}.{short}` leads to `{target}`, which is no state of `{name}`", "super_states", name, "states", short, "next")
        if not lost and item.entry in item.states and item.exit in item.states:
            yield from (bad(message, "super_states", name, "states", short) for short, message in _cut_off(name, item))


def _cut_off(name: str, item: documents.SuperState) -> Iterator[tuple[str, str]]:
    """States that cannot be reached from the entry, or from which the exit cannot be reached, each with the sentence that says so."""
    reached = _reachable(item, [item.entry])
    for short in item.states:
        if short not in reached:
            yield short, f"`{name}.{short}` cannot be reached from the entry, `{item.entry}`"
        elif item.exit not in _reachable(item, [short]):
            yield short, f"`{name}.{short}` has no way to the exit, `{item.exit}`"


def _reachable(item: documents.SuperState, start: list[str]) -> set[str]:
    """The states of a super-state that can be reached from these, themselves included."""
    found: set[str] = set()
    while start:
        short = start.pop()
        if short in item.states and short not in found:
            found.add(short)
            start += item.states[short].next
    return found


def _bad(file: SourceFile, code: str, rule: str, message: str, path: tuple[str, ...]) -> Diagnostic:
    assert file.root is not None
    place = place_at(file.root, path)
    if place.end_line != place.line:
        place = type(place)(place.path, place.line, place.column, place.line, place.column + 1)
    return Diagnostic(code, rule, "error", message, place)
