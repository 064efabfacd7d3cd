"""`regdb rule`: show a lint rule's page, or list all that can be found."""

import json
import textwrap
from collections.abc import Iterator
from typing import Annotated, Any

import typer

from regdb.front import FrontError
from regdb_compiler.lint.catalogue import Listed, catalogue
from regdb_compiler.lint.rule import RuleError
from regdb_compiler.lint.selection import nearest

WIDTH = 80


def command(
    rule: Annotated[str | None, typer.Argument(help="A rule's code or name, or a family such as R6; default: all.")] = None,
    format_: Annotated[str, typer.Option("--format", help="text or json.")] = "text",
) -> None:
    if format_ not in {"text", "json"}:
        raise typer.BadParameter(f"{format_!r} is none of: text, json", param_hint="--format")
    try:
        known = catalogue()
    except RuleError as error:
        raise FrontError(str(error)) from error
    one = next((item for item in known if rule is not None and rule.lower() in {item.code.lower(), item.name}), None)
    found = known if rule is None else tuple(item for item in known if item.code.startswith(rule.upper())) if one is None else (one,)
    if not found and rule is not None:
        raise FrontError(f"there is no rule `{rule}`{nearest(rule, [(item.code, item.name) for item in known])}")
    if format_ == "json":
        told = [_told(item) for item in found]
        typer.echo(json.dumps(told[0] if one is not None else {"rules": told}, indent=2, ensure_ascii=False))
    else:
        typer.echo("\n".join(_page(one) if one is not None else _list(found)))


def _list(items: tuple[Listed, ...]) -> Iterator[str]:
    """One line for each, under its family."""
    family = ""
    for item in items:
        if item.family != family:
            family = item.family
            yield f"{item.code[:2]} {family}" if item.code.startswith("R") else family
        fix = f"fix: {item.page.fix_kind}" if item.page.fix_kind else ""
        yield f"  {item.code:<6}{item.name:<31}{item.level:<9}{fix}".rstrip()
    fixable = sum(1 for item in items if item.page.fix_kind)
    yield f"{len(items)} rules, {fixable} with a fix; `regdb rule <code>` shows a page"


def _page(item: Listed) -> Iterator[str]:
    """The page of one."""
    yield f"{item.code} {item.name}  ({item.level}; {item.family})"
    yield ""
    yield from textwrap.wrap(item.page.summary, WIDTH)
    for title, text, is_code in (
        ("Why", item.page.why, False),
        ("Fails", item.page.fails, True),
        ("Passes", item.page.passes, True),
        (f"Fix ({item.page.fix_kind})", item.page.fix, False),
    ):
        if text:
            yield ""
            yield title
            yield from (f"    {line}".rstrip() for line in (text.splitlines() if is_code else textwrap.wrap(text, WIDTH - 4)))
    yield ""
    yield "Allow it in one place, with the reason:"
    yield f"    # regdb: allow {item.name} -- <reason>"


def _told(item: Listed) -> dict[str, Any]:
    page = item.page
    return {
        "code": item.code, "name": item.name, "level": item.level, "family": item.family, "summary": page.summary, "why": page.why,
        "fails": page.fails, "passes": page.passes, "fix": page.fix, "fix_kind": page.fix_kind, "lint": item.is_lint, "origin": item.origin,
    }  # fmt: skip
