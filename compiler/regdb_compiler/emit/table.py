"""The database read back as one flat table: a line per regulation version, with its section, limits, states and targets."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Row = tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Column:
    """A column: its name, where it comes from in SQL, its Frictionless type, and what it means."""

    name: str
    source: str
    kind: str
    meaning: str


def _states(role: str) -> str:
    return (
        "(SELECT json_group_array(state) FROM (SELECT state FROM regulation_state s "
        f"WHERE s.regulation = r.key AND s.role = '{role}' ORDER BY state))"
    )


def _targets(kind: str) -> str:
    return (
        "(SELECT json_group_array(target) FROM (SELECT target FROM regulation_target t "
        f"WHERE t.regulation = r.key AND t.kind = '{kind}' ORDER BY position))"
    )


_LIMITS = (
    "(SELECT json_group_array(json_object('attribute', attribute, 'fact', fact, 'direction', direction, 'value', value, "
    "'unit', unit, 'si', si, 'text', law_text)) FROM (SELECT * FROM regulation_limit l WHERE l.regulation = r.key ORDER BY position))"
)

COLUMNS = (
    Column("id", "r.id", "string", "Identifier, the same in every version."),
    Column("citation", "r.citation", "string", "As cited: CVC 21453(a)."),
    Column("jurisdiction", "r.jurisdiction", "string", "Who made it."),
    Column("section", "v.section", "string", "The section it stands in."),
    Column("title", "r.title", "string", "The section's title."),
    Column("location", "s.location", "array", "Where the section stands in its code."),
    Column("topic", "r.topic", "string", "Aligns sections of different codes."),
    Column("effective", "r.effective", "date", "First day in force."),
    Column("until", "r.until", "date", "First day no longer in force; empty while open."),
    Column("enacted_by", "v.enacted_by", "string", "The act that made this version."),
    Column("legality", "r.legality", "boolean", "FALSE: unlawful while the condition holds or beyond its limits; TRUE: a permission."),
    Column("condition", "r.condition", "string", "The condition in words."),
    Column("when", "r.when_text", "string", "The condition in the condition language."),
    Column("unless", "r.unless_text", "string", "What suspends it, in the condition language."),
    Column("result", "r.result", "string", "What then follows."),
    Column("force", "r.force", "string", "Kind of limit: absolute, prima_facie, basic, penalty_tier or advisory."),
    Column("attributes", "r.attributes", "object", "Attributes as written: limits and scope."),
    Column("limits", _LIMITS, "array", "Limits with the law's own value and unit, and in SI; null where a fact stands for the number."),
    Column("current_states", "r.current_states", "string", "Possible current states in words; empty for every state."),
    Column("next_states", "r.next_states", "string", "Possible next states in words; empty for every state."),
    Column("current_state_ids", _states("current"), "array", "The current states by id, super-states expanded."),
    Column("next_state_ids", _states("next"), "array", "The next states by id, super-states expanded."),
    Column("exception_to", _targets("exception_to"), "array", "Regulations of the same code that it displaces."),
    Column("overrides", _targets("overrides"), "array", "Regulations of an ancestor jurisdiction that it displaces."),
    Column("authority", "r.authority", "string", "The section that delegates the matter to a local authority."),
    Column("requires_sign", "r.requires_sign", "string", "The sign without which it is not in force."),
    Column("applies_to", "r.applies_to", "array", "Vehicle classes; empty for all."),
    Column("tags", "r.tags", "array", "Groups it belongs to."),
    Column("quote", "r.quote", "string", "The operative words, exact."),
    Column("vagueness", "r.vagueness", "integer", "0 (a number or plain fact) to 5 (a bare appeal to judgement)."),
    Column("vague_because", "r.vague_because", "string", "Why it is vague."),
    Column("confidence", "r.confidence", "string", "verified (two sources seen), seen (one) or recalled (none)."),
    Column("source_url", "s.source_url", "string", "Where the text was read."),
    Column("checked", "s.checked", "date", "The day it was last checked."),
    Column("text", "v.text", "string", "The section's rule in our own words."),
)


def read_lines(connection: sqlite3.Connection, where: str = "1", values: tuple[str, ...] = ()) -> list[Row]:
    """Regulation versions as lines of `COLUMNS`, in the database's order; lists and objects are JSON text, open dates None.

    `where` narrows them in SQL over regulation r, its section s and version v.
    """
    chosen = ", ".join(column.source for column in COLUMNS)
    query = f"""SELECT {chosen} FROM regulation r JOIN section_version v ON v.key = r.section_version
                JOIN section s ON s.id = v.section WHERE {where} ORDER BY r.key"""
    return connection.execute(query, values).fetchall()


_TYPED: dict[str, Callable[[Any], Any]] = {"boolean": bool, "array": json.loads, "object": json.loads}


def typed(line: Row) -> dict[str, Any]:
    """A line by column name, with lists, objects and truth values as such."""
    pairs = zip(COLUMNS, line, strict=True)
    return {column.name: _TYPED.get(column.kind, _as_is)(value) for column, value in pairs}


def _as_is(value: Any) -> Any:
    return value
