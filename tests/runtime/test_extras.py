"""A missing extra says what to type, and what it says to type brings the library."""

import ast
import tomllib
from pathlib import Path

import pytest
from regdb_runtime.errors import MissingExtra

ROOT = Path(__file__).resolve().parents[2]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]


def raised() -> list[tuple[str, str, str]]:
    """(file, library, extra) of every MissingExtra that names both as text."""
    found = []
    for path in sorted((ROOT / "runtime").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "MissingExtra":
                library, extra = node.args[:2]
                if isinstance(extra, ast.Constant):
                    found.append((path.name, str(library.value) if isinstance(library, ast.Constant) else "", str(extra.value)))
    return found


@pytest.mark.parametrize(("file", "library", "extra"), raised())
def test_the_extra_named_brings_the_library(file: str, library: str, extra: str) -> None:
    assert extra in EXTRAS, file
    assert any(item.lower().startswith(library.lower()) for item in EXTRAS[extra]), file


@pytest.mark.parametrize("library", ["torch", "transformers", "bitsandbytes"])
def test_what_a_local_model_needs_is_in_its_extra(library: str) -> None:
    assert any(item.startswith(library) for item in EXTRAS["local-vlm"])
    assert str(MissingExtra(library, "local-vlm", "a vision model on this machine")).endswith("pip install 'regdb[local-vlm]'")


def test_all_leaves_the_very_large_ones_out() -> None:
    (everything,) = EXTRAS["all"]
    named = everything.partition("[")[2].rstrip("]").split(",")
    assert set(named) <= EXTRAS.keys()
    assert "vlm" in named
    assert "local-vlm" not in named
