"""All law of a codes folder, frozen and indexed: vocabulary, states, jurisdictions, sections, cases, with every reading problem."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.states import StateMachine
from regdb.vocabulary import Attribute, Fact, Vocabulary
from regdb_compiler import documents
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.entries import CaseEntry, RegulationEntry, SectionEntry, VersionEntry
from regdb_compiler.parse import parse_document
from regdb_compiler.read_vocabulary import read_attributes, read_fact, read_jurisdictions, read_states
from regdb_compiler.source import Mapping as MappingNode
from regdb_compiler.source import Sequence, SourceFile, read_source

CORPUS_RULES = (
    ("R101", "duplicate-section", "Two files hold the same section of one code; all its versions belong in one file."),
    ("R103", "unknown-code", "A folder of sections that no jurisdiction names as its code."),
)


@dataclass(frozen=True)
class Corpus:
    """Everything that was read. `diagnostics` are the reading problems; sections that could not be read are left out."""

    root: Path
    files: Mapping[str, SourceFile]
    vocabulary: Vocabulary
    machine: StateMachine
    tree: JurisdictionTree
    sections: tuple[SectionEntry, ...]
    cases: tuple[CaseEntry, ...]
    fact_places: Mapping[str, Place] = field(default_factory=dict)
    diagnostics: tuple[Diagnostic, ...] = ()

    @cached_property
    def versions(self) -> tuple[VersionEntry, ...]:
        return tuple(version for section in self.sections for version in section.versions)

    @cached_property
    def regulations(self) -> tuple[RegulationEntry, ...]:
        """Every regulation of every version."""
        return tuple(entry for version in self.versions for entry in version.regulations)

    @cached_property
    def by_id(self) -> dict[str, tuple[RegulationEntry, ...]]:
        """Regulation id -> its versions."""
        found: dict[str, list[RegulationEntry]] = {}
        for entry in self.regulations:
            found.setdefault(entry.id, []).append(entry)
        return {name: tuple(entries) for name, entries in found.items()}

    @cached_property
    def by_citation(self) -> dict[tuple[str, str], SectionEntry]:
        """(code's short name, section number) -> section."""
        return {(section.jurisdiction.short, section.doc.section): section for section in self.sections}

    @cached_property
    def texts(self) -> dict[str, str]:
        """Path -> text, for reports."""
        return {path: file.text for path, file in self.files.items()}


class _Reader:
    """Collects files and problems while the folder is read."""

    def __init__(self, root: Path) -> None:
        self.root, self.base = root, root.parent
        self.files: dict[str, SourceFile] = {}
        self.problems: list[Diagnostic] = []

    def read(self, path: Path) -> SourceFile:
        file = read_source(path, self.base)
        self.files[file.path] = file
        self.problems += file.diagnostics
        return file


def read_corpus(codes: Path) -> Corpus:
    """Read a codes folder. Never raises for what is in it: problems are the corpus's diagnostics."""
    codes = codes.resolve()
    reader = _Reader(codes)
    tree = _read_tree(reader)
    machine = _read_machine(reader)
    vocabulary, places = _read_vocabulary(reader)
    sections: list[SectionEntry] = []
    cases: list[CaseEntry] = []
    for folder in sorted(path for path in codes.iterdir() if path.is_dir()) if codes.is_dir() else ():
        if folder.name in {"vocabulary", "interpretations", "schema"} or folder.name.startswith((".", "_")):
            continue
        jurisdiction = tree.get(folder.name) if folder.name in tree else None
        if jurisdiction is None or jurisdiction.code != folder.name:
            known = ", ".join(sorted(item.code for item in tree))
            place = Place(f"{codes.name}/{folder.name}", 1, 1, 1, 1)
            message = f"no jurisdiction has the code `{folder.name}`"
            reader.problems.append(Diagnostic("R103", "unknown-code", "error", message, place, note=f"codes: {known}"))
            continue
        sections += _read_sections(reader, folder, jurisdiction)
        cases += _read_cases(reader, folder, jurisdiction)
    sections = _without_duplicates(sections, reader.problems)
    return Corpus(codes, reader.files, vocabulary, machine, tree, tuple(sections), tuple(cases), places, tuple(reader.problems))


def _read_tree(reader: _Reader) -> JurisdictionTree:
    file = reader.read(reader.root / "jurisdictions.yaml")
    doc, problems = parse_document(documents.JurisdictionsFile, file)
    tree, more = read_jurisdictions(doc, file) if doc is not None else (None, [])
    reader.problems += [*problems, *more]
    return tree or JurisdictionTree([])


def _read_machine(reader: _Reader) -> StateMachine:
    file = reader.read(reader.root / "states.yaml")
    doc, problems = parse_document(documents.StatesFile, file)
    machine, more = read_states(doc, file) if doc is not None else (None, [])
    reader.problems += [*problems, *more]
    return machine or StateMachine([], [], "")


def _read_vocabulary(reader: _Reader) -> tuple[Vocabulary, dict[str, Place]]:
    facts: dict[str, Fact] = {}
    places: dict[str, Place] = {}
    attributes: list[tuple[str, documents.Attribute, SourceFile]] = []
    for path in sorted((reader.root / "vocabulary").glob("*.yaml")):
        file = reader.read(path)
        doc, problems = parse_document(documents.VocabularyFile, file)
        reader.problems += problems
        if doc is None or file.root is None:
            continue
        for name, item in doc.facts.items():
            place = _key_of(file, "facts", name)
            if name in places:
                reader.problems.append(_twice(name, place, places[name]))
                continue
            places[name] = place
            fact, more = read_fact(name, item, file)
            reader.problems += more
            if fact is not None:
                facts[name] = fact
        attributes += [(name, item, file) for name, item in doc.attributes.items()]
    read, problems = read_attributes(attributes, facts)
    reader.problems += problems
    return Vocabulary(facts.values(), _unique(read)), places


def _unique(attributes: Iterable[Attribute]) -> list[Attribute]:
    return list({item.name: item for item in attributes}.values())


def _key_of(file: SourceFile, *path: str) -> Place:
    node = file.root
    for step in path[:-1]:
        node = node.get(step) if isinstance(node, MappingNode) else None
    return node.key_place(path[-1]) if isinstance(node, MappingNode) else Place(file.path, 1, 1, 1, 1)


def _twice(name: str, place: Place, first: Place) -> Diagnostic:
    return Diagnostic("R411", "duplicate-fact", "error", f"fact `{name}` is declared twice", place, related=((first, "first declared here"),))


def _read_sections(reader: _Reader, folder: Path, jurisdiction: Jurisdiction) -> list[SectionEntry]:
    found = []
    for path in sorted(folder.glob("*.yaml")):
        if path.name == "outline.yaml":
            continue
        file = reader.read(path)
        doc, problems = parse_document(documents.Section, file)
        reader.problems += problems
        if doc is not None and isinstance(file.root, MappingNode):
            found.append(SectionEntry(doc, file.root, file, jurisdiction))
    return found


def _read_cases(reader: _Reader, folder: Path, jurisdiction: Jurisdiction) -> list[CaseEntry]:
    found = []
    for path in sorted((folder / "cases").glob("*.yaml")):
        file = reader.read(path)
        doc, problems = parse_document(documents.Cases, file)
        reader.problems += problems
        nodes = file.root.get("cases") if doc is not None and isinstance(file.root, MappingNode) else None
        if doc is not None and isinstance(nodes, Sequence):
            pairs = zip(doc.cases, nodes.items, strict=True)
            found += [CaseEntry(item, node, file, jurisdiction) for item, node in pairs if isinstance(node, MappingNode)]
    return found


def _without_duplicates(sections: Iterable[SectionEntry], problems: list[Diagnostic]) -> list[SectionEntry]:
    seen: dict[str, SectionEntry] = {}
    for section in sections:
        first = seen.setdefault(section.id, section)
        if first is not section:
            message = f"section {section.citation} stands in two files"
            related = ((first.place("section"), "also here"),)
            problems.append(Diagnostic("R101", "duplicate-section", "error", message, section.place("section"), related=related))
    return list(seen.values())
