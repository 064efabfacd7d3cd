"""Random law and random scenes for the runtime's tests, seeded; and a small database written by hand from the schema."""

from __future__ import annotations

import json
import random
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from regdb.condition import And, Compare, Const, Has, Is, Known, Linear, Node, Not, OneOf, Or, Within
from regdb.condition_text import linear_to_data, to_json
from regdb.content_hash import content_hash
from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.regulation import Limit, Regulation
from regdb.schema import APPLICATION_ID, TABLES, USER_VERSION
from regdb.situation import Plan, Scene
from regdb.states import State, StateMachine, SuperState
from regdb.vocabulary import Assumption, Attribute, Fact, Vocabulary

COLORS = ("red", "yellow", "green", "off")
STATES = ("a", "b", "c")


def make_vocabulary() -> Vocabulary:
    """Booleans, words, sets, numbers, counts, times, dates; some with assumptions."""
    facts = [Fact(f"b{i}", "boolean", assumption=Assumption(i == 3) if i in (3, 4) else None) for i in range(6)]
    facts += [Fact(f"e{i}", "enumeration", values=COLORS, assumption=Assumption("off") if i == 2 else None) for i in range(3)]
    facts += [Fact(f"s{i}", "set", values=COLORS, source="map") for i in range(2)]
    facts += [Fact(f"q{i}", "quantity", unit="mph", source="plan", assumption=Assumption(5.0) if i == 3 else None) for i in range(4)]
    facts += [Fact("n", "count", unit=""), Fact("t", "time", source="clock"), Fact("d", "date", source="clock")]
    limits = [Attribute("max_q0", "limit", "q0", "max"), Attribute("min_q1", "limit", "q1", "min")]
    return Vocabulary(facts, limits)


def make_machine() -> StateMachine:
    """One super-state with three states, all transitions allowed."""
    ids = tuple(f"drive.{name}" for name in STATES)
    return StateMachine([SuperState("drive")], [State("drive", name, next=ids) for name in STATES], "drive")


def make_tree() -> JurisdictionTree:
    """A model code, a state under it, a county and a city that are siblings."""
    return JurisdictionTree(
        [
            Jurisdiction("model", "Model", status="model", code="mc"),
            Jurisdiction("state", "State", parent="model", code="sc"),
            Jurisdiction("county", "County", "county", "state"),
            Jurisdiction("city", "City", "city", "state"),
        ]
    )


