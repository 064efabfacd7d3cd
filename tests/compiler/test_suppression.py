"""Comments allow findings, for a reason, and only as long as there is something to allow."""

from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.fixes import apply_fixes
from regdb_compiler.source import parse_text
from regdb_compiler.suppression import apply, sift

QUOTE = "# regdb: allow R204 -- misprint in the code"


def finding(line: int, code: str = "R204", name: str = "quote-not-in-text", level: str = "error") -> Diagnostic:
    return Diagnostic(code, name, level, "m", Place("a.yaml", line, 1, line, 2))  # type: ignore[arg-type]


def kept(text: str, *findings: Diagnostic) -> list[tuple[str, int]]:
    return [(d.code, d.place.line) for d in apply(findings, [parse_text(text, "a.yaml")])]


def fixed(text: str, *findings: Diagnostic) -> str:
    result = apply(findings, [parse_text(text, "a.yaml")])
    return apply_fixes(result, {"a.yaml": text}).texts.get("a.yaml", text)


def test_a_comment_allows_on_its_lines_and_nowhere_else() -> None:
    text = f"a: 1\nb: 2 {QUOTE}\nc: 3\n"
    assert kept(text, finding(1), finding(2), finding(3)) == [("R204", 1), ("R204", 3)]


def test_the_name_does_as_well_as_the_code() -> None:
    for rule in ("quote-not-in-text", "r204", "R204"):
        assert kept(f"a: 1 # regdb: allow {rule} -- why\n", finding(1)) == []


def test_a_comment_on_its_own_line_allows_in_the_whole_item_below() -> None:
    text = f"r:\n  {QUOTE}\n  - id: a\n    x: 1\n  - id: b\n"
    assert kept(text, finding(3), finding(4), finding(5)) == [("R204", 5)]


def test_a_comment_for_the_file() -> None:
    text = "a: 1\nb: 2\n# regdb: allow-file R204 -- all quotes are from the old print\n"
    assert kept(text, finding(1), finding(2)) == []


def test_without_a_reason_nothing_is_allowed() -> None:
    assert kept("a: 1 # regdb: allow R204\n", finding(1)) == [("R204", 1), ("R901", 1)]


def test_an_unused_comment_is_reported_and_its_fix_deletes_it() -> None:
    text = f"a: 1\n  {QUOTE}\nb: 2   {QUOTE}\nc: 3\n"
    assert kept(text) == [("R902", 2), ("R902", 3)]
    assert fixed(text) == "a: 1\nb: 2\nc: 3\n"


def test_of_a_comment_used_in_part_only_the_rest_is_taken_out() -> None:
    text = "a: 1 # regdb: allow R204, R301 , vague-word -- it is so\n"
    assert kept(text, finding(1)) == [("R902", 1)]
    assert fixed(text, finding(1)) == "a: 1 # regdb: allow R204 -- it is so\n"


def test_unused_comments_are_let_be_when_only_some_rules_ran() -> None:
    file = parse_text(f"a: 1 {QUOTE}\n", "a.yaml")
    assert apply([], [file], report_unused=False) == ()


def test_what_cannot_be_read_cannot_be_allowed() -> None:
    text = "a: 1 # regdb: allow R005 -- no\n"
    assert kept(text, finding(1, "R005", "duplicate-key")) == [("R005", 1), ("R902", 1)]
    assert kept("a: 1 # regdb: allow R014 -- yes\n", finding(1, "R014", "odd-key", "warning")) == []


def test_a_comment_not_understood_is_reported() -> None:
    assert kept("a: 1 # regdb: ignore R204\n") == [("R904", 1)]


def test_a_file_that_is_not_yaml_has_only_its_own_problem() -> None:
    file = parse_text(f"a: [ {QUOTE}\nb: # regdb: what\n", "a.yaml")
    assert [d.code for d in apply(file.diagnostics, [file])] == ["R001"]


def test_findings_of_other_files_are_not_touched() -> None:
    other = Diagnostic("R204", "quote-not-in-text", "error", "m", Place("b.yaml", 1, 1, 1, 2))
    file = parse_text(f"a: 1 {QUOTE}\n", "a.yaml")
    assert [d.place.path for d in apply([other, finding(1)], [file])] == ["b.yaml"]


def test_what_was_allowed_is_told_with_its_reason() -> None:
    file = parse_text(f"a: 1 {QUOTE}\n", "a.yaml")
    assert sift([finding(1)], [file]).suppressed == ((finding(1), "misprint in the code"),)
