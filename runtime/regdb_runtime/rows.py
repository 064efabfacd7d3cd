"""Rows of the database as objects: vocabulary, states, jurisdictions, and every regulation, read once and checked."""

from __future__ import annotations

import datetime
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, TypeVar

from regdb.condition import TRUE
from regdb.content_hash import Table
from regdb.interpretation import FORMULAS, Decision, Interpretation, Parameter
from regdb.jurisdiction import Jurisdiction, JurisdictionError, JurisdictionTree
from regdb.regulation import Limit, Regulation
from regdb.states import State, StateMachine, SuperState
from regdb.vocabulary import KINDS, Assumption, Attribute, Fact, Value, Vocabulary
from regdb_runtime.errors import DatabaseDamaged
from regdb_runtime.rows_conditions import ConditionReader
from regdb_runtime.rows_fusion import read_fusion

_FACT = (
    "name", "kind", "meaning", "source", "words", "unit", "assumed", "assumed_within", "assumed_because", "quiet", "phrases",
    "confusables", "codes",
)  # fmt: skip
_JURISDICTION = ("id", "name", "kind", "parent", "status", "code", "short", "long", "territory", "road_owners", "source")
_SUPER_STATE = ("name", "meaning", "prompt", "next", "entry", "exit", "aliases", "from_anywhere", "initial")
_INTERPRETATION = ("name", "title", "meaning", "source_url", "source_also", "checked", "confidence", "note")
_DECISION = ("interpretation", "fact", "formula", "true_when", "parameters", "because", "source")
_STATE = ("id", "super_state", "name", "meaning", "aliases", "extension", "prompt")


_Item = TypeVar("_Item")
Tables = Mapping[str, Table]


def read_meta(tables: Tables) -> dict[str, str]:
    """What the database says of itself."""
    return dict(tables["regdb_meta"].select("key", "value"))


def read_vocabulary(tables: Tables) -> Vocabulary:
    """Every fact and attribute. Raises DatabaseDamaged."""
    lexicon = {(kind, name): tuple(json.loads(entries)) for kind, name, entries in _lexicon(tables)}
    facts = [replace(_fact(*row), entails=lexicon.get(("entails", row[0]), ())) for row in tables["fact"].select(*_FACT)]
    policies = read_fusion(tables)
    facts = [replace(fact, fusion=policies[fact.name]) if fact.name in policies else fact for fact in facts]
    attributes = tables["attribute"].select("name", "kind", "fact", "direction", "meaning")
    return Vocabulary(facts, (Attribute(*row) for row in attributes), {name: members for (kind, name), members in lexicon.items() if kind == "words"})


def _lexicon(tables: Tables) -> Iterator[tuple[str, str, str]]:
    """Rows of the lexicon; none in a file of an earlier minor."""
    return tables["lexicon"].select("kind", "name", "entries") if "lexicon" in tables else iter(())


def _fact(
    name: str, kind: str, meaning: str, source: str, words: str, unit: str, assumed: str | None, within: str, because: str,
    quiet: str | None, phrases: str, confusables: str, codes: str,
) -> Fact:  # fmt: skip
    if kind not in KINDS:
        raise DatabaseDamaged(f"the fact {name!r} is of a kind {kind!r} that there is not")
    assumption = None if assumed is None else Assumption(_value(name, kind, assumed), within, because)
    said = {word: tuple(texts) for word, texts in json.loads(phrases).items()}
    return Fact(
        name, kind, meaning, source, tuple(json.loads(words)), unit, assumption,
        None if quiet is None else _value(name, kind, quiet), said, tuple(json.loads(confusables)), json.loads(codes),
    )  # fmt: skip


def _value(name: str, kind: str, text: str) -> Value:
    """A stored value as the fact's type: JSON in SI."""
    data: Any = json.loads(text)
    if kind == "set" and isinstance(data, list):
        return frozenset(data)
    expected = {"boolean": (bool,), "enumeration": (str,)}.get(kind, (int, float))
    if kind == "set" or type(data) not in expected:
        raise DatabaseDamaged(f"{text} cannot stand for the fact {name!r}, which is a {kind}")
    found: Value = data
    return found


