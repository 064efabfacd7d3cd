"""What `regdb show` shows, as data: a regulation, section, fact, state or other name with everything that hangs on it."""

from __future__ import annotations

import json
from typing import Any

from regdb.interpretation import FORMULAS
from regdb_compiler.emit.table import read_lines, typed
from regdb_compiler.library import Found, Library

Data = dict[str, Any]


def shown(library: Library, found: Found, day: str) -> Data:
    """`{shows: <kind>, ...}` for what was found, as of a day in ISO text."""
    if found.kind == "regulation":
        return _law(library, found, day, [_regulation(library, name, day) for name in found.names])
    if found.kind == "section":
        rules = [_regulation(library, name, day) for section in found.names for name in _ids(library, section, day)]
        return _law(library, found, day, rules, sections=found.names)
    return {"shows": found.kind, **_LANGUAGE[found.kind](library, found.names[0])}


def in_force(item: Data, day: str) -> bool:
    """Whether something with `effective` and `until` is in force on a day."""
    return (item["effective"] or "") <= day and (item["until"] is None or day < item["until"])


def _law(library: Library, found: Found, day: str, rules: list[Data], sections: tuple[str, ...] = ()) -> Data:
    names = sections or tuple(dict.fromkeys(rule["section"] for rule in rules))
    return {"shows": found.kind, "on": day, "regulations": rules, "sections": [_section(library, name, day) for name in names]}


def _ids(library: Library, section: str, day: str) -> list[str]:
    """Regulations of the section's version of that day."""
    version = _version(library, section, day)
    return [] if version is None else library.column("SELECT id FROM regulation WHERE section_version = ? ORDER BY key", version["key"])


def _version(library: Library, section: str, day: str) -> Data | None:
    """The version in force on the day, else the nearest before it, else the first."""
    names = ("key", "effective", "until", "enacted_by", "text")
    query = f"SELECT {', '.join(names)} FROM section_version WHERE section = ? ORDER BY effective"
    versions = [dict(zip(names, row, strict=True)) for row in library.connection.execute(query, (section,))]
    return _of_day(versions, day)


def _of_day(versions: list[Data], day: str) -> Data | None:
    current = [item for item in versions if in_force(item, day)]
    past = [item for item in versions if (item["effective"] or "") <= day]
    return next(iter(current or past[-1:] or versions[:1]), None)


def _regulation(library: Library, name: str, day: str) -> Data:
    """The version of the day, with what displaces it, what it displaces, and the dates of its other versions."""
    versions = [typed(line) for line in read_lines(library.connection, "r.id = ?", (name,))]
    rule = _of_day(versions, day)
    assert rule is not None  # the name was found in the same database
    rule.pop("text")
    displaced = library.connection.execute(
        "SELECT DISTINCT overriding, kind FROM overrides_of WHERE overridden = ? AND coalesce(effective, '') <= ? "
        "AND (until IS NULL OR ? < until)",
        (name, day, day),
    )
    dates = [{"effective": item["effective"], "until": item["until"]} for item in versions]
    return {**rule, "in_force": in_force(rule, day), "displaced_by": [{"id": i, "kind": k} for i, k in displaced], "versions": dates}


def _section(library: Library, name: str, day: str) -> Data:
    columns = (
        "id", "jurisdiction", "citation", "title", "location", "topic", "source_url", "source_also", "checked", "confidence", "note",
    )  # fmt: skip
    row = library.connection.execute(f"SELECT {', '.join(columns)} FROM section WHERE id = ?", (name,)).fetchone()
    data: Data = dict(zip(columns, row, strict=True))
    for column in ("location", "source_also"):
        data[column] = json.loads(data[column])
    version = _version(library, name, day) or {"key": 0, "effective": None, "until": None, "enacted_by": "", "text": ""}
    key = version.pop("key")
    query = "SELECT effective, until FROM section_version WHERE section = ? ORDER BY effective"
    dates = [{"effective": first, "until": end} for first, end in library.connection.execute(query, (name,))]
    data |= {**version, "in_force": in_force(version, day), "versions": dates}
    data["definitions"] = _lines(library, "definition", ("name", "when_text", "quote"), key)
    data["delegations"] = _lines(
        library, "delegation",
        ("kinds", "attribute", "direction", "least", "most", "allowed", "targets", "sign", "not_on", "condition"), key,
    )  # fmt: skip
    return data


def _lines(library: Library, table: str, columns: tuple[str, ...], key: int) -> list[Data]:
    query = f"SELECT {', '.join(columns)} FROM {table} WHERE section_version = ? ORDER BY key"
    return [_decoded(dict(zip(columns, row, strict=True))) for row in library.connection.execute(query, (key,))]


def _decoded(data: Data) -> Data:
    """Columns that hold JSON lists or objects as such; flags as truth."""
    lists = {"kinds", "allowed", "targets", "not_on", "words", "phrases", "confusables", "codes", "aliases", "next"}
    lists |= {"territory", "road_owners"}
    for name, value in data.items():
        if name in lists:
            data[name] = json.loads(value)
        elif name in {"sign", "extension", "from_anywhere", "initial"}:
            data[name] = bool(value)
    return data


def _row(library: Library, table: str, column: str, name: str) -> Data:
    cursor = library.connection.execute(f"SELECT * FROM {table} WHERE {column} = ?", (name,))
    row = cursor.fetchone()
    return _decoded({item[0]: value for item, value in zip(cursor.description, row, strict=True)})


