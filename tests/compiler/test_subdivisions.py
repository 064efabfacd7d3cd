"""Which subdivisions a text has, and which of them nothing carries."""

from pathlib import Path

import pytest
from regdb_compiler.lint.example import build_example
from regdb_compiler.subdivisions import carried, gaps, marked


@pytest.mark.parametrize(
    ("text", "letters"),
    [
        ("(a) One.\n(b) Two.", "ab"),
        ("(a) One. (b) Two in the same line; (c) three.", "abc"),
        ("(a) One, as (b) allows.", "a"),
        ("(b) and (c) Two.", "bc"),
        ("(c) to (f) Four of them.", "cdef"),
        ("(a)-(c) Three.", "abc"),
        ("(d)(e) Two.", "de"),
        ("(a)(1) One of several. (2) Another.", "a"),
        ("(a) One.\n(c) Three. (a) does not apply.", "ac"),
        ("No subdivisions at all, (c) last.", ""),
        ("  (a) Indented.", "a"),
        ("", ""),
    ],
)
def test_letters_that_open_a_line_or_a_sentence_are_marks(text: str, letters: str) -> None:
    assert "".join(marked(text)) == letters


def test_a_mark_knows_its_place() -> None:
    text = "(a) One. (b) to (d) More."
    found = marked(text)
    assert text[slice(*found["a"])] == "(a)"
    assert text[slice(*found["b"])] == "(b)"
    assert found["c"] == found["d"]
    assert text[slice(*found["d"])] == "(d)"


def test_what_is_cited_or_omitted_is_carried(tmp_path: Path) -> None:
    text = "(a) A. (b) B. (c) C. (d) D. (e) E."
    omitted = [
        {"subdivision": "(b)", "status": "elsewhere", "why": "w"},
        {"subdivision": ["(c)", "(d)(1)"], "status": "not_for_ads", "why": "w"},
    ]
    build = build_example({"text": text, "omitted": omitted, "regulations": [{"id": "a"}]}, tmp_path)
    version = next(v for v in build.corpus.versions if v.section.doc.section == "100")
    assert build.diagnostics == ()
    assert carried(version) == {"a", "b", "c"}
    assert gaps(version) == ("d", "e")


def test_a_version_that_omits_itself_has_no_gaps(tmp_path: Path) -> None:
    build = build_example({"text": "(a) A. (b) B.", "omitted": [{"status": "not_for_ads", "why": "w"}], "regulations": []}, tmp_path)
    version = next(v for v in build.corpus.versions if v.section.doc.section == "100")
    assert gaps(version) == ()
