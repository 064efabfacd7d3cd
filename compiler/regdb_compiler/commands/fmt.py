"""`regdb fmt`: write the codes in their canonical form."""

import difflib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer
from pydantic import BaseModel

from regdb.front import FrontError, codes_folder, told
from regdb_compiler.fixes import write_beside
from regdb_compiler.fmt import format_text, model_of


def command(
    paths: Annotated[list[Path] | None, typer.Argument(help="Files or folders; default: all of the codes.")] = None,
    codes: Annotated[Path | None, typer.Option(help="Folder of codes.")] = None,
    check: Annotated[bool, typer.Option("--check", help="Write nothing; exit 1 if something would change.")] = False,
    diff: Annotated[bool, typer.Option("--diff", help="Write nothing; show what would change.")] = False,
) -> None:
    root = codes_folder(codes).resolve()
    changed, left = 0, 0
    for path, model in _files(root, [path.resolve() for path in paths or ()]):
        name = str(path.relative_to(root.parent))
        try:
            text = path.read_text("utf-8")
        except OSError as error:
            raise FrontError(f"{name} cannot be read: {error.strerror}") from error
        except UnicodeDecodeError:
            raise FrontError(f"{name} is not UTF-8 text") from None
        result = format_text(text, model)
        if result.problem:
            left += 1
            typer.echo(told(f"{name}: left as it is: {result.problem}"), err=True)
        elif result.text != text:
            changed += 1
            _act(path, name, text, result.text, write=not (check or diff), show=diff)
    word = "would change" if check or diff else "changed"
    files = f"{changed} {'file' if changed == 1 else 'files'}"
    typer.echo(f"{files} {word}" + (f", {left} left as {'it is' if left == 1 else 'they are'}" if left else ""), err=diff)
    raise typer.Exit(2 if left else 1 if changed and (check or diff) else 0)


def _act(path: Path, name: str, old: str, new: str, *, write: bool, show: bool) -> None:
    if write:
        write_beside(path, new)
    elif show:
        typer.echo("\n".join(difflib.unified_diff(old.splitlines(), new.splitlines(), name, name, lineterm="")))
    else:
        typer.echo(name)


def _files(root: Path, wanted: list[Path]) -> Iterator[tuple[Path, type[BaseModel]]]:
    for path in wanted:
        if not path.exists():
            raise FrontError(f"{path} is not there")
        if root != path and root not in path.parents:
            raise FrontError(f"{path} is not in the codes folder {root}; name the folder with `--codes DIR`")
    for path in sorted(root.rglob("*.yaml")):
        model = model_of(path.relative_to(root).parts)
        inside = not wanted or any(path == one or one in path.parents for one in wanted)
        if model is not None and inside:
            yield path, model
