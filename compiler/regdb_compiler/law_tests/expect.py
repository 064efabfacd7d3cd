"""What a test expects, typed: ids led to regulations, limits to numbers in SI, facts to the vocabulary."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from regdb.jurisdiction import Jurisdiction
from regdb.vocabulary import FactError
from regdb_compiler import documents
from regdb_compiler.corpus import Corpus
from regdb_compiler.entries import RegulationEntry


@dataclass(frozen=True, slots=True)
class ExpectedLimit:
    """One limit: `bound` in SI, None when the attribute shall have no limit in force; `text` as written."""

    attribute: str
    bound: float | None
    text: str


@dataclass(frozen=True, slots=True)
class Expected:
    """Only what is written is compared: None is not written. Ids are full, lists are sets, limits are those named.

    `limits` empty: no limit at all is in force.
    """

    verdict: str | None = None
    deciding: frozenset[str] | None = None
    limits: tuple[ExpectedLimit, ...] | None = None
    unknown: frozenset[str] | None = None
    assumed: frozenset[str] | None = None


@dataclass(frozen=True, slots=True)
class ExpectationProblem:
    """Why an expectation can never be met; `path` leads to it inside `expect`, `key` when the key itself is wrong."""

    message: str
    note: str
    path: tuple[str | int, ...] = ()
    key: bool = False


@dataclass(frozen=True, slots=True)
class ReadExpectation:
    expected: Expected
    problems: tuple[ExpectationProblem, ...]


@dataclass
class _Reading:
    corpus: Corpus
    entry: RegulationEntry | None
    own: Jurisdiction
    problems: list[ExpectationProblem] = field(default_factory=list)

    def wrong(self, message: str, note: str, *path: str | int, key: bool = False) -> None:
        self.problems.append(ExpectationProblem(message, note, path, key))


def read_expected(doc: documents.Expectation, corpus: Corpus, entry: RegulationEntry | None, own: Jurisdiction) -> ReadExpectation:
    """An expectation as written, with everything in it that names what is not there."""
    reading = _Reading(corpus, entry, own)
    if not doc.model_fields_set:
        reading.wrong("the test expects nothing", "write `expect: legal`, `illegal` or `unknown`")
    limits = None if doc.limits is None else tuple(_limits(reading, doc.limits))
    expected = Expected(
        doc.verdict,
        None if doc.deciding is None else frozenset(_ids(reading, doc.deciding)),
        limits,
        None if doc.unknown is None else frozenset(_facts(reading, "unknown", doc.unknown)),
        None if doc.assumed is None else frozenset(_facts(reading, "assumed", doc.assumed)),
    )
    return ReadExpectation(expected, tuple(reading.problems))


def _ids(reading: _Reading, names: Iterable[str]) -> Iterable[str]:
    by_id = reading.corpus.by_id
    for position, name in enumerate(names):
        options = [f"{reading.own.code}-{name}", name]
        if reading.entry is not None:
            options.insert(0, f"{reading.entry.section.id}-{name}")
        found = next((option for option in options if option in by_id), None)
        if found is None:
            reading.wrong(f"no regulation has the id `{name}`", _near_id(reading, options[0]), "deciding", position)
        yield found or name


def _near_id(reading: _Reading, name: str) -> str:
    import difflib

    near = difflib.get_close_matches(name, reading.corpus.by_id, 1, 0.6)
    return f"did you mean {near[0]}?" if near else "write it as `a` (of this section) or `cvc-21453-a`"


def _facts(reading: _Reading, key: str, names: Iterable[str]) -> Iterable[str]:
    vocabulary = reading.corpus.vocabulary
    for position, name in enumerate(names):
        if name not in vocabulary:
            near = vocabulary.nearest(name)
            reading.wrong(f"unknown fact `{name}`", f"did you mean {near}?" if near else "no such fact", key, position)
        yield name


def _limits(reading: _Reading, written: dict[str, str]) -> Iterable[ExpectedLimit]:
    vocabulary = reading.corpus.vocabulary
    for name, text in written.items():
        attribute = vocabulary.attributes.get(name)
        if attribute is None or attribute.kind != "limit":
            known = ", ".join(item.name for item in vocabulary.attributes.values() if item.kind == "limit")
            reading.wrong(f"`{name}` is no limit", f"limits: {known}", "limits", name, key=True)
            continue
        if text == "none":
            yield ExpectedLimit(name, None, text)
            continue
        try:
            value = vocabulary.fact(attribute.fact).read(text)
        except FactError as error:
            message, _, note = str(error).partition("; ")
            reading.wrong(message, note, "limits", name)
            continue
        if isinstance(value, (int, float)):
            yield ExpectedLimit(name, float(value), text)
        else:
            reading.wrong(f"`{text}` is no limit of {name}", "write the number with its unit, or `none`", "limits", name)
