"""Interpretation documents -> profiles both sides speak of, checked: facts exist, formulas are known, parameters fit and are there."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from regdb.interpretation import FORMULAS, Decision, Interpretation, Parameter
from regdb.units import Quantity, UnitError, parse_quantity
from regdb.vocabulary import Vocabulary
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.documents.interpretation import DecisionDocument, InterpretationFile
from regdb_compiler.parse import place_at
from regdb_compiler.source import Mapping as MappingNode
from regdb_compiler.source import SourceFile

INTERPRETATION_RULES = (
    ("R450", "bad-interpretation", "An interpretation names a fact, formula or parameter that is not there, or a number that does not fit."),
)
UNKNOWN = "unknown"
"""In place of a formula: never decided."""

_MAY_BE_ZERO = frozenset(("fluctuation_margin",))


@dataclass(frozen=True, eq=False)
class InterpretationEntry:
    """A profile with the file it stands in."""

    profile: Interpretation
    file: SourceFile

    def place(self, *path: str) -> Place:
        """Where a field's key stands; the file's beginning for one that is not written."""
        node = self.file.root
        for step in path[:-1]:
            node = node.get(step) if isinstance(node, MappingNode) else None
        return node.key_place(path[-1]) if isinstance(node, MappingNode) and path else Place(self.file.path, 1, 1, 1, 1)


def read_interpretation(doc: InterpretationFile, file: SourceFile, vocabulary: Vocabulary) -> tuple[InterpretationEntry, list[Diagnostic]]:
    """The profile as far as it is sound, and every reason why it is not."""
    problems: list[Diagnostic] = []
    if PurePosixPath(file.path).stem != doc.interpretation:
        problems.append(_bad(file, f"`{doc.interpretation}` stands in a file of another name", "interpretation"))
    known = {name for formula in FORMULAS.values() for name in formula.parameters}
    numbers: dict[str, Quantity] = {}
    for name, item in doc.parameters.items():
        if name not in known:
            problems.append(_bad(file, f"no formula has a parameter `{name}`{_near(name, known)}", "parameters", name))
        _read_number(name, item.value, ("parameters", name), file, numbers, problems)
    decisions = dict(_decisions(doc, file, vocabulary, numbers, problems))
    source = doc.source
    profile = Interpretation(
        doc.interpretation, doc.title, doc.meaning, source.url, source.also, source.checked.isoformat(), source.confidence, source.note,
        decisions,
    )  # fmt: skip
    return InterpretationEntry(profile, file), problems


def _decisions(
    doc: InterpretationFile, file: SourceFile, vocabulary: Vocabulary, numbers: Mapping[str, Quantity], problems: list[Diagnostic]
) -> Iterator[tuple[str, Decision]]:
    for name, item in doc.facts.items():
        fact = vocabulary.facts.get(name)
        if fact is None or fact.kind != "boolean":
            why = f"unknown fact `{name}`{vocabulary.hint(name)}" if fact is None else f"`{name}` is no boolean but of the type {fact.kind}"
            problems.append(_bad(file, why, "facts", name))
            continue
        before = len(problems)
        parameters = {} if item.formula == UNKNOWN else dict(_parameters(name, item, file, numbers, problems))
        if len(problems) == before:
            formula = "" if item.formula == UNKNOWN else item.formula
            yield name, Decision(name, formula, parameters, item.true_when, item.because, item.source)


def _parameters(
    fact: str, item: DecisionDocument, file: SourceFile, numbers: Mapping[str, Quantity], problems: list[Diagnostic]
) -> Iterator[tuple[str, Parameter]]:
    """What the formula needs, from the decision itself or from the profile."""
    formula = FORMULAS.get(item.formula)
    if formula is None:
        problems.append(_bad(file, f"there is no formula `{item.formula}`{_near(item.formula, [*FORMULAS, UNKNOWN])}", "facts", fact))
        return
    own: dict[str, Quantity] = {}
    for name, text in item.parameters.items():
        _read_number(name, text, ("facts", fact), file, own, problems)
        if name not in formula.parameters:
            problems.append(_bad(file, f"`{item.formula}` has no parameter `{name}`{_near(name, formula.parameters)}", "facts", fact))
    for name, dimension in formula.parameters.items():
        number = own.get(name) or numbers.get(name)
        if number is None:
            if name not in item.parameters:
                problems.append(_bad(file, f"`{item.formula}` needs the parameter `{name}` (of {dimension})", "facts", fact))
        elif number.dimension != dimension:
            problems.append(_bad(file, f"`{name}` is of {dimension}, not of {number.dimension}: {number}", "facts", fact))
        else:
            yield name, Parameter(str(number), number.si)


def _read_number(
    name: str, text: str, path: tuple[str, ...], file: SourceFile, found: dict[str, Quantity], problems: list[Diagnostic]
) -> None:
    try:
        number = parse_quantity(text)
    except UnitError as error:
        problems.append(_bad(file, f"`{name}`: {error}", *path))
        return
    if number.value < 0 or (number.value == 0 and name not in _MAY_BE_ZERO):
        problems.append(_bad(file, f"`{name}` must be more than nothing, not {number}", *path))
    else:
        found[name] = number


def _near(name: str, known: Iterable[str]) -> str:
    found = difflib.get_close_matches(name, list(known), 1)
    return f"; did you mean `{found[0]}`?" if found else ""


def _bad(file: SourceFile, message: str, *path: str) -> Diagnostic:
    assert file.root is not None
    node = file.root
    for step in path[:-1]:
        inner = node.get(step) if isinstance(node, MappingNode) else None
        node = inner if inner is not None else node
    place = node.key_place(path[-1]) if isinstance(node, MappingNode) and path[-1] in node else place_at(file.root, path)
    return Diagnostic("R450", "bad-interpretation", "error", message, place)
