"""Scaffolds of a section, a lint rule and a jurisdiction: files that lint and test cleanly before anyone has touched them."""

from __future__ import annotations

import datetime
import json
import re
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from regdb.citation import CitationError, parse_citation
from regdb.front import FrontError
from regdb_compiler.corpus import Corpus

FIRST_DAY = "1959-09-18"
"""A day before every text this project dates: the effective date of a section whose own is not known yet."""


@dataclass(frozen=True, slots=True)
class Scaffold:
    """A file to write: where, what, and whether it is added to one that is there."""

    path: Path
    text: str
    append: bool = False


def _render(template: str, **values: object) -> str:
    environment = Environment(
        loader=PackageLoader("regdb_compiler", "templates"), undefined=StrictUndefined, keep_trailing_newline=True, autoescape=False
    )
    return environment.get_template(template).render(**values)


def section_scaffold(corpus: Corpus, citation: str, title: str, topic: str) -> Scaffold:
    """A section's file. Raises FrontError when the code is not known or the section is there already."""
    try:
        cited = parse_citation(citation)
    except CitationError as error:
        raise FrontError(str(error)) from None
    found = next((item for item in corpus.tree if item.short.upper() == cited.code.upper()), None)
    if found is None:
        raise FrontError(f"no code is cited as {cited.code}; known: {', '.join(sorted(item.short for item in corpus.tree))}")
    path = corpus.root / found.code / f"{cited.section}.yaml"
    if path.exists():
        raise FrontError(f"{path} is there already")
    fact = next((item.name for item in corpus.vocabulary if item.kind == "boolean" and item.source == "perception"), "sign.stop")
    text = _render(
        "section.yaml.j2", section=cited.section, title=json.dumps(title or f"Section {cited.section}", ensure_ascii=False),
        location="Division, Chapter, Article",
        topic=topic or f"section-{re.sub(r'[^0-9a-z]+', '-', cited.section)}", today=datetime.date.today().isoformat(),
        effective=FIRST_DAY, fact=fact, example=fact, current="lane_following", next="lane_following",
        current_state="lane_following.go_straight", next_state="lane_following.go_straight",
    )  # fmt: skip
    return Scaffold(path, text)


def jurisdiction_scaffold(corpus: Corpus, name: str, kind: str, parent: str, short: str) -> Scaffold:
    """An entry for jurisdictions.yaml. Raises FrontError when the id is taken or the parent is not there."""
    slug = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
    if not slug:
        raise FrontError(f"{name!r} is no name for a jurisdiction")
    if slug in corpus.tree:
        raise FrontError(f"there is a jurisdiction {slug!r} already")
    if parent not in corpus.tree:
        raise FrontError(f"no jurisdiction {parent!r}; known: {', '.join(sorted(item.id for item in corpus.tree))}")
    if kind not in {"state", "county", "city", "district"}:
        raise FrontError(f"a jurisdiction is a state, county, city or district, not {kind!r}")
    initials = "".join(word[0] for word in re.findall(r"[A-Za-z]+", name)).upper()
    values = {"id": slug, "name": name, "kind": kind, "parent": corpus.tree.get(parent).id, "code": slug, "short": short or f"{initials}C"}
    return Scaffold(corpus.root / "jurisdictions.yaml", _render("jurisdiction.yaml.j2", **values), append=True)


def rule_scaffold(folder: Path, name: str, code: str) -> Scaffold:
    """A lint rule's module in a folder. Raises FrontError for a name or code of the wrong form, or a file that is there."""
    if not re.fullmatch(r"[a-z]+(?:-[a-z]+)*", name):
        raise FrontError(f"a lint rule is named for its offence in small words: quote-too-long, not {name!r}")
    if not re.fullmatch(r"[A-Z]{1,4}\d{3,4}", code):
        raise FrontError(f"a rule's code is capitals and digits, such as R931 or ACME101, not {code!r}")
    path = folder / f"{name.replace('-', '_')}.py"
    if path.exists():
        raise FrontError(f"{path} is there already")
    sentence = f"{name.replace('-', ' ').capitalize()}: say in one sentence what the rule finds"
    return Scaffold(path, _render("rule.py.j2", sentence=sentence, code=code, name=name))