def read_tree(tables: Tables) -> JurisdictionTree:
    """The tree of jurisdictions. Raises DatabaseDamaged."""
    items = [
        Jurisdiction(place, name, kind, parent, status, code, short, long, tuple(json.loads(land)), tuple(json.loads(owners)), source)
        for place, name, kind, parent, status, code, short, long, land, owners, source in tables["jurisdiction"].select(*_JURISDICTION)
    ]
    try:
        return JurisdictionTree(items)
    except JurisdictionError as error:
        raise DatabaseDamaged(str(error)) from error


def read_machine(tables: Tables) -> StateMachine:
    """The state machine; a state's `next` are the ids of the full transition relation. Raises DatabaseDamaged."""
    rows = list(_placed(tables["state"], _STATE))
    places = {row[0]: place for place, row in enumerate(rows)}
    following: dict[str, list[str]] = {}
    for current, after in tables["transition"].select("current", "next"):
        following.setdefault(current, []).append(after)
    states = []
    for state_id, super_state, name, meaning, aliases, extension, prompt in rows:
        after = tuple(sorted(following.get(state_id, ()), key=places.__getitem__))
        states.append(State(super_state, name, meaning, tuple(json.loads(aliases)), bool(extension), prompt, after))
    if not rows:
        raise DatabaseDamaged("the database has no states")
    supers, initial = _super_states(tables)
    return StateMachine(supers, states, initial)


def _super_states(tables: Tables) -> tuple[list[SuperState], str]:
    found, initial = [], ""
    for name, meaning, prompt, after, entry, leave, aliases, anywhere, first in _placed(tables["super_state"], _SUPER_STATE):
        words = tuple(json.loads(after)), entry, leave, tuple(json.loads(aliases))
        found.append(SuperState(name, meaning, prompt, *words, bool(anywhere)))
        initial = name if first or not initial else initial
    return found, initial


def _placed(table: Table, columns: tuple[str, ...]) -> Iterator[tuple[Any, ...]]:
    """These columns of every row, in the order of the column `position`."""
    return (row[1:] for row in sorted(table.select("position", *columns), key=lambda row: row[0]))


def read_regulations(tables: Tables, vocabulary: Vocabulary) -> tuple[Regulation, ...]:
    """Every regulation in every version, in the order of the rows. Raises DatabaseDamaged."""
    rows = tables["regulation"]
    reader = ConditionReader(vocabulary.facts)
    keys = rows["key"]
    whens = [TRUE if tree is None else tree for tree in reader.trees(rows["when_tree"])]
    limits, states = _limits(tables, reader), _states(tables)
    pairs = tables["regulation_target"].select("regulation", "target")
    aimed: dict[int, tuple[str, ...]] = _grouped((key, target) for key, target in pairs)
    named = tables["regulation_target"].select("regulation", "target", "kind")
    overridden: dict[int, tuple[str, ...]] = _grouped((key, target) for key, target, kind in named if kind == "overrides")
    current, following = states["current"], states["next"]
    columns = (
        rows["id"], rows["citation"], rows["jurisdiction"], map(bool, rows["legality"]), map(day_of, rows["effective"]),
        map(day_of, rows["until"]), whens, reader.trees(rows["unless_tree"]), [limits.get(key, ()) for key in keys], rows["force"],
        map(current.get, keys), map(following.get, keys), [aimed.get(key, ()) for key in keys],
        [overridden.get(key, ()) for key in keys], rows["authority"], rows["title"], rows["topic"], map(_words, rows["tags"]),
        rows["condition"], rows["result"], rows["quote"], rows["vagueness"], rows["vague_because"], rows["confidence"],
    )  # fmt: skip
    return tuple(map(Regulation, *columns))


def _limits(tables: Tables, reader: ConditionReader) -> dict[int, tuple[Limit, ...]]:
    rows = tables["regulation_limit"]
    bounds = reader.linears(rows["bound"])
    limits = map(Limit, rows["attribute"], rows["fact"], rows["direction"], bounds, rows["unit"], rows["law_text"])
    return _grouped(zip(rows["regulation"], limits, strict=True))


