"""A compiled database as a place to look things up by any name people use: ids, citations, facts, states, topics."""

from __future__ import annotations

import difflib
import json
import re
import sqlite3
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from regdb.citation import Citation, CitationError, parse_citation
from regdb.front import FrontError
from regdb.jurisdiction import Jurisdiction, JurisdictionError, JurisdictionTree
from regdb.states import State, StateMachine, SuperState

MACHINE = frozenset(("states", "state_machine"))
"""Words for the state machine as a whole."""
_BARE = re.compile(r"\d[\d.\-]*(?:\s*\([A-Za-z0-9]+\))*\s*\Z")
_TABLES = (
    ("fact", "SELECT name FROM fact"),
    ("attribute", "SELECT name FROM attribute"),
    ("definition", "SELECT DISTINCT name FROM definition"),
    ("jurisdiction", "SELECT id FROM jurisdiction UNION SELECT code FROM jurisdiction WHERE code <> ''"),
    ("interpretation", "SELECT name FROM interpretation"),
    ("topic", "SELECT DISTINCT topic FROM section UNION SELECT DISTINCT topic FROM regulation"),
)
NEAR = 5
"""Near matches suggested."""


@dataclass(frozen=True, slots=True)
class Found:
    """What a name stands for: its kind (regulation, section, fact, ...) and the names under which it is stored."""

    kind: str
    names: tuple[str, ...]


