"""A codes folder and the folders added to it -> the corpus; whatever cannot be read is a diagnostic of the corpus."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from regdb.front import FrontError, added_codes
from regdb.jurisdiction import Jurisdiction, JurisdictionTree
from regdb.states import StateMachine
from regdb.vocabulary import Fact, Vocabulary
from regdb_compiler import documents
from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.documents.interpretation import InterpretationFile
from regdb_compiler.entries import CaseEntry, OutlineEntry, SectionEntry
from regdb_compiler.parse import parse_document
from regdb_compiler.read_fusion import FusionReader
from regdb_compiler.read_interpretations import InterpretationEntry, read_interpretation
from regdb_compiler.read_vocabulary import jurisdictions_of, read_attributes, read_fact, read_jurisdictions, read_states, word_problems
from regdb_compiler.source import Mapping as MappingNode
from regdb_compiler.source import Sequence as SequenceNode
from regdb_compiler.source import SourceFile, read_source

CORPUS_RULES = (
    ("R101", "duplicate-section", "Two files hold the same section of one code; all its versions belong in one file."),
    ("R103", "unknown-code", "A folder of sections that no jurisdiction names as its code."),
)


class _Reader:
    """Collects files and problems while the folders are read: the codes, then what is added to them."""

    def __init__(self, root: Path, added: tuple[Path, ...] = ()) -> None:
        self.root, self.added, self.folders = root, added, (root, *added)
        self.files: dict[str, SourceFile] = {}
        self.problems: list[Diagnostic] = []
        self.unread: set[str] = set()

    def read(self, path: Path) -> SourceFile:
        base = next(folder.parent for folder in self.folders if path.is_relative_to(folder))
        file = read_source(path, base)
        self.files[file.path] = file
        self.problems += file.diagnostics
        return file


def read_corpus(codes: Path, added: Sequence[Path] | None = None) -> Corpus:
    """Read a codes folder and what is added to it (by default, what is installed: `regdb.front.added_codes`).

    Never raises for what is in the folders: problems are the corpus's diagnostics. Raises FrontError for a folder added
    that is not there or bears the name of another.
    """
    codes = codes.resolve()
    reader = _Reader(codes, tuple(folder.resolve() for folder in (added_codes() if added is None else added)))
    _refuse_like_names(reader.folders)
    tree = _read_tree(reader)
    machine = _read_machine(reader)
    vocabulary, places = _read_vocabulary(reader)
    sections: list[SectionEntry] = []
    cases: list[CaseEntry] = []
    outlines: list[OutlineEntry] = []
    for folder, jurisdiction in _code_folders(reader, tree):
        sections += _read_sections(reader, folder, jurisdiction)
        cases += _read_cases(reader, folder, jurisdiction)
        outlines += _read_outline(reader, folder, jurisdiction)
    sections = _without_duplicates(sections, reader.problems)
    interpretations = _read_interpretations(reader, vocabulary)
    return Corpus(
        codes, reader.files, vocabulary, machine, tree, tuple(sections), tuple(cases), places, tuple(reader.problems),
        frozenset(reader.unread), reader.added, tuple(outlines), interpretations,
    )  # fmt: skip


def _refuse_like_names(folders: Sequence[Path]) -> None:
    """Files are told apart by the name of their folder, in findings and manifests, so that these do not depend on the machine."""
    seen: dict[str, Path] = {}
    for folder in folders:
        if folder.name in seen:
            raise FrontError(f"{folder} cannot be added to {seen[folder.name]}: the two folders have the same name")
        seen[folder.name] = folder


def _code_folders(reader: _Reader, tree: JurisdictionTree) -> Iterator[tuple[Path, Jurisdiction]]:
    """Every folder of sections with the jurisdiction whose code it is; none where there are no jurisdictions at all."""
    if not tuple(tree):
        return
    for root in reader.folders:
        for folder in sorted(path for path in root.iterdir() if path.is_dir()) if root.is_dir() else ():
            if folder.name in {"vocabulary", "interpretations", "schema"} or folder.name.startswith((".", "_")):
                continue
            jurisdiction = tree.get(folder.name) if folder.name in tree else None
            if jurisdiction is not None and jurisdiction.code == folder.name:
                yield folder, jurisdiction
                continue
            known = ", ".join(sorted(item.code for item in tree))
            place = Place(f"{root.name}/{folder.name}", 1, 1, 1, 1)
            message = f"no jurisdiction has the code `{folder.name}`"
            reader.problems.append(Diagnostic("R103", "unknown-code", "error", message, place, note=f"codes: {known}"))


def _read_tree(reader: _Reader) -> JurisdictionTree:
    file = reader.read(reader.root / "jurisdictions.yaml")
    doc, problems = parse_document(documents.JurisdictionsFile, file)
    tree, more = read_jurisdictions(doc, file) if doc is not None else (None, [])
    reader.problems += [*problems, *more]
    return _with_added(reader, tree or JurisdictionTree([]), file)


def _with_added(reader: _Reader, tree: JurisdictionTree, first: SourceFile) -> JurisdictionTree:
    """The tree with the jurisdictions of the folders added; what is declared twice or hangs in the air is reported and left out."""
    places = {name: _key_of(first, "jurisdictions", item.id) for item in tree for name in (item.id, item.code)}
    for folder in reader.added:
        if not (folder / "jurisdictions.yaml").exists():
            continue
        file = reader.read(folder / "jurisdictions.yaml")
        doc, problems = parse_document(documents.JurisdictionsFile, file)
        reader.problems += problems
        for item in jurisdictions_of(doc) if doc is not None else ():
            place = _key_of(file, "jurisdictions", item.id)
            clash = places.get(item.id) or places.get(item.code)
            if clash is not None:
                message, related = f"jurisdiction `{item.id}` or its code `{item.code}` is declared twice", ((clash, "first declared here"),)
                reader.problems.append(Diagnostic("R110", "bad-jurisdiction", "error", message, place, related=related))
            elif item.parent is not None and item.parent not in {other.id for other in tree}:
                message = f"jurisdiction `{item.id}` names a parent `{item.parent}` that is not declared before it"
                reader.problems.append(Diagnostic("R110", "bad-jurisdiction", "error", message, place))
            else:
                places[item.id] = places[item.code] = place
                tree = JurisdictionTree([*tree, item])
    return tree


def _read_machine(reader: _Reader) -> StateMachine:
    file = reader.read(reader.root / "states.yaml")
    doc, problems = parse_document(documents.StatesFile, file)
    machine, more = read_states(doc, file) if doc is not None else (None, [])
    reader.problems += [*problems, *more]
    for folder in reader.added:
        if (folder / "states.yaml").exists():
            place = Place(f"{folder.name}/states.yaml", 1, 1, 1, 1)
            message = "a folder added to the codes cannot change the state machine"
            reader.problems.append(Diagnostic("R420", "bad-state-machine", "error", message, place))
    return machine or StateMachine([], [], "")


def _read_vocabulary(reader: _Reader) -> tuple[Vocabulary, dict[str, Place]]:
    facts: dict[str, Fact] = {}
    places: dict[str, Place] = {}
    bounded: dict[str, Place] = {}
    attributes: list[tuple[str, documents.Attribute, SourceFile]] = []
    words: dict[str, tuple[str, ...]] = {}
    fusion = FusionReader()
    for path in (path for folder in reader.folders for path in sorted((folder / "vocabulary").glob("*.yaml"))):
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
        for name, attribute in doc.attributes.items():
            place = _key_of(file, "attributes", name)
            if (first := bounded.setdefault(name, place)) != place:
                reader.problems.append(_twice(name, place, first, "attribute"))
                continue
            attributes.append((name, attribute, file))
        fusion.take(doc, file, {name for name in doc.facts if name in facts and places[name].path == file.path})
        for name, members in doc.words.items():
            words[name] = (*words.get(name, ()), *members)
    read, problems = read_attributes(attributes, facts)
    reader.problems += problems
    facts, problems = fusion.complete(facts)
    reader.problems += [*problems, *word_problems(facts, words, places)]
    return Vocabulary(facts.values(), read, words), places


def _key_of(file: SourceFile, *path: str) -> Place:
    node = file.root
    for step in path[:-1]:
        node = node.get(step) if isinstance(node, MappingNode) else None
    return node.key_place(path[-1]) if isinstance(node, MappingNode) else Place(file.path, 1, 1, 1, 1)


def _twice(name: str, place: Place, first: Place, kind: str = "fact") -> Diagnostic:
    return Diagnostic("R411", "duplicate-fact", "error", f"{kind} `{name}` is declared twice", place, related=((first, "first declared here"),))


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
        else:
            reader.unread.add(f"{jurisdiction.code}-{path.stem}")
    return found


def _read_cases(reader: _Reader, folder: Path, jurisdiction: Jurisdiction) -> list[CaseEntry]:
    found = []
    for path in sorted((folder / "cases").glob("*.yaml")):
        file = reader.read(path)
        doc, problems = parse_document(documents.Cases, file)
        reader.problems += problems
        nodes = file.root.get("cases") if doc is not None and isinstance(file.root, MappingNode) else None
        if doc is not None and isinstance(nodes, SequenceNode):
            pairs = zip(doc.cases, nodes.items, strict=True)
            found += [CaseEntry(item, node, file, jurisdiction) for item, node in pairs if isinstance(node, MappingNode)]
    return found


def _read_outline(reader: _Reader, folder: Path, jurisdiction: Jurisdiction) -> list[OutlineEntry]:
    path = folder / "outline.yaml"
    if not path.is_file():
        return []
    file = reader.read(path)
    doc, problems = parse_document(documents.Outline, file)
    reader.problems += problems
    return [OutlineEntry(doc, file.root, file, jurisdiction)] if doc is not None and isinstance(file.root, MappingNode) else []


def _read_interpretations(reader: _Reader, vocabulary: Vocabulary) -> tuple[InterpretationEntry, ...]:
    """Every profile by name; none where there is no vocabulary, since all facts would be missing."""
    found: dict[str, InterpretationEntry] = {}
    for path in (path for folder in reader.folders for path in sorted((folder / "interpretations").glob("*.yaml"))):
        file = reader.read(path)
        doc, problems = parse_document(InterpretationFile, file)
        reader.problems += problems
        if doc is None or not len(vocabulary):
            continue
        entry, problems = read_interpretation(doc, file, vocabulary)
        reader.problems += problems
        first = found.setdefault(entry.profile.name, entry)
        if first is not entry:
            related = ((first.place("interpretation"), "first declared here"),)
            message = f"interpretation `{entry.profile.name}` is declared twice"
            reader.problems.append(Diagnostic("R450", "bad-interpretation", "error", message, entry.place("interpretation"), related=related))
    return tuple(found[name] for name in sorted(found))


def _without_duplicates(sections: Iterable[SectionEntry], problems: list[Diagnostic]) -> list[SectionEntry]:
    seen: dict[str, SectionEntry] = {}
    for section in sections:
        first = seen.setdefault(section.id, section)
        if first is not section:
            message = f"section {section.citation} stands in two files"
            related = ((first.place("section"), "also here"),)
            problems.append(Diagnostic("R101", "duplicate-section", "error", message, section.place("section"), related=related))
    return list(seen.values())
