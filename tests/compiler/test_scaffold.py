"""new: what it writes lints and reads cleanly before anyone has touched it."""

import shutil
from pathlib import Path

import pytest
from regdb_compiler.driver import build
from regdb_compiler.read_corpus import read_corpus
from regdb_compiler.scaffold import jurisdiction_scaffold, rule_scaffold, section_scaffold

from regdb.front import FrontError


@pytest.fixture
def world(codes: Path, tmp_path: Path) -> Path:
    """The shipped codes without their sections."""
    for name in ("jurisdictions.yaml", "states.yaml"):
        (tmp_path / "codes").mkdir(exist_ok=True)
        shutil.copy(codes / name, tmp_path / "codes" / name)
    shutil.copytree(codes / "vocabulary", tmp_path / "codes" / "vocabulary")
    (tmp_path / "codes" / "cvc").mkdir()
    return tmp_path / "codes"


def test_a_new_section_has_no_errors_and_its_regulation_is_in_force(world: Path) -> None:
    made = section_scaffold(read_corpus(world), "CVC 27001", "Horn: use", "horn")
    made.path.write_text(made.text, "utf-8")
    found = build(world)
    assert [item for item in found.diagnostics if item.level == "error"] == []
    assert [row.regulation.id for row in found.rows] == ["cvc-27001-a"]


def test_a_new_jurisdiction_joins_the_tree(world: Path) -> None:
    made = jurisdiction_scaffold(read_corpus(world), "Santa Monica", "city", "california", "SMMC")
    path = world / "jurisdictions.yaml"
    path.write_text(path.read_text("utf-8").rstrip("\n") + made.text, "utf-8")
    corpus = read_corpus(world)
    assert corpus.diagnostics == ()
    assert [step.id for step in corpus.tree.path("santa_monica")] == ["model", "california", "santa_monica"]


def test_a_new_rule_is_a_module_that_runs(tmp_path: Path) -> None:
    made = rule_scaffold(tmp_path, "quote-too-long", "R950")
    space: dict[str, object] = {}
    exec(compile(made.text, "quote_too_long.py", "exec"), space)  # our own scaffold
    assert space["CODE"] == "R950"
    assert callable(space["check"])


@pytest.mark.parametrize(
    ("citation", "told"), [("CVC", "no citation"), ("XYZ 1", "no code is cited as XYZ"), ("CVC 27001", "is there already")]
)
def test_mistakes_are_told(world: Path, citation: str, told: str) -> None:
    (world / "cvc" / "27001.yaml").write_text("section: x\n")
    with pytest.raises(FrontError, match=told):
        section_scaffold(read_corpus(world), citation, "", "")


def test_a_taken_name_or_a_missing_parent_is_told(world: Path) -> None:
    corpus = read_corpus(world)
    with pytest.raises(FrontError, match="already"):
        jurisdiction_scaffold(corpus, "California", "state", "model", "")
    with pytest.raises(FrontError, match="no jurisdiction 'oregon'"):
        jurisdiction_scaffold(corpus, "Salem", "city", "oregon", "")
