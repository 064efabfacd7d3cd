"""The two sides of a comparison: a date, a jurisdiction, a folder or a database, each read as items of one form."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from regdb.front import FrontError
from regdb.schema import APPLICATION_ID

FIELDS = (
    "citation", "legality", "condition", "when", "unless", "result", "force", "states", "displaces", "authority", "requires_sign",
    "applies_to", "quote", "vagueness", "topic", "effective", "until",
)  # fmt: skip
"""Compared fields in the order shown; each limit and scope attribute is a field of its own, before them."""


@dataclass(frozen=True)
class Item:
    """One regulation as compared: its id, citation, topic and jurisdiction, and field -> text (empty fields left out)."""

    id: str
    citation: str
    topic: str
    jurisdiction: str
    permission: bool
    fields: Mapping[str, str]
    limits: Mapping[str, tuple[str, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Side:
    """One side: how it is named, and its items sorted by id and date."""

    name: str
    items: tuple[Item, ...]


def read_items(database: Path, *, on: str | None = None, jurisdictions: frozenset[str] | None = None) -> tuple[Item, ...]:
    """The regulations of a database, those in force on a day if one is given. Raises FrontError for what is no database of ours."""
    try:
        with sqlite3.connect(f"{database.resolve().as_uri()}?mode=ro", uri=True) as connection:
            connection.row_factory = sqlite3.Row
            if connection.execute("PRAGMA application_id").fetchone()[0] != APPLICATION_ID:
                raise FrontError(f"{database} is no regdb database")
            limits, targets = _limits(connection), _targets(connection)
            rows = connection.execute("SELECT * FROM regulation ORDER BY id, coalesce(effective, '')").fetchall()
    except sqlite3.DatabaseError as error:
        raise FrontError(f"{database} cannot be read as a database: {error}") from error
    kept = [row for row in rows if _in_force(row, on) and (jurisdictions is None or row["jurisdiction"] in jurisdictions)]
    return tuple(_item(row, limits.get(row["key"], {}), targets.get(row["key"], ())) for row in kept)


def jurisdiction_paths(database: Path) -> dict[str, frozenset[str]]:
    """Jurisdiction id and code name -> ids from the root down to it."""
    with sqlite3.connect(f"{database.resolve().as_uri()}?mode=ro", uri=True) as connection:
        parents = {row[0]: (row[1], row[2]) for row in connection.execute("SELECT id, parent, code FROM jurisdiction")}
    paths: dict[str, frozenset[str]] = {}
    for name, (_, code) in parents.items():
        path, step = set(), name
        while step is not None:
            path.add(step)
            step = parents[step][0]
        paths[name] = paths[code] = frozenset(path)
    return paths


def _in_force(row: sqlite3.Row, on: str | None) -> bool:
    return on is None or ((row["effective"] or "") <= on and (row["until"] is None or on < row["until"]))


def _limits(connection: sqlite3.Connection) -> dict[int, dict[str, tuple[str, float]]]:
    found: dict[int, dict[str, tuple[str, float]]] = {}
    for key, attribute, direction, si in connection.execute("SELECT regulation, attribute, direction, si FROM regulation_limit"):
        if si is not None:
            found.setdefault(key, {})[attribute] = (direction, si)
    return found


def _targets(connection: sqlite3.Connection) -> dict[int, tuple[str, ...]]:
    found: dict[int, tuple[str, ...]] = {}
    for key, target in connection.execute("SELECT regulation, target FROM regulation_target ORDER BY regulation, target"):
        found[key] = (*found.get(key, ()), target)
    return found


def _item(row: sqlite3.Row, limits: Mapping[str, tuple[str, float]], targets: tuple[str, ...]) -> Item:
    fields = {name: str(text) for name, text in json.loads(row["attributes"]).items()}
    texts = {
        "citation": row["citation"],
        "legality": "permitted" if row["legality"] else "forbidden",
        "condition": row["condition"],
        "when": row["when_text"],
        "unless": row["unless_text"],
        "result": row["result"],
        "force": row["force"],
        "states": _states(row),
        "displaces": ", ".join(targets),
        "authority": row["authority"],
        "requires_sign": row["requires_sign"],
        "applies_to": ", ".join(json.loads(row["applies_to"])) if row["applies_to"].startswith("[") else row["applies_to"],
        "quote": row["quote"],
        "vagueness": str(row["vagueness"]),
        "topic": row["topic"],
        "effective": row["effective"] or "",
        "until": row["until"] or "",
    }
    fields.update((name, texts[name]) for name in FIELDS if texts[name])
    return Item(row["id"], row["citation"], row["topic"], row["jurisdiction"], bool(row["legality"]), fields, limits)


def _states(row: sqlite3.Row) -> str:
    if not row["current_states"] and not row["next_states"]:
        return ""
    return f"{row['current_states'] or 'any'} -> {row['next_states'] or 'any'}"
