"""Parts of the vocabulary as written: the confusables of every fact, each with its node."""

from __future__ import annotations

from collections.abc import Iterator

from regdb.vocabulary import Fact
from regdb_compiler.corpus import Corpus
from regdb_compiler.parse import node_at
from regdb_compiler.source import Mapping, Node, Sequence


def fact_nodes(corpus: Corpus) -> Iterator[tuple[Fact, Mapping]]:
    """Every declared fact with the mapping that declares it."""
    for path in dict.fromkeys(place.path for place in corpus.fact_places.values()):
        file = corpus.files.get(path)
        facts = node_at(file.root, ("facts",)) if file is not None and file.root is not None else None
        for name, node in facts.entries if isinstance(facts, Mapping) else ():
            fact = corpus.vocabulary.facts.get(name.text)
            if fact is not None and isinstance(node, Mapping):
                yield fact, node


def confusables(corpus: Corpus) -> Iterator[tuple[Fact, str, Node]]:
    """Every confusable that is declared: the fact, the other's name (or name=value), and where it is written."""
    for fact, node in fact_nodes(corpus):
        if fact.confusables:
            written = node.get("confusables")
            items = written.items if isinstance(written, Sequence) else (written,) if written is not None else ()
            for text, item in zip(fact.confusables, items, strict=False):
                yield fact, text, item
