"""All law of a codes folder, frozen and indexed: vocabulary, states, jurisdictions, sections, cases, with every reading problem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from regdb.jurisdiction import JurisdictionTree
from regdb.states import StateMachine
from regdb.vocabulary import Vocabulary
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.entries import CaseEntry, OutlineEntry, RegulationEntry, SectionEntry, VersionEntry
from regdb_compiler.read_interpretations import InterpretationEntry
from regdb_compiler.source import SourceFile


@dataclass(frozen=True)
class Corpus:
    """Everything that was read. `diagnostics` are the reading problems; sections that could not be read are left out,
    their ids (by the names of their files) are `unread`. `added` are the folders merged into the codes; names of files
    begin with the name of the folder that they stand in."""

    root: Path
    files: Mapping[str, SourceFile]
    vocabulary: Vocabulary
    machine: StateMachine
    tree: JurisdictionTree
    sections: tuple[SectionEntry, ...]
    cases: tuple[CaseEntry, ...]
    fact_places: Mapping[str, Place] = field(default_factory=dict)
    diagnostics: tuple[Diagnostic, ...] = ()
    unread: frozenset[str] = frozenset()
    added: tuple[Path, ...] = ()
    outlines: tuple[OutlineEntry, ...] = ()
    interpretations: tuple[InterpretationEntry, ...] = ()

    @property
    def has_language(self) -> bool:
        """Whether vocabulary, states and jurisdictions are sound; without them nothing else can be judged."""
        parts = ("vocabulary/", "states.yaml", "jurisdictions.yaml")
        inner = tuple(f"{folder.name}/{part}" for folder in (self.root, *self.added) for part in parts)
        return not any(item.level == "error" and item.place.path.startswith(inner) for item in self.diagnostics)

    def leaves_out(self, name: str) -> bool:
        """Whether a regulation or section of this id may stand in a file that could not be read."""
        return any(name == section or name.startswith(f"{section}-") for section in self.unread)

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
