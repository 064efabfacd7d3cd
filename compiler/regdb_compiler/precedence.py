"""What displaces what: targets of exceptions and overrides led to ids, cycles refused, permissions made to name their rule."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from regdb.citation import section_key
from regdb_compiler.corpus import Corpus
from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.entries import RegulationEntry

PRECEDENCE_RULES = (
    ("R607", "override-not-ancestor", "An override names a rule of a jurisdiction that does not stand above its own."),
    ("R608", "permission-without-target", "A permission is law only as an exception to a prohibition, which it must name."),
    ("R609", "unknown-target", "An exception or override names a regulation, tag or topic that is not there."),
    ("R610", "exception-cycle", "Regulations displace each other in a circle, so none of them means anything."),
    ("R611", "exception-across-codes", "exception_to names rules of the same code; a rule of an ancestor is displaced by overrides."),
)


@dataclass
class Targets:
    """Regulation entry -> the ids it displaces, in order, as (id, kind); and the problems found."""

    of: dict[RegulationEntry, tuple[tuple[str, str], ...]] = field(default_factory=dict)
    problems: list[Diagnostic] = field(default_factory=list)


def find_targets(corpus: Corpus) -> Targets:
    """Lead every exception_to and overrides to ids; refuse what is not there and circles."""
    index = _Index(corpus)
    targets = Targets()
    for entry in corpus.regulations:
        pairs: dict[str, str] = {}
        for kind, names in (("exception_to", entry.doc.exception_to), ("overrides", entry.doc.overrides)):
            for position, name in enumerate(names):
                found, problem = index.lead(entry, kind, name, position)
                targets.problems += [problem] if problem else []
                pairs.update((target, kind) for target in found)
        targets.of[entry] = tuple(pairs.items())
        if entry.doc.legality and not entry.doc.exception_to and not entry.doc.overrides:
            message = f"{entry.id} permits something, but names no prohibition that it is an exception to"
            note = "add `exception_to: [...]`"
            targets.problems.append(
                Diagnostic("R608", "permission-without-target", "error", message, entry.place("legality"), note=note, law=str(entry.citation))
            )
    targets.problems += _cycles(corpus, targets)
    return targets


class _Index:
    """Ids, tags and topics of the corpus."""

    def __init__(self, corpus: Corpus) -> None:
        self.corpus = corpus
        self.by_tag: dict[str, list[RegulationEntry]] = {}
        self.by_topic: dict[str, list[RegulationEntry]] = {}
        for entry in corpus.regulations:
            self.by_topic.setdefault(entry.topic, []).append(entry)
            for tag in entry.doc.tags:
                self.by_tag.setdefault(tag, []).append(entry)

    def lead(self, entry: RegulationEntry, kind: str, name: str, position: int) -> tuple[list[str], Diagnostic | None]:
        """The ids one name stands for, or why it stands for none."""
        group, _, word = name.partition(":")
        if group in {"tag", "topic"} and word:
            table = self.by_tag if group == "tag" else self.by_topic
            found = sorted({other.id for other in table.get(word, ()) if other.id != entry.id and self._reaches(entry, other, kind)})
            silent = bool(found or self.corpus.unread)
            return (found, None) if silent else ([], self._unknown(entry, kind, name, position, sorted(table)))
        full = next((i for i in (f"{entry.section.id}-{name}", f"{entry.jurisdiction.code}-{name}", name) if i in self.corpus.by_id), None)
        if full is None and self._is_unread(entry, name):
            return [], None
        if full is None:
            return [], self._unknown(entry, kind, name, position, sorted(self.corpus.by_id))
        problem = self._side(entry, self.corpus.by_id[full][0], kind, position)
        return ([], problem) if problem else ([full], None)

    def _is_unread(self, entry: RegulationEntry, name: str) -> bool:
        """Whether the name may be one of a section that could not be read, whose own problem is told already."""
        return self.corpus.leaves_out(name) or self.corpus.leaves_out(f"{entry.jurisdiction.code}-{name}")

    def _reaches(self, entry: RegulationEntry, other: RegulationEntry, kind: str) -> bool:
        """A group exception displaces its own jurisdiction's rules and those below (a model's only its own); a group override those above."""
        tree, own, theirs = self.corpus.tree, entry.jurisdiction, other.jurisdiction
        if kind == "overrides":
            return tree.is_ancestor(theirs.id, own.id)
        return own is theirs or (own.status != "model" and tree.is_ancestor(own.id, theirs.id))

    def _side(self, entry: RegulationEntry, target: RegulationEntry, kind: str, position: int) -> Diagnostic | None:
        own, theirs = entry.jurisdiction, target.jurisdiction
        place = entry.place(kind, position)
        if kind == "overrides" and not self.corpus.tree.is_ancestor(theirs.id, own.id):
            message = f"{target.id} belongs to {theirs.name}, which does not stand above {own.name}"
            return Diagnostic("R607", "override-not-ancestor", "error", message, place, law=str(entry.citation))
        if kind == "exception_to" and own.id != theirs.id:
            message = f"{target.id} belongs to another code ({theirs.short})"
            note = "a local rule displaces it by `overrides`, with `authority`"
            return Diagnostic("R611", "exception-across-codes", "error", message, place, note=note, law=str(entry.citation))
        return None

    def _unknown(self, entry: RegulationEntry, kind: str, name: str, position: int, known: list[str]) -> Diagnostic:
        import difflib

        near = difflib.get_close_matches(name.partition(":")[2] or f"{entry.section.id}-{name}", known, 1, 0.6)
        note = f"did you mean {near[0]}?" if near else "no regulation has it"
        message = f"`{kind}` names `{name}`, which is not there"
        return Diagnostic("R609", "unknown-target", "error", message, entry.place(kind, position), note=note, law=str(entry.citation))


def _cycles(corpus: Corpus, targets: Targets) -> Iterator[Diagnostic]:
    """One finding per circle, at its first regulation in citation order."""
    edges: dict[str, tuple[str, ...]] = {}
    for entry, pairs in targets.of.items():
        edges[entry.id] = tuple(dict.fromkeys((*edges.get(entry.id, ()), *(target for target, _ in pairs))))
    for circle in _circles(edges):
        entry = corpus.by_id[circle[0]][0]
        kind = "exception_to" if entry.doc.exception_to else "overrides"
        message = "regulations displace each other in a circle: " + " -> ".join([*circle, circle[0]])
        related = tuple((corpus.by_id[name][0].place("id"), "part of the circle") for name in circle[1:])
        yield Diagnostic("R610", "exception-cycle", "error", message, entry.place(kind), related=related, law=str(entry.citation))


def _circles(edges: dict[str, tuple[str, ...]]) -> list[list[str]]:
    """The circles of a relation, each once, found by an iterative depth-first walk."""
    state: dict[str, int] = {}
    circles: dict[frozenset[str], list[str]] = {}
    for root in sorted(edges, key=section_key):
        path: list[str] = []
        stack: list[tuple[str, bool]] = [(root, False)]
        while stack:
            name, leaving = stack.pop()
            if leaving:
                state[name] = 2
                path.pop()
            elif state.get(name) == 1:
                circle = path[path.index(name) :]
                first = circle.index(min(circle, key=section_key))
                circles.setdefault(frozenset(circle), circle[first:] + circle[:first])
            elif name not in state:
                state[name] = 1
                path.append(name)
                stack.append((name, True))
                stack += [(target, False) for target in edges.get(name, ())]
    return list(circles.values())