class Library:
    """Looks up names in one database; `place` keeps law that does not govern there out of sight."""

    def __init__(self, path: Path, place: str = "") -> None:
        self.connection = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
        self.place = place
        try:
            self.governing = self.tree.governing(place, self._loaded) if place else frozenset(item.id for item in self.tree)
        except JurisdictionError as error:
            self.connection.close()
            raise FrontError(str(error)) from error

    def __enter__(self) -> Library:
        return self

    def __exit__(self, *_: object) -> None:
        self.connection.close()

    @cached_property
    def tree(self) -> JurisdictionTree:
        """The jurisdictions as far as looking up needs them: ids, names, parents, how their codes are cited."""
        rows = self.connection.execute("SELECT id, name, kind, parent, status, code, short, long FROM jurisdiction ORDER BY rowid")
        return JurisdictionTree(Jurisdiction(*row) for row in rows)

    @cached_property
    def _loaded(self) -> frozenset[str]:
        return frozenset(self.column("SELECT DISTINCT jurisdiction FROM section"))

    def column(self, query: str, *values: str) -> list[str]:
        """The first column of a query's rows."""
        return [row[0] for row in self.connection.execute(query, values)]

    def find(self, text: str) -> Found:
        """What the words stand for. Raises FrontError, naming what is near."""
        text = " ".join(text.split())
        found = self._regulation(text) or self._section(text) or self._citation(text) or self._language(text)
        if found is None:
            near = self.near(text)
            hint = "; did you mean " + ", ".join(near) + "?" if near else "; try `regdb search`"
            where = f" in {self.place}" if self.place else ""
            raise FrontError(f"there is no {text!r}{where}{hint}")
        return found

    def interpretation(self, name: str) -> Found:
        """The profile of this name. Raises FrontError with those there are."""
        names = self.column("SELECT name FROM interpretation ORDER BY name")
        if name not in names:
            raise FrontError(f"there is no interpretation {name!r}; there are: {', '.join(names) or 'none'}")
        return Found("interpretation", (name,))

    def near(self, text: str) -> tuple[str, ...]:
        """Names most like the words, best first."""
        names = [*self.column("SELECT DISTINCT id FROM regulation"), *self.column("SELECT id FROM section")]
        names += self.column("SELECT citation FROM section")
        for _, query in _TABLES:
            names += self.column(query)
        names += self._state_names
        folded = {name.lower(): name for name in names}
        matches = difflib.get_close_matches(text.lower(), folded, NEAR, 0.6)
        matches += [name for name in folded if text.lower() in name and name not in matches]
        return tuple(folded[name] for name in matches[:NEAR])

    def _governed(self, ids: Iterable[tuple[str, str]]) -> tuple[str, ...]:
        """Names of (name, jurisdiction) pairs that govern the place, each once."""
        return tuple(dict.fromkeys(name for name, owner in ids if owner in self.governing))

    def _regulation(self, text: str) -> Found | None:
        rows = self.connection.execute("SELECT id, jurisdiction FROM regulation WHERE id = lower(?) ORDER BY key", (text,))
        names = self._governed(rows)
        return Found("regulation", names) if names else None

    def _section(self, text: str) -> Found | None:
        names = self._governed(self.connection.execute("SELECT id, jurisdiction FROM section WHERE id = lower(?)", (text,)))
        return Found("section", names) if names else None

    def _citation(self, text: str) -> Found | None:
        """A citation with its code, or a bare section number in whatever code has it."""
        wanted = [text] if not _BARE.match(text) else [f"{item.short} {text}" for item in self.tree if item.short]
        sections: list[tuple[str, str]] = []
        rules: list[tuple[str, str]] = []
        for option in wanted:
            citation = self._read_citation(option)
            if citation is None:
                continue
            whole = (f"{citation.code} {citation.section}",)
            sections += self.connection.execute("SELECT id, jurisdiction FROM section WHERE citation = ? COLLATE NOCASE", whole)
            if citation.subdivision:
                rules += self._within(citation)
        if rules and (names := self._governed(rules)):
            return Found("regulation", names)
        names = self._governed(sections)
        return Found("section", names) if names else None

    def _read_citation(self, text: str) -> Citation | None:
        longs = {item.long.rstrip("§ ").lower(): item.short for item in self.tree if item.long}
        for long, short in longs.items():
            if text.lower().startswith(long):
                text = short + text[len(long) :]
        try:
            citation = parse_citation(text)
        except CitationError:
            return None
        known = {item.short.upper(): item.short for item in self.tree}
        return Citation(known.get(citation.code.upper(), citation.code), citation.section, citation.subdivision)

    def _within(self, citation: Citation) -> list[tuple[str, str]]:
        """Regulations at a subdivision or inside it."""
        like = (f"{citation.code} {citation.section}%",)
        rows = self.connection.execute("SELECT id, jurisdiction, citation FROM regulation WHERE citation LIKE ? ORDER BY key", like)
        return [(name, owner) for name, owner, written in rows if citation.contains(parse_citation(written))]

    def _language(self, text: str) -> Found | None:
        """Facts, attributes, definitions, jurisdictions, topics, states."""
        for kind, query in _TABLES:
            if text in self.column(query):
                return Found(kind, (text,))
        key = text.lower().replace(" ", "_").replace("-", "_")
        if key in MACHINE:
            return Found("machine", (key,))
        return Found("state", (key,)) if key in self._state_names else None

    @cached_property
    def machine(self) -> StateMachine:
        """The state machine, states as declared."""
        after: dict[str, list[str]] = {}
        declared = "SELECT t.current, t.next FROM transition t JOIN state s ON s.id = t.next ORDER BY s.position"
        for current, following in self.connection.execute(declared):
            after.setdefault(current, []).append(following)
        rows = self.connection.execute("SELECT id, super_state, name, meaning, prompt, aliases, extension FROM state ORDER BY position")
        states = [
            State(group, name, meaning, tuple(json.loads(aliases)), bool(extension), prompt, tuple(after.get(key, ())))
            for key, group, name, meaning, prompt, aliases, extension in rows
        ]
        columns = "name, meaning, prompt, next, entry, exit, aliases, from_anywhere"
        supers = [
            SuperState(name, meaning, prompt, tuple(json.loads(following)), entry, leave, tuple(json.loads(aliases)), bool(anywhere))
            for name, meaning, prompt, following, entry, leave, aliases, anywhere in self.connection.execute(
                f"SELECT {columns} FROM super_state ORDER BY position"
            )
        ]
        return StateMachine(supers, states, self.column("SELECT name FROM super_state WHERE initial ORDER BY position")[0])

    @cached_property
    def _state_names(self) -> tuple[str, ...]:
        """Ids, short names and aliases of states and super-states."""
        names = self.column("SELECT id FROM state UNION SELECT name FROM state UNION SELECT name FROM super_state")
        names += self.column("SELECT DISTINCT value FROM state, json_each(aliases)")
        names += self.column("SELECT DISTINCT value FROM super_state, json_each(aliases)")
        return tuple(dict.fromkeys(names))
