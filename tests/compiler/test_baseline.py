"""A baseline lets known findings be, lets no new one in, and asks to shrink."""

from pathlib import Path

import pytest
from regdb_compiler import baseline
from regdb_compiler.diagnostics import Diagnostic, Place, RegdbInputError

TEXT = "a: old\nb: old\nc: same\nd: same\n"


def finding(line: int, code: str = "R204", path: str = "a.yaml") -> Diagnostic:
    return Diagnostic(code, "quote-not-in-text", "error", "not the law's words", Place(path, line, 1, line, 2))


def test_known_findings_are_let_be_wherever_their_line_moves(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    assert baseline.write(path, [finding(1), finding(2)], {"a.yaml": TEXT}) == 2
    known = baseline.read(path)
    assert baseline.apply(known, [finding(1), finding(2)], {"a.yaml": TEXT}) == ()
    moved = "# new line\n\n" + TEXT.replace("b: old", "    b: old")
    assert baseline.apply(known, [finding(3), finding(4)], {"a.yaml": moved}) == ()


def test_a_new_finding_is_not_covered_by_an_old_one(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    baseline.write(path, [finding(1)], {"a.yaml": TEXT})
    new = (finding(2), finding(1, "R205"))
    assert baseline.apply(baseline.read(path), [finding(1), *new], {"a.yaml": TEXT}) == tuple(sorted(new))


def test_equal_lines_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    text = "same\nsame\nsame\n"
    baseline.write(path, [finding(1), finding(2)], {"a.yaml": text})
    known = baseline.read(path)
    assert baseline.apply(known, [finding(1), finding(2), finding(3)], {"a.yaml": text}) == (finding(3),)
    (stale,) = baseline.apply(known, [finding(1)], {"a.yaml": text})
    assert (stale.code, stale.level) == ("R903", "info")
    assert "1 of 2 times" in stale.message


def test_an_entry_that_no_longer_occurs_is_shown_where_it_stands(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    baseline.write(path, [finding(1), finding(2)], {"a.yaml": TEXT})
    known = baseline.read(path)
    (stale,) = baseline.apply(known, [finding(1)], {"a.yaml": TEXT})
    assert stale.place.path == path.as_posix()
    name = path.read_text().split("\n")[stale.place.line - 1].strip().partition(":")[0].strip('"')
    assert known.entries[name].path == "a.yaml"


def test_what_cannot_be_read_is_never_put_up_with(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    assert baseline.write(path, [finding(1, "R005")], {"a.yaml": TEXT}) == 0
    assert baseline.read(path).entries == {}


def test_the_same_findings_make_the_same_file(tmp_path: Path) -> None:
    one, other = tmp_path / "one.json", tmp_path / "other.json"
    baseline.write(one, [finding(1), finding(2)], {"a.yaml": TEXT})
    baseline.write(other, [finding(2), finding(1)], {"a.yaml": TEXT})
    assert one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        '{"regdb_baseline": 2, "findings": {}}',
        '{"regdb_baseline": 1, "findings": []}',
        '{"regdb_baseline": 1, "findings": {"x": {"count": "many"}}}',
        '{"regdb_baseline": 1, "findings": {"x": {"count": -1}}}',
        "[" * 100_000,
    ],
)
def test_a_file_that_is_no_baseline(tmp_path: Path, text: str) -> None:
    path = tmp_path / "baseline.json"
    path.write_text(text)
    with pytest.raises(RegdbInputError) as caught:
        baseline.read(path)
    assert [d.code for d in caught.value.diagnostics] == ["R905"]


def test_a_baseline_that_is_missing(tmp_path: Path) -> None:
    with pytest.raises(RegdbInputError, match="No such file"):
        baseline.read(tmp_path / "none.json")
