"""The front door: knows every command by name and loads it only when it is called."""

from __future__ import annotations

import importlib
import io
import os
import sys
from typing import Any, NamedTuple

import typer
from typer.core import CompletionItem, TyperGroup  # type: ignore[attr-defined]  # typer re-exports the first without saying so
from typer.exceptions import TyperException

from regdb.front import FrontError, told

COMPLETING = "_REGDB_COMPLETE"
"""Set by the shell while it asks for completions; the name is the one typer makes of the program's."""


class Command(NamedTuple):
    """Where a command's function stands, what to install for it, and its line in the help."""

    module: str
    extra: str
    help: str


COMMANDS: dict[str, Command] = {
    "new": Command("regdb_compiler.commands.new", "compiler", "Start a section, a lint rule or a jurisdiction from a scaffold."),
    "lint": Command("regdb_compiler.commands.lint", "compiler", "Check the codes: what cannot be read, contradicts, or looks wrong."),
    "fmt": Command("regdb_compiler.commands.fmt", "compiler", "Write the codes in their canonical form, keeping comments and meaning."),
    "rule": Command("regdb_compiler.commands.rule", "compiler", "Show a lint rule's page, or list the rules."),
    "compile": Command("regdb_compiler.commands.compile", "compiler", "Compile the codes into SQLite, CSV, JSON and a manifest."),
    "test": Command("regdb_compiler.commands.test", "compiler", "Run the law's own tests, with coverage."),
    "coverage": Command("regdb_compiler.commands.coverage", "compiler", "Say of every section of the codes whether it is encoded, and why not."),
    "show": Command("regdb_compiler.commands.show", "compiler", "Show a section, regulation, fact or state."),
    "search": Command("regdb_compiler.commands.search", "compiler", "Search the law by words."),
    "chain": Command("regdb_compiler.commands.chain", "compiler", "Print what displaces a regulation and what it displaces."),
    "diff": Command("regdb_compiler.commands.diff", "compiler", "Compare two dates, jurisdictions, folders or databases by field."),
    "text": Command("regdb_compiler.commands.text", "compiler", "Keep official text beside the codes and check the quotes against it."),
    "schema": Command("regdb_compiler.commands.schema", "compiler", "Print or write the JSON Schema of the file formats."),
    "check": Command("regdb_runtime.commands.check", "", "Ask whether a manoeuvre is lawful in a scene."),
    "explain": Command("regdb_runtime.commands.explain", "", "Say why a verdict is as it is, and what would turn it."),
    "match": Command("regdb_runtime.commands.match", "", "Say which facts a text about a driving scene states, and by which words."),
    "drive": Command("regdb_runtime.commands.drive", "", "Drive the paper's experiment and its variants by the law in the database."),
    "doctor": Command("regdb.doctor", "", "Report what is installed, which codes are found, and what is missing."),
    "demo": Command("regdb.demo", "compiler", "Lint, test, compile, decide the paper's situations and drive its experiment."),
}


class LazyGroup(TyperGroup):
    """A group whose commands are imported when they are called."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002
        known = COMMANDS.get(cmd_name)
        return None if known is None else _load(cmd_name, known)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """As typer resolves it, with the nearest name for one that is not there; typer knows no lazy names."""
        try:
            return super().resolve_command(ctx, args)
        except TyperException as error:
            import difflib  # a tenth of the time of `--help`, for those who mistype only

            near = difflib.get_close_matches(args[0], COMMANDS, 1) if args else []
            if near and hasattr(error, "message"):
                error.message = f"{error.message.rstrip('.')}; did you mean {near[0]}?"
            raise

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        """Names from the table, without loading the commands that bear them."""
        found = [CompletionItem(name, help=command.help) for name, command in COMMANDS.items() if name.startswith(incomplete)]
        return [*found, *super(TyperGroup, self).shell_complete(ctx, incomplete)]

    def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002
        with formatter.section("Commands"):
            formatter.write_dl([(name, command.help) for name, command in COMMANDS.items()])


def _load(name: str, known: Command) -> Any:
    try:
        module = importlib.import_module(known.module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("regdb"):
            raise
        package = f"'regdb[{known.extra}]'" if known.extra else "regdb"
        raise FrontError(f"`regdb {name}` needs {error.name}, which is not installed; type: pip install {package}") from error
    app = typer.Typer(add_completion=False, rich_markup_mode=None)
    app.command(name, help=known.help)(module.command)
    found = typer.main.get_command(app)
    found.name = name
    return _without_conversion(found)


def _without_conversion(command: Any) -> Any:
    """While the shell completes, leave option values as typed: converting them would load pydantic, half of the time taken."""
    if COMPLETING in os.environ:
        command.add_help_option = False
        for parameter in command.params:
            parameter.process_value = lambda _, value: value
    return command


app = typer.Typer(
    name="regdb",
    cls=LazyGroup,
    help="Traffic law written once: linted, tested, compiled, and driven by.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback(invoke_without_command=True)
def _root(
    ctx: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and stop."),  # noqa: FBT003
) -> None:
    if version:
        from regdb.version import VERSION

        typer.echo(f"regdb {VERSION}")
    elif ctx.invoked_subcommand is None:
        typer.echo(ctx.get_help())


def main(arguments: list[str] | None = None) -> None:
    """Run a command line. Exit codes: 0 fine, 1 findings, 2 usage or unreadable input, 70 our own error."""
    command = _without_conversion(typer.main.get_command(app))
    try:
        code = command.main(args=arguments, prog_name="regdb", standalone_mode=False)
    except TyperException as error:
        usage: Any = error  # every error typer raises can show itself; its base class does not say so
        shown = io.StringIO()
        usage.show(file=shown)
        typer.echo(told(shown.getvalue()), err=True, nl=False)
        code = 2
    except (typer.Abort, KeyboardInterrupt):
        code = 130
    except typer.Exit as error:
        code = error.exit_code
    except FrontError as error:
        typer.echo(told(f"error: {error}"), err=True)
        code = 2
    except BrokenPipeError:
        code = 0
    except Exception as error:  # noqa: BLE001  # the last line of defence: report, never a traceback
        from regdb.crash import report_crash

        typer.echo(report_crash(error), err=True)
        code = 70
    sys.stdout.flush()
    sys.exit(code if isinstance(code, int) else 0)
