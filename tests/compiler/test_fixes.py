"""Edits go in whole, without touching each other, and never change the law by themselves."""

import os
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, FixKind, Place
from regdb_compiler.fixes import apply_edits, apply_fixes, write_beside

TEXT = "one two\nthree four\n"


def place(line: int, column: int, end_column: int, path: str = "a.yaml") -> Place:
    return Place(path, line, column, line, end_column)


def finding(*edits: Edit, kind: FixKind = "safe", code: str = "R999") -> Diagnostic:
    fix = Fix(kind, "put it right", edits)
    return Diagnostic(code, "thing", "error", "m", edits[0].place if edits else place(1, 1, 1), fix=fix)


def test_edits_are_made_wherever_they_stand_in_the_order() -> None:
    edits = [Edit(place(1, 1, 4), "ONE!"), Edit(place(2, 7, 11), "4"), Edit(place(1, 5, 5), "x ")]
    assert apply_edits(TEXT, edits) == "ONE! x two\nthree 4\n"


def test_an_edit_over_lines_and_one_at_the_end() -> None:
    assert apply_edits(TEXT, [Edit(Place("a", 1, 4, 2, 6), "")]) == "one four\n"
    assert apply_edits(TEXT, [Edit(Place("a", 3, 1, 3, 1), "end")]) == TEXT + "end"
    assert apply_edits(TEXT, [Edit(Place("a", 9, 9, 9, 9), "end")]) == TEXT + "end"


def test_other_characters_and_line_ends_are_let_be() -> None:
    text = "§ 🚗 a\r\nb\u2028c\r\n"
    assert apply_edits(text, [Edit(place(2, 3, 4), "C")]) == "§ 🚗 a\r\nb\u2028C\r\n"


def test_edits_that_overlap_are_refused() -> None:
    with pytest.raises(ValueError, match="overlap"):
        apply_edits(TEXT, [Edit(place(1, 1, 4), "x"), Edit(place(1, 3, 6), "y")])
    with pytest.raises(ValueError, match="overlap"):
        apply_edits(TEXT, [Edit(place(1, 1, 1), "x"), Edit(place(1, 1, 1), "y")])


def test_only_the_kinds_asked_for_and_never_legal_ones() -> None:
    safe = finding(Edit(place(1, 1, 4), "1"))
    unsafe = finding(Edit(place(1, 5, 8), "2"), kind="unsafe")
    legal = finding(Edit(place(2, 1, 6), "3"), kind="legal")
    every = (safe, unsafe, legal)
    assert apply_fixes(every, {"a.yaml": TEXT}).texts == {"a.yaml": "1 two\nthree four\n"}
    result = apply_fixes(every, {"a.yaml": TEXT}, ("safe", "unsafe", "legal"))
    assert result.texts == {"a.yaml": "1 2\nthree four\n"}
    assert result.applied == (safe, unsafe)
    assert result.skipped == ()


def test_of_two_fixes_that_overlap_one_is_made_and_the_other_told() -> None:
    first = finding(Edit(place(1, 1, 4), "1"))
    second = finding(Edit(place(1, 3, 8), "2"), Edit(place(2, 1, 6), "3"))
    result = apply_fixes([second, first], {"a.yaml": TEXT})
    assert result.texts == {"a.yaml": "1 two\nthree four\n"}
    assert (result.applied, result.skipped) == ((first,), (second,))


def test_the_same_edit_asked_for_twice_is_made_once() -> None:
    edit = Edit(place(1, 1, 1), "x")
    result = apply_fixes([finding(edit), finding(edit, code="R998")], {"a.yaml": TEXT})
    assert result.texts == {"a.yaml": "x" + TEXT}
    assert len(result.applied) == 2


def test_a_fix_over_two_files_is_made_whole_or_not_at_all() -> None:
    both = finding(Edit(place(1, 1, 4), "1"), Edit(place(1, 1, 4, "b.yaml"), "1"))
    assert apply_fixes([both], {"a.yaml": TEXT, "b.yaml": TEXT}).texts.keys() == {"a.yaml", "b.yaml"}
    result = apply_fixes([both], {"a.yaml": TEXT})
    assert (result.texts, result.skipped) == ({}, (both,))


def test_a_fix_that_contradicts_itself_is_skipped() -> None:
    odd = finding(Edit(place(1, 1, 4), "1"), Edit(place(1, 2, 5), "2"))
    assert apply_fixes([odd], {"a.yaml": TEXT}).skipped == (odd,)


@given(st.lists(st.tuples(st.integers(0, 26), st.integers(0, 5), st.text("xyz", max_size=3)), max_size=8))
def test_fixes_keep_all_that_they_do_not_speak_of(spans: list[tuple[int, int, str]]) -> None:
    text = "".join(chr(65 + at) for at in range(26))
    findings = [finding(Edit(place(1, s + 1, s + n + 1), new)) for s, n, new in spans]
    result = apply_fixes(findings, {"a.yaml": text})
    fixed = result.texts.get("a.yaml", text)
    places = [edit.place for d in result.applied if d.fix for edit in d.fix.edits]
    touched = {at for p in places for at in range(p.column - 1, p.end_column - 1)}
    left = "".join(char for at, char in enumerate(text) if at not in touched)
    assert "".join(char for char in fixed if char.isupper()) == left


def test_thousands_of_fixes_are_made_at_once() -> None:
    text = "word\n" * 3_000
    findings = [finding(Edit(place(line, 1, 5), "w")) for line in range(1, 3_001)]
    started = time.process_time()
    assert apply_fixes(findings, {"a.yaml": text}).texts == {"a.yaml": "w\n" * 3_000}
    assert time.process_time() - started < 3


def test_a_file_is_replaced_in_one_step_with_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("old")
    path.chmod(0o640)
    write_beside(path, "new\r\n§\n")
    assert path.read_bytes() == "new\r\n§\n".encode()
    assert path.stat().st_mode & 0o777 == 0o640
    assert os.listdir(tmp_path) == ["a.yaml"]  # noqa: PTH208


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("old")
    (tmp_path / "link.yaml").symlink_to("a.yaml")
    write_beside(tmp_path / "link.yaml", "new")
    assert (tmp_path / "link.yaml").is_symlink()
    assert (tmp_path / "a.yaml").read_text() == "new"


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("old")
    with pytest.raises(UnicodeEncodeError):
        write_beside(path, "new \ud800")
    assert path.read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1
