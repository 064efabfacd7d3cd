"""Tests beside regulations and cases -> law tests: scene, plan, day, place and expectation typed, each problem with its place."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from regdb.jurisdiction import Jurisdiction
from regdb.situation import Plan, Scene, SceneError, read_plan, read_scene
from regdb.states import StateError, StateMachine
from regdb_compiler import documents
from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.entries import RegulationEntry, Written
from regdb_compiler.law_tests.expect import Expected, read_expected
from regdb_compiler.law_tests.several_states import each_transition, listed
from regdb_compiler.parse import node_at
from regdb_compiler.source import Mapping

LAW_TEST_RULES = (
    ("R801", "unreadable-scene", "A test's scene, plan or place names what is not there, so that nothing can be judged."),
    ("R802", "unknown-expectation", "A test expects a regulation, fact or limit that is not there, or expects nothing at all."),
)


@dataclass(frozen=True, eq=False)
class LawTest:
    """One test of the law. `entry` is the regulation it stands beside, None for a case; `plan` is None when it cannot be read.

    `day` is a day number, `place` a jurisdiction's id, `steps` the way from `written` to the test.
    """

    doc: documents.LawTest
    written: Written
    steps: tuple[str | int, ...]
    entry: RegulationEntry | None
    place: str
    day: int
    scene: Scene
    plan: Plan | None
    expected: Expected
    problems: tuple[Diagnostic, ...]

    @property
    def name(self) -> str:
        return " ".join(self.doc.name.split())

    @property
    def where(self) -> Place:
        """Where its name is written."""
        return self.written.place(*self.steps, "name")

    @property
    def subject(self) -> str:
        """The regulation it stands beside, or what a case cites."""
        if self.entry is not None:
            return self.entry.id
        return ", ".join(self.doc.cites) if isinstance(self.doc, documents.Case) else ""


@dataclass
class _Reading:
    """One test while it is read."""

    corpus: Corpus
    written: Written
    steps: tuple[str | int, ...]
    law: str
    problems: list[Diagnostic] = field(default_factory=list)

    def unreadable(self, message: str, *path: str, key: bool = False) -> None:
        text, _, note = message.partition("; ")
        place = self.key_place(*path) if key else self.written.place(*self.steps, *path)
        self.problems.append(Diagnostic("R801", "unreadable-scene", "error", text, place, note=note, law=self.law))

    def key_place(self, *path: str | int) -> Place:
        inside = node_at(self.written.node, (*self.steps, *path[:-1]))
        return inside.key_place(str(path[-1])) if isinstance(inside, Mapping) else inside.place


def read_tests(corpus: Corpus) -> tuple[LawTest, ...]:
    """Every test beside a regulation, then every case, in the order of the files. Problems are in the tests themselves."""
    return (*_beside(corpus), *_cases(corpus))


def check_tests(tests: Iterable[LawTest]) -> Iterator[Diagnostic]:
    """What is wrong with how tests are written (R801, R802)."""
    for test in tests:
        yield from test.problems


def _beside(corpus: Corpus) -> Iterator[LawTest]:
    for entry in corpus.regulations:
        law, default_day = str(entry.citation), entry.default_day
        for position, doc in enumerate(entry.doc.tests):
            raw = _with_default_transition(doc.plan, entry.doc.states, corpus.machine)
            day = doc.on.toordinal() if doc.on else default_day
            plans, alone = each_transition(raw, corpus.machine)
            for plan in plans:
                reading = _Reading(corpus, entry, ("tests", position), law)
                if alone:
                    reading.unreadable(f"the machine has no transition between these states with {listed(alone)}", "plan")
                yield _read(reading, doc, plan, entry, entry.jurisdiction, day)


def _cases(corpus: Corpus) -> Iterator[LawTest]:
    for case in corpus.cases:
        reading = _Reading(corpus, case, (), ", ".join(case.doc.cites))
        day = case.doc.on.toordinal() if case.doc.on else _last_checked(corpus, case.jurisdiction)
        yield _read(reading, case.doc, case.doc.plan, None, case.jurisdiction, day)


def _last_checked(corpus: Corpus, jurisdiction: Jurisdiction) -> int:
    """A case without a day is judged on the last day on which its code was checked, so that its answer does not change with time."""
    days = [section.doc.source.checked.toordinal() for section in corpus.sections if section.jurisdiction is jurisdiction]
    return max(days, default=1)


def _read(
    reading: _Reading, doc: documents.LawTest, raw: dict[str, object], entry: RegulationEntry | None, own: Jurisdiction, day: int
) -> LawTest:
    place = _place(reading, doc.in_ or own.id)
    scene = _scene(reading, doc.scene)
    plan = _plan(reading, raw)
    problems = reading.problems
    expected = read_expected(doc.expect, reading.corpus, entry, own)
    for item in expected.problems:
        where = reading.key_place("expect", *item.path) if item.key else reading.written.place(*reading.steps, "expect", *item.path)
        problems.append(Diagnostic("R802", "unknown-expectation", "error", item.message, where, note=item.note, law=reading.law))
    unreadable = any(item.code == "R801" for item in problems)
    return LawTest(
        doc, reading.written, reading.steps, entry, place, day, scene, None if unreadable else plan, expected.expected, tuple(problems)
    )


def _place(reading: _Reading, name: str) -> str:
    tree = reading.corpus.tree
    if name in tree:
        return tree.get(name).id
    known = ", ".join(sorted(item.id for item in tree))
    reading.unreadable(f"unknown jurisdiction `{name}`; known: {known}", "in")
    return name


def _scene(reading: _Reading, raw: dict[str, object]) -> Scene:
    vocabulary = reading.corpus.vocabulary
    try:
        return read_scene(raw, vocabulary)
    except SceneError:
        for name, value in raw.items():
            try:
                read_scene({name: value}, vocabulary)
            except SceneError as error:
                for problem in error.problems:
                    reading.unreadable(problem, "scene", name, key=problem.startswith("unknown fact"))
        return Scene()


def _plan(reading: _Reading, raw: dict[str, object]) -> Plan | None:
    vocabulary, machine = reading.corpus.vocabulary, reading.corpus.machine
    if not machine.states:
        reading.unreadable("there is no state machine to read the plan by", "plan")
        return None
    try:
        return read_plan(raw, vocabulary, machine)
    except SceneError:
        for name, value in raw.items():
            try:
                read_plan({name: value}, vocabulary, machine)
            except SceneError as error:
                for problem in error.problems:
                    reading.unreadable(problem, "plan", name, key=problem.startswith("unknown fact"))
        return None


def _with_default_transition(raw: dict[str, object], states: documents.States, machine: StateMachine) -> dict[str, object]:
    """The plan with the transition a test leaves out: the first one of its regulation's states, current before next.

    What the test does write is kept; a regulation of every transition leaves the machine's initial state.
    """
    if "next" in raw or not (states.current or states.next):
        return raw
    try:
        wanted = machine.expand(str(raw["current"])) if "current" in raw else _expand(states.current, machine)
        pairs = [(a, b) for a in wanted for b in _expand(states.next, machine)]
    except StateError:
        return raw
    found = next((pair for pair in pairs if pair[1] in machine.states[pair[0]].next), pairs[0] if pairs else None)
    return raw if found is None else {**raw, "current": found[0], "next": found[1]}


def _expand(names: tuple[str, ...], machine: StateMachine) -> list[str]:
    return [state for name in names for state in machine.expand(name)] if names else list(machine.states)
