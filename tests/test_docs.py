"""The documentation is true: its commands answer as shown, its programs run, its links lead somewhere, its generated pages are fresh.

`pytest tests/test_docs.py --rewrite-golden` writes into the pages what the commands answer now, save where a page shows `...`.
"""

from __future__ import annotations

import os
import re
import runpy
import shutil
import sqlite3
import subprocess
import sys
import tomllib
from contextlib import closing
from pathlib import Path

import pytest
import yaml
from doc_blocks import Block, Step, edited, in_place, is_shown, read_blocks, read_steps
from regdb_compiler.lint.catalogue import FAMILIES
from regdb_compiler.parse_condition import parse_condition
from regdb_compiler.read_corpus import read_corpus

from regdb.cli import COMMANDS
from regdb.units import UNITS

ROOT = Path(__file__).resolve().parents[1]
GENERATOR = ROOT / "docs" / "generate.py"
GENERATED = tuple(runpy.run_path(str(GENERATOR))["GENERATED"])
WRITTEN = sorted(path for path in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")] if path.name not in GENERATED)
EXECUTED = [path for path in WRITTEN if any(block.language in {"console", "python", "sql"} for block in read_blocks(path.read_text("utf-8")))]
CONDITIONS = ROOT / "docs" / "reference" / "conditions.md"
WIDTH = 80
_LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")
_HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


class Reader:
    """Somebody who does what a page says, in an empty folder with a copy of the shipped codes."""

    def __init__(self, page: Path, folder: Path, cache: Path) -> None:
        self.page, self.folder, self.text = page, folder, page.read_text("utf-8")
        tools = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        width = {"COLUMNS": str(WIDTH), "TERMINAL_WIDTH": str(WIDTH), "NO_COLOR": "1"}
        self.environment = {**os.environ, **width, "PATH": tools, "XDG_CACHE_HOME": str(cache)}
        self.wrong: list[str] = []
        self.rewritten: list[tuple[Block, Step, str]] = []

    def follow(self) -> None:
        """Do every block in order."""
        blocks = read_blocks(self.text)
        for block, after in zip(blocks, [*blocks[1:], None], strict=True):
            task, rest = block.task
            if task in {"file", "append", "edit"}:
                self._write(task, self.folder / rest, block)
            elif task == "" and block.language == "console":
                for step in read_steps(block.text):
                    self._run(block, step)
            elif task == "" and block.language == "python":
                self._python(block, after if after is not None and after.note == "output" else None)
            elif task == "" and block.language == "sql":
                self._query(block)

    def _write(self, task: str, path: Path, block: Block) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        before = path.read_text("utf-8") if task != "file" else ""
        path.write_text(edited(before, block.text) if task == "edit" else before + block.text, "utf-8")

    def _run(self, block: Block, step: Step) -> None:
        told = self._call(["bash", "-c", step.command])
        answer = in_place(told.stdout if told.stdout.strip() else told.stderr, self.folder)
        assert "Traceback" not in told.stderr, told.stderr
        assert told.returncode in {0, 1} or step.shown.startswith(("error:", "Usage:")), f"{step.command}\n{told.stdout}{told.stderr}"
        if step.shown.strip() and not is_shown(step.shown, answer):
            self.wrong.append(f"{name_of(self.page)}:{block.line}: $ {step.command}\n-- shown\n{step.shown}\n-- answered\n{answer}")
            self.rewritten.append((block, step, answer))

    def _python(self, block: Block, output: Block | None) -> None:
        told = self._call([sys.executable, "-c", block.text])
        assert told.returncode == 0, f"{name_of(self.page)}:{block.line}\n{told.stderr}"
        if output is not None and not is_shown(output.text, in_place(told.stdout, self.folder)):
            self.wrong.append(f"{name_of(self.page)}:{output.line}\n-- shown\n{output.text}\n-- printed\n{told.stdout}")
            self.rewritten.append((output, Step("", output.text), told.stdout))

    def _query(self, block: Block) -> None:
        with closing(sqlite3.connect(f"{(self.folder / 'out' / 'regulations.sqlite').as_uri()}?mode=ro", uri=True)) as connection:
            rows = connection.execute(block.text).fetchall()
        if not rows:
            self.wrong.append(f"{name_of(self.page)}:{block.line}: this query finds nothing\n{block.text}")

    def _call(self, command: list[str]) -> subprocess.CompletedProcess[str]:
        return subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False, timeout=300)

    def rewrite(self) -> None:
        """Put what was answered into the page, last block first, so that places stay right."""
        text = self.text
        for block, step, answer in reversed(self.rewritten):
            if "..." in step.shown:
                continue
            body = text[block.start : block.start + len(block.text)]
            new = answer.strip("\n")
            body = body.replace(f"$ {step.command}\n{step.shown}", f"$ {step.command}\n{new}", 1) if step.command else f"{new}\n"
            text = text[: block.start] + body + text[block.start + len(block.text) :]
        self.page.write_text(text, "utf-8")