def _fact(library: Library, name: str) -> Data:
    data = _row(library, "fact", "name", name)
    for column in ("assumed", "quiet"):
        data[column] = None if data[column] is None else json.loads(data[column])
    quoted = f'%"{name}"%'
    readers = library.column(
        "SELECT DISTINCT r.id FROM regulation r LEFT JOIN regulation_limit l ON l.regulation = r.key "
        "WHERE r.when_tree LIKE ? OR r.unless_tree LIKE ? OR l.bound LIKE ? OR l.fact = ? ORDER BY r.key",
        quoted, quoted, quoted, name,
    )  # fmt: skip
    return {**data, "read_by": readers}


def _attribute(library: Library, name: str) -> Data:
    used = library.column("SELECT DISTINCT id FROM regulation WHERE json_extract(attributes, '$.' || ?) IS NOT NULL ORDER BY key", name)
    return {**_row(library, "attribute", "name", name), "used_by": used}


def _definition(library: Library, name: str) -> Data:
    columns = ("name", "when_text", "quote", "section", "citation", "effective", "until")
    rows = library.connection.execute(
        "SELECT d.name, d.when_text, d.quote, s.id, s.citation, v.effective, v.until FROM definition d "
        "JOIN section_version v ON v.key = d.section_version JOIN section s ON s.id = v.section WHERE d.name = ? ORDER BY d.key",
        (name,),
    )
    return {"name": name, "definitions": [dict(zip(columns, row, strict=True)) for row in rows]}


def _jurisdiction(library: Library, name: str) -> Data:
    item = library.tree.get(name)
    data = _row(library, "jurisdiction", "id", item.id)
    counts = [library.column(f"SELECT count(*) FROM {table} WHERE jurisdiction = ?", item.id)[0] for table in ("section", "regulation")]
    path = [step.id for step in library.tree.path(item.id)]
    return {**data, "path": path, "sections": counts[0], "regulations": counts[1]}


def _topic(library: Library, name: str) -> Data:
    query = "SELECT DISTINCT id, citation, condition, result FROM regulation WHERE topic = ? ORDER BY key"
    rules = [dict(zip(("id", "citation", "condition", "result"), row, strict=True)) for row in library.connection.execute(query, (name,))]
    return {"name": name, "sections": library.column("SELECT id FROM section WHERE topic = ? ORDER BY rowid", name), "regulations": rules}


def _state(library: Library, name: str) -> Data:
    """A super-state by its name or alias, else every state the word names."""
    aliased = "name = ? OR EXISTS (SELECT 1 FROM json_each(aliases) WHERE value = ?)"
    supers = library.column(f"SELECT name FROM super_state WHERE {aliased}", name, name)
    ids = library.column(f"SELECT id FROM state WHERE id = ? OR {aliased} ORDER BY position", name, name, name)
    return {
        "name": name,
        "super_states": [_super_state(library, item) for item in supers],
        "states": [_one_state(library, item) for item in ids],
    }


def _super_state(library: Library, name: str) -> Data:
    inside = library.column("SELECT id FROM state WHERE super_state = ? ORDER BY position", name)
    return {**_row(library, "super_state", "name", name), "states": inside}


def _one_state(library: Library, name: str) -> Data:
    after = library.column("SELECT next FROM transition WHERE current = ? ORDER BY rowid", name)
    before = library.column("SELECT current FROM transition WHERE next = ? ORDER BY rowid", name)
    about = "SELECT DISTINCT r.id FROM regulation_state s JOIN regulation r ON r.key = s.regulation WHERE s.state = ? AND s.role = ?"
    rules = {role: library.column(about + " ORDER BY r.key", name, role) for role in ("current", "next")}
    return {**_row(library, "state", "id", name), "next": after, "previous": before, "regulations": rules}


def _interpretation(library: Library, name: str) -> Data:
    """A profile with its rules, each with what its formula measures and the regulations that read its fact."""
    columns = ("fact", "formula", "true_when", "parameters", "because", "source")
    rows = library.connection.execute(
        f"SELECT {', '.join(columns)} FROM interpretation_rule WHERE interpretation = ? ORDER BY fact", (name,)
    )
    rules = [dict(zip(columns, row, strict=True)) for row in rows]
    for rule in rules:
        formula = FORMULAS.get(rule["formula"])
        rule["parameters"] = json.loads(rule["parameters"])
        rule["formula_meaning"] = formula.meaning if formula else ""
        rule["measures"] = [f"{measure} ({dimension})" for measure, dimension in formula.measures.items()] if formula else []
        rule["read_by"] = _fact(library, rule["fact"])["read_by"]
    data = _row(library, "interpretation", "name", name)
    return {**data, "source_also": json.loads(data["source_also"]), "rules": rules}


def _machine(library: Library, _: str) -> Data:
    """The state machine whole: super-states with their states and what may follow each."""
    machine = library.machine
    supers = [_super_state(library, name) for name in machine.super_states]
    states = [
        {"id": state.id, "meaning": state.meaning, "extension": state.extension, "next": list(state.next)} for state in machine.states.values()
    ]
    return {"initial": machine.initial, "super_states": supers, "states": states}


_LANGUAGE = {
    "fact": _fact, "attribute": _attribute, "definition": _definition, "jurisdiction": _jurisdiction, "topic": _topic, "state": _state,
    "interpretation": _interpretation, "machine": _machine,
}  # fmt: skip
