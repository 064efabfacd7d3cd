"""`regdb new`: start a section, a jurisdiction or a lint rule from a scaffold."""

from pathlib import Path
from typing import Annotated

import typer

from regdb.front import FrontError, codes_folder
from regdb_compiler.fixes import write_beside
from regdb_compiler.read_corpus import read_corpus
from regdb_compiler.scaffold import Scaffold, jurisdiction_scaffold, rule_scaffold, section_scaffold


def command(
    kind: Annotated[str, typer.Argument(help="section, jurisdiction or rule.")],
    name: Annotated[list[str], typer.Argument(help="A citation (CVC 21453), a jurisdiction's name, or a rule's name.")],
    codes: Annotated[Path | None, typer.Option(help="Folder of codes.")] = None,
    title: Annotated[str, typer.Option(help="section: its title.")] = "",
    topic: Annotated[str, typer.Option(help="section: the topic that aligns it with other codes.")] = "",
    level: Annotated[str, typer.Option("--kind", help="jurisdiction: state, county, city or district.")] = "city",
    parent: Annotated[str, typer.Option(help="jurisdiction: the one above it.")] = "california",
    short: Annotated[str, typer.Option(help="jurisdiction: how its code is cited, such as SMMC.")] = "",
    code: Annotated[str, typer.Option(help="rule: its code.")] = "R999",
    into: Annotated[Path, typer.Option(help="rule: the folder for its module.")] = Path(),
) -> None:
    words = " ".join(name)
    if kind == "rule":
        scaffold = rule_scaffold(into, words, code)
    elif kind in {"section", "jurisdiction"}:
        corpus = read_corpus(codes_folder(codes))
        made = section_scaffold(corpus, words, title, topic) if kind == "section" else None
        scaffold = made or jurisdiction_scaffold(corpus, words, level, parent, short)
    else:
        raise FrontError(f"`regdb new` makes a section, a jurisdiction or a rule, not {kind!r}")
    _write(scaffold)
    path = _from_here(scaffold.path)
    typer.echo(f"{'added to' if scaffold.append else 'wrote'} {path}")
    if kind == "section":
        typer.echo(f"next: edit it, then  regdb lint {path}  and  regdb test {path}")
    elif kind == "jurisdiction":
        folder = path.parent / words.lower().replace(" ", "_")
        typer.echo(f"next: put its sections into {folder}/")


def _from_here(path: Path) -> Path:
    """The path as somebody in this folder would type it."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def _write(scaffold: Scaffold) -> None:
    try:
        before = scaffold.path.read_text("utf-8") if scaffold.append else ""
        scaffold.path.parent.mkdir(parents=True, exist_ok=True)
        write_beside(scaffold.path, before.rstrip("\n") + scaffold.text if before else scaffold.text)
    except OSError as error:
        raise FrontError(f"{scaffold.path} cannot be written: {error.strerror}") from error