@pytest.fixture(scope="session")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One cache for all pages, since most of them ask the same codes."""
    return tmp_path_factory.mktemp("cache")


@pytest.mark.parametrize("page", EXECUTED, ids=name_of)
def test_a_page_does_what_it_says(page: Path, tmp_path: Path, cache: Path, request: pytest.FixtureRequest) -> None:
    folder = tmp_path / "here"
    shutil.copytree(ROOT / "codes", folder / "codes")
    reader = Reader(page, folder, cache)
    reader.follow()
    if request.config.getoption("--rewrite-golden") and reader.wrong:
        reader.rewrite()
        pytest.fail(f"{len(reader.rewritten)} outputs of {name_of(page)} have changed; read the difference before you keep it")
    assert not reader.wrong, "\n\n".join(reader.wrong)


def test_generated_pages_are_fresh() -> None:
    told = subprocess.run([sys.executable, str(GENERATOR), "--check"], capture_output=True, text=True, check=False, cwd=ROOT)
    assert told.returncode == 0, f"generated pages of docs/reference are stale; run `make docs`\n{told.stdout}{told.stderr}"


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


@pytest.mark.parametrize("page", WRITTEN, ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    missing = []
    for target in _LINK.findall(re.sub(r"^```.*?^```$", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)):
        path, _, anchor = target.partition("#")
        if "://" in target or Path(path).name in GENERATED:
            continue
        file = (page.parent / path).resolve() if path else page
        if not file.exists() or (anchor and anchor not in {_anchor(heading) for heading in _HEADING.findall(file.read_text("utf-8"))}):
            missing.append(target)
    assert missing == []


def test_the_index_names_every_page() -> None:
    index = (ROOT / "docs" / "README.md").read_text("utf-8")
    named = {target.partition("#")[0] for target in _LINK.findall(index)}
    there = {page.relative_to(ROOT / "docs").as_posix() for page in WRITTEN if page.is_relative_to(ROOT / "docs")}
    assert there - {"README.md"} - named == set()
    assert {f"reference/{name}" for name in GENERATED} - named == set()


def test_the_readme_names_every_command() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    assert [name for name in COMMANDS if f"| `regdb {name}" not in text] == []


def test_what_the_readme_tells_to_install_is_there() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    makefile = (ROOT / "Makefile").read_text("utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    targets = re.findall(r"^make (\w+)", text, re.MULTILINE)
    assert {"demo", "test"} <= set(targets)
    assert [target for target in targets if not re.search(rf"^{target}:", makefile, re.MULTILINE)] == []
    extras = {extra for part in re.findall(r"pip install '?\.\[([\w,-]+)\]", text) for extra in part.split(",")}
    assert extras
    assert extras <= set(project["optional-dependencies"])


@pytest.mark.parametrize("page", WRITTEN, ids=name_of)
def test_pages_are_plain(page: Path) -> None:
    """Nothing of this machine, and no line of a block wider than a terminal shows."""
    text = page.read_text("utf-8")
    assert re.findall(r"/work/|/home/\w+|TODO|FIXME", text) == []
    shown = [line for block in read_blocks(text) if block.language == "console" for line in block.text.splitlines()]
    wide = [line for line in shown if len(line) > WIDTH and not line.startswith(("$ ", "> ", "next: ", "-", "+"))]
    assert wide == []


@pytest.mark.parametrize(
    ("shown", "told", "same"),
    [
        ("a\nb", "a\nb\n", True),
        ("a\n...\nd", "a\nb\nc\nd", True),
        ("a\n...", "a\nb\nc", True),
        ("a ... d", "a b c d", True),
        ("a\n...\nd", "a\nb\nc", False),
        ("a (x).", "a (x).", True),
        ("a.b", "axb", False),
        ("a\n...\nd\n...", "a\nb\nd\n\ne", True),
        ("a\n...\nd\n...", "a\nb\ne", False),
        ("  --> codes/a.yaml:3:9\n 3 | x", "  --> codes/a.yaml:4:1\n 4 | x", True),
        ("2 passed in 0.5 s", "2 passed in 11.8 s", True),
        ("1 error", "2 errors", False),
    ],
)
def test_outputs_are_compared_strictly(shown: str, told: str, same: bool) -> None:
    assert is_shown(shown, told) is same


def test_an_edit_must_fit_exactly_once() -> None:
    assert edited("a\nb\nc\n", "-b\n+B\n+bb\n") == "a\nB\nbb\nc\n"
    with pytest.raises(ValueError, match="0 times"):
        edited("a\n", "-x\n+y\n")


def rows_under(page: Path, heading: str) -> list[list[str]]:
    """The cells of the table under a heading, without its head."""
    part = page.read_text("utf-8").partition(f"## {heading}\n")[2].partition("\n## ")[0]
    lines = [line for line in part.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def test_conditions_that_cannot_be_read_are_told_as_the_page_says(codes: Path) -> None:
    vocabulary = read_corpus(codes, added=()).vocabulary
    wrong = []
    for written, code, message, right in rows_under(CONDITIONS, "Errors"):
        (problem,) = parse_condition(written.strip("`"), vocabulary).problems
        if (problem.code, problem.message, problem.note) != (code, message, right):
            wrong.append((written, problem))
    assert wrong == []


def test_every_form_of_condition_can_be_read(codes: Path) -> None:
    vocabulary = read_corpus(codes, added=()).vocabulary
    texts = [text for form, _ in rows_under(CONDITIONS, "Forms") for text in re.findall(r"`([^`]*)`", form)]
    words = {"a", "b", "residence_district"}
    defined = {name: parse_condition("true", vocabulary).node for name in words}
    problems = {text: found for text in texts if (found := parse_condition(text, vocabulary, defined.get).problems)}
    assert len(texts) > len(words)
    assert problems == {}


def test_the_units_are_those_of_the_language() -> None:
    told = {unit: dimension for dimension, units in rows_under(CONDITIONS, "Units") for unit in re.findall(r"`([^`]*)`", units)}
    assert told == {unit.symbol: unit.dimension for unit in UNITS.values() if unit.symbol}


def test_the_grammar_is_the_parser_s(request: pytest.FixtureRequest) -> None:
    lines = (ROOT / "compiler" / "regdb_compiler" / "condition.lark").read_text("utf-8").splitlines(keepends=True)
    grammar, page = "".join(line for line in lines if not line.startswith("//")), CONDITIONS.read_text("utf-8")
    (shown,) = [block.text for block in read_blocks(page) if block.language == "lark"]
    if request.config.getoption("--rewrite-golden"):
        CONDITIONS.write_text(page.replace(shown, grammar), "utf-8")
    assert shown == grammar


def test_the_families_are_those_of_the_catalogue() -> None:
    told = dict(rows_under(ROOT / "docs" / "reference" / "diagnostics.md", "Families"))
    assert told == FAMILIES


def test_hooks_run_commands_that_are_there(codes: Path) -> None:
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    used = set(re.findall(r"id: (regdb-\w+)", (ROOT / "docs" / "how-to" / "use-in-ci.md").read_text("utf-8")))
    assert used == {hook["id"] for hook in hooks}
    for hook in hooks:
        program, command, *_ = hook["entry"].split()
        assert (program, command in COMMANDS) == ("regdb", True)
        assert [path for path in codes.glob("*/*.yaml") if not re.search(hook["files"], f"codes/{path.relative_to(codes).as_posix()}")] == []
