"""Rows of the database as objects: vocabulary, states, jurisdictions, and every regulation, read once and checked."""

from __future__ import annotations

import datetime
import json
import sqlite3
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

from regdb.condition import TRUE
from regdb.jurisdiction import Jurisdiction, JurisdictionError, JurisdictionTree
from regdb.regulation import Limit, Regulation
from regdb.states import State, StateMachine, SuperState
from regdb.vocabulary import KINDS, Assumption, Attribute, Fact, Value, Vocabulary
from regdb_runtime.errors import DatabaseDamaged
from regdb_runtime.rows_conditions import ConditionReader

_REGULATION = (
    "key, id, citation, jurisdiction, legality, effective, until, when_tree, unless_tree, force, authority, title, topic, tags, "
    "condition, result, quote, vagueness, vague_because, confidence"
)


def read_meta(connection: sqlite3.Connection) -> dict[str, str]:
    """What the database says of itself."""
    return dict(connection.execute("SELECT key, value FROM regdb_meta"))


def read_vocabulary(connection: sqlite3.Connection) -> Vocabulary:
    """Every fact and attribute. Raises DatabaseDamaged."""
    columns = "name, kind, meaning, source, words, unit, assumed, assumed_within, assumed_because, quiet, phrases, confusables, codes"
    facts = [_fact(*row) for row in connection.execute(f"SELECT {columns} FROM fact ORDER BY rowid")]
    attributes = connection.execute("SELECT name, kind, fact, direction, meaning FROM attribute ORDER BY rowid")
    return Vocabulary(facts, (Attribute(*row) for row in attributes))


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


def read_tree(connection: sqlite3.Connection) -> JurisdictionTree:
    """The tree of jurisdictions. Raises DatabaseDamaged."""
    columns = "id, name, kind, parent, status, code, short, long, territory, road_owners, source"
    rows = connection.execute(f"SELECT {columns} FROM jurisdiction ORDER BY rowid")
    items = [
        Jurisdiction(place, name, kind, parent, status, code, short, long, tuple(json.loads(land)), tuple(json.loads(owners)), source)
        for place, name, kind, parent, status, code, short, long, land, owners, source in rows
    ]
    try:
        return JurisdictionTree(items)
    except JurisdictionError as error:
        raise DatabaseDamaged(str(error)) from error


def read_machine(connection: sqlite3.Connection) -> StateMachine:
    """The state machine; a state's `next` are the ids of the full transition relation. Raises DatabaseDamaged."""
    following: dict[str, list[str]] = {}
    for current, after in connection.execute("SELECT current, next FROM transition ORDER BY rowid"):
        following.setdefault(current, []).append(after)
    states = [
        State(super_state, name, meaning, tuple(json.loads(aliases)), bool(extension), prompt, tuple(following.get(state_id, ())))
        for state_id, super_state, name, meaning, aliases, extension, prompt in connection.execute(
            "SELECT id, super_state, name, meaning, aliases, extension, prompt FROM state ORDER BY position"
        )
    ]
    rows = connection.execute(
        "SELECT name, meaning, prompt, next, entry, exit, aliases, from_anywhere, initial FROM super_state ORDER BY position"
    ).fetchall()
    if not rows:
        raise DatabaseDamaged("the database has no states")
    supers = [
        SuperState(name, meaning, prompt, tuple(json.loads(after)), entry, leave, tuple(json.loads(aliases)), bool(anywhere))
        for name, meaning, prompt, after, entry, leave, aliases, anywhere, _ in rows
    ]
    return StateMachine(supers, states, next((row[0] for row in rows if row[8]), rows[0][0]))


def read_regulations(connection: sqlite3.Connection, vocabulary: Vocabulary) -> tuple[Regulation, ...]:
    """Every regulation in every version, in the order of the rows. Raises DatabaseDamaged."""
    rows = connection.execute(f"SELECT {_REGULATION} FROM regulation ORDER BY key").fetchall()
    reader = ConditionReader(vocabulary.facts)
    whens = reader.trees([row[7] for row in rows])
    unlesses = reader.trees([row[8] for row in rows])
    limits = _limits(connection, reader)
    states = _states(connection)
    targets = _grouped(connection.execute("SELECT regulation, target, kind FROM regulation_target ORDER BY regulation, position"))
    found = []
    for row, when, unless in zip(rows, whens, unlesses, strict=True):
        key = row[0]
        aimed = targets.get(key, ())
        found.append(
            Regulation(
                row[1], row[2], row[3], bool(row[4]), day_of(row[5]), day_of(row[6]), TRUE if when is None else when, unless,
                tuple(limits.get(key, ())), row[9], states.get((key, "current")), states.get((key, "next")),
                tuple(dict.fromkeys([target for target, _ in aimed])), tuple([target for target, kind in aimed if kind == "overrides"]),
                row[10], row[11], row[12], _words(row[13]), *row[14:],
            )
        )  # fmt: skip
    return tuple(found)


def _limits(connection: sqlite3.Connection, reader: ConditionReader) -> dict[int, list[Limit]]:
    rows = connection.execute(
        "SELECT regulation, attribute, fact, direction, bound, unit, law_text FROM regulation_limit ORDER BY regulation, position"
    ).fetchall()
    found: dict[int, list[Limit]] = {}
    for row, bound in zip(rows, reader.linears([row[4] for row in rows]), strict=True):
        found.setdefault(row[0], []).append(Limit(row[1], row[2], row[3], bound, row[5], row[6]))
    return found


def _states(connection: sqlite3.Connection) -> dict[tuple[int, str], frozenset[str]]:
    """(regulation, role) -> state ids; equal sets are one object."""
    sets: dict[tuple[int, str], list[str]] = {}
    for key, role, state in connection.execute("SELECT regulation, role, state FROM regulation_state ORDER BY regulation, role, state"):
        sets.setdefault((key, role), []).append(state)
    shared: dict[tuple[str, ...], frozenset[str]] = {}
    return {place: shared.setdefault(tuple(ids), frozenset(ids)) for place, ids in sets.items()}


def _grouped(rows: Iterable[tuple[Any, ...]]) -> dict[int, list[tuple[Any, ...]]]:
    found: dict[int, list[tuple[Any, ...]]] = {}
    for row in rows:
        found.setdefault(row[0], []).append(row[1:])
    return found


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