class RandomLaw:
    """Seeded rules, scenes and plans over `make_vocabulary`."""

    def __init__(self, seed: int) -> None:
        self.dice = random.Random(seed)
        self.vocabulary, self.machine, self.tree = make_vocabulary(), make_machine(), make_tree()

    def literal(self) -> Node:
        dice = self.dice
        quantity = lambda: Linear(0.0, ((1.0, f"q{dice.randrange(4)}"),))  # noqa: E731
        match dice.randrange(11):
            case 0 | 1 | 2:
                return Is(f"b{dice.randrange(6)}")
            case 3 | 4:
                return OneOf(f"e{dice.randrange(3)}", tuple(sorted(dice.sample(COLORS, dice.randint(1, 3)))))
            case 5:
                return Has(f"s{dice.randrange(2)}", dice.choice(COLORS))
            case 6:
                return Compare(dice.choice(("<", "<=", ">", ">=", "==", "!=")), quantity(), Linear(float(dice.randrange(10))))
            case 7:
                left = Linear(float(dice.randrange(-3, 4)), ((dice.choice((2.0, 0.1, -1.0)), "q0"), (dice.choice((1.0, 0.3)), "q1")))
                return Compare(dice.choice(("<", ">=")), left, dice.choice((quantity(), Linear(float(dice.randrange(10))))))
            case 8:
                times = (dice.randrange(0, 86400, 3600), dice.randrange(0, 86400, 3600))
                return Within("t", *times) if dice.random() < 0.7 else Within("d", 739000, 739000 + dice.randrange(20), "date")
            case 9:
                return Known(dice.choice(("b0", "b3", "e1", "q2", "s0")))
            case _:
                return dice.choice((Const(value=True), Compare(">", Linear(3.0), Linear(0.0, ((1.0, "n"),)))))

    def node(self, depth: int) -> Node:
        dice = self.dice
        if depth == 0 or dice.random() < 0.4:
            return self.literal()
        match dice.randrange(3):
            case 0:
                return Not(self.node(depth - 1))
            case 1:
                return Or(tuple(self.node(depth - 1) for _ in range(dice.randint(2, 3))))
            case _:
                return And(tuple(self.node(depth - 1) for _ in range(dice.randint(2, 3))))

    def limit(self) -> Limit:
        dice = self.dice
        name, fact, direction = dice.choice((("max_q0", "q0", "max"), ("min_q1", "q1", "min")))
        bound = Linear(float(dice.randrange(10)), ((1.0, "q2"),)) if dice.random() < 0.3 else Linear(float(dice.randrange(10)))
        return Limit(name, fact, direction, bound, "mph")

    def states(self) -> frozenset[str] | None:
        dice = self.dice
        return None if dice.random() < 0.6 else frozenset(f"drive.{s}" for s in dice.sample(STATES, dice.randint(1, 2)))

    def rules(self, count: int) -> list[Regulation]:
        dice = self.dice
        found = []
        for index in range(count):
            earlier = [f"r{i:04}" for i in range(index)]
            targets = tuple(dice.sample(earlier, min(len(earlier), dice.randint(1, 2)))) if dice.random() < 0.35 else ()
            limits = tuple(self.limit() for _ in range(dice.randint(1, 2))) if dice.random() < 0.35 else ()
            found.append(
                Regulation(
                    f"r{index:04}", f"SC {index}", dice.choice(("state", "state", "city", "county", "model")),
                    legality=bool(targets) and dice.random() < 0.6,
                    effective=dice.choice((None, 739000, 739005)), until=dice.choice((None, None, 739010)),
                    when=self.node(2), unless=self.node(1) if dice.random() < 0.3 else None, limits=limits,
                    force=dice.choice(("absolute", "", "prima_facie", "penalty_tier", "advisory")) if limits else "",
                    current=self.states(), next=self.states(), targets=targets,
                )
            )  # fmt: skip
        dice.shuffle(found)
        return found

    def facts(self, names: tuple[str, ...], known: float) -> dict[str, Any]:
        dice = self.dice
        found: dict[str, Any] = {}
        for name in names:
            if dice.random() < known:
                found[name] = {
                    "b": lambda: dice.random() < 0.5,
                    "e": lambda: dice.choice(COLORS),
                    "s": lambda: frozenset(dice.sample(COLORS, dice.randrange(3))),
                    "q": lambda: dice.choice((float(dice.randrange(10)), dice.random() * 10)),
                    "n": lambda: dice.randrange(6),
                    "t": lambda: dice.choice((dice.randrange(86400), dice.randrange(0, 86400, 3600))),
                    "d": lambda: 739000 + dice.randrange(20),
                }[name[0]]()
        return found

    def scene(self) -> Scene:
        dice = self.dice
        silent = frozenset(dice.sample(("perception", "plan", "b3", "e2"), 1)) if dice.random() < 0.2 else frozenset()
        return Scene(self.facts(tuple(self.vocabulary.facts), dice.choice((0.6, 0.8, 1.0))), silent)

    def plan(self) -> Plan:
        dice = self.dice
        return Plan(
            f"drive.{dice.choice(STATES)}", f"drive.{dice.choice(STATES)}", self.facts(("q0", "q1", "b0"), dice.choice((0.0, 0.5, 1.0)))
        )


@pytest.fixture
def random_law() -> Callable[[int], RandomLaw]:
    return RandomLaw


def _insert(connection: sqlite3.Connection, table: str, **row: Any) -> None:
    names = [line.split()[0] for line in TABLES[table] if line.split()[0] not in ("PRIMARY", "UNIQUE")]
    values = [row.get(name, "") for name in names]
    connection.execute(f"INSERT INTO {table} VALUES ({', '.join('?' * len(names))})", values)