def _states(tables: Tables) -> dict[str, dict[int, frozenset[str]]]:
    """Role -> regulation -> state ids; equal sets are one object. Rows come in that order, so each set is one run of rows."""
    found: dict[str, dict[int, frozenset[str]]] = {"current": {}, "next": {}}
    shared: dict[tuple[str, ...], frozenset[str]] = {}
    run: list[str] = []
    last_key, last_role = -1, ""
    for key, role, state in (*tables["regulation_state"].select("regulation", "role", "state"), (-1, "", "")):
        if key != last_key or role != last_role:
            if run:
                ids = tuple(run)
                found[last_role][last_key] = shared.get(ids) or shared.setdefault(ids, frozenset(ids))
            run, last_key, last_role = [], key, role
        run.append(state)
    return found


def _grouped(rows: Iterable[tuple[int, _Item]]) -> dict[int, tuple[_Item, ...]]:
    """Regulation -> what its rows hold, in their order."""
    found: dict[int, list[_Item]] = {}
    for key, item in rows:
        found.setdefault(key, []).append(item)
    return {key: tuple(items) for key, items in found.items()}


def read_interpretations(tables: Tables) -> dict[str, Interpretation]:
    """Every profile by name; none in a file of a schema that had none. Raises DatabaseDamaged for a formula that is not known."""
    if "interpretation" not in tables:
        return {}
    decisions: dict[str, dict[str, Decision]] = {}
    for profile, fact, formula, true_when, parameters, because, source in tables["interpretation_rule"].select(*_DECISION):
        if formula and formula not in FORMULAS:
            raise DatabaseDamaged(f"the interpretation {profile!r} decides {fact!r} by {formula!r}, a formula that this runtime lacks")
        numbers = {name: Parameter(item["text"], float(item["si"])) for name, item in json.loads(parameters).items()}
        decisions.setdefault(profile, {})[fact] = Decision(fact, formula, numbers, true_when, because, source)
    return {
        name: Interpretation(name, title, meaning, url, tuple(json.loads(also)), checked, confidence, note, decisions.get(name, {}))
        for name, title, meaning, url, also, checked, confidence, note in tables["interpretation"].select(*_INTERPRETATION)
    }


@lru_cache(maxsize=4096)
def day_of(text: str | None) -> int | None:
    """The day number of a stored date, None where it is open. Raises DatabaseDamaged."""
    try:
        return None if text is None else datetime.date.fromisoformat(text).toordinal()
    except ValueError as error:
        raise DatabaseDamaged(f"{text!r} is no date") from error


@lru_cache(maxsize=4096)
def _words(text: str) -> tuple[str, ...]:
    return tuple(json.loads(text)) if text else ()


def check_defeat(regulations: Iterable[Regulation]) -> None:
    """Raise DatabaseDamaged when regulations in force together defeat each other in a circle."""
    aimed = {rule.id for rule in regulations for _ in rule.targets[:1]}
    versions: dict[str, list[Regulation]] = {}
    for rule in regulations:
        if rule.id in aimed:
            versions.setdefault(rule.id, []).append(rule)
    done: set[int] = set()
    for rule in [rule for group in versions.values() for rule in group]:
        _walk(rule, versions, done)


def _walk(start: Regulation, versions: dict[str, list[Regulation]], done: set[int]) -> None:
    """Depth first without recursion, so that a long chain is no error."""
    path: dict[int, Regulation] = {id(start): start}
    stack: list[tuple[Regulation, Iterator[Regulation]]] = [(start, _defeated(start, versions))]
    while stack:
        rule, following = stack[-1]
        target = next((other for other in following if id(other) not in done), None)
        if target is None:
            stack.pop()
            path.pop(id(rule), None)
            done.add(id(rule))
        elif id(target) in path:
            raise DatabaseDamaged(f"{target.id} and {rule.id} defeat each other in a circle")
        else:
            path[id(target)] = target
            stack.append((target, _defeated(target, versions)))


def _defeated(rule: Regulation, versions: dict[str, list[Regulation]]) -> Iterator[Regulation]:
    return (other for target in rule.targets for other in versions.get(target, ()) if _together(rule, other))


def _together(one: Regulation, other: Regulation) -> bool:
    """Whether two versions are in force on a common day."""
    return (one.until is None or other.effective is None or other.effective < one.until) and (
        other.until is None or one.effective is None or one.effective < other.until
    )