def write_database(path: Path, law: RandomLaw, rules: list[Regulation]) -> Path:
    """Write rules as the compiler does, straight into the schema's tables."""
    from datetime import date

    path.unlink(missing_ok=True)
    connection = sqlite3.connect(path)
    connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    connection.execute(f"PRAGMA user_version = {USER_VERSION}")
    for table, columns in TABLES.items():
        connection.execute(f"CREATE TABLE {table} ({', '.join(columns)})")
    for item in law.tree:
        _insert(connection, "jurisdiction", id=item.id, name=item.name, kind=item.kind, status=item.status, parent=item.parent,
                code=item.code, territory="[]", road_owners="[]")  # fmt: skip
    for place, item in enumerate(law.machine.super_states.values()):
        _insert(connection, "super_state", name=item.name, position=place, next="[]", entry=item.entry, exit=item.exit, aliases="[]",
                from_anywhere=0, initial=1)  # fmt: skip
    for place, state in enumerate(law.machine.states.values()):
        _insert(connection, "state", id=state.id, position=place, super_state=state.super_state, name=state.name, aliases="[]", extension=0)
    for state in law.machine.states.values():
        for following in state.next:
            _insert(connection, "transition", current=state.id, next=following)
    for fact in law.vocabulary:
        assumed = None if fact.assumption is None else json.dumps(fact.assumption.value)
        _insert(connection, "fact", name=fact.name, kind=fact.kind, meaning=f"Meaning of {fact.name}.", source=fact.source,
                words=json.dumps(fact.values), unit=fact.unit, dimension=fact.dimension, assumed=assumed, assumed_because="no report",
                quiet=None, phrases="{}", confusables="[]", codes="{}")  # fmt: skip
    for item in law.vocabulary.attributes.values():
        _insert(connection, "attribute", name=item.name, kind=item.kind, fact=item.fact, direction=item.direction)
    _insert(connection, "section", id="sc-1", jurisdiction="state", number="1", citation="SC 1", title="One", source_url="https://law")
    _insert(connection, "section_version", key=1, section="sc-1", effective="2000-01-01", until=None, text="The words of the law.")
    iso = lambda day: None if day is None else date.fromordinal(day).isoformat()  # noqa: E731
    for key, rule in enumerate(rules, 1):
        _insert(connection, "regulation", key=key, id=rule.id, section_version=1, jurisdiction=rule.jurisdiction, citation=rule.citation,
                legality=int(rule.legality), effective=iso(rule.effective), until=iso(rule.until), when_tree=to_json(rule.when),
                unless_tree=None if rule.unless is None else to_json(rule.unless), force=rule.force, tags="[]", vagueness=0)  # fmt: skip
        for place, limit in enumerate(rule.limits):
            fixed = None if limit.bound.terms else limit.bound.constant
            _insert(connection, "regulation_limit", regulation=key, position=place, attribute=limit.attribute, fact=limit.fact,
                    direction=limit.direction, bound=json.dumps(linear_to_data(limit.bound)), value=fixed, unit=limit.unit, si=fixed)  # fmt: skip
        for role, states in (("current", rule.current), ("next", rule.next)):
            for state in sorted(states or ()):
                _insert(connection, "regulation_state", regulation=key, role=role, state=state)
        for place, target in enumerate(rule.targets):
            kind = "overrides" if target in rule.overrides else "exception_to"
            _insert(connection, "regulation_target", regulation=key, position=place, target=target, kind=kind)
    seal(connection)
    return path


def seal(connection: sqlite3.Connection) -> None:
    """Write the content hash and close."""
    connection.execute("INSERT OR REPLACE INTO regdb_meta VALUES ('content_hash', ?)", (content_hash(connection),))
    connection.commit()
    connection.close()


@pytest.fixture
def write_law() -> Callable[..., Path]:
    return write_database
