"""Reading YAML: text stays text, every node knows its place, and nothing that a file holds raises."""

import time
from pathlib import Path

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from regdb_compiler.diagnostics import Place
from regdb_compiler.source import (
    MAX_BYTES,
    SOURCE_RULES,
    Mapping,
    Node,
    Scalar,
    Sequence,
    SourceFile,
    parse_text,
    read_source,
)


def read(text: str) -> SourceFile:
    return parse_text(text, "a.yaml")


def root_of(text: str) -> Node:
    file = read(text)
    assert file.diagnostics == ()
    assert file.root is not None
    return file.root


def mapping_of(text: str) -> Mapping:
    root = root_of(text)
    assert isinstance(root, Mapping)
    return root


def value(text: str, *path: str | int) -> Node:
    node: Node | None = root_of(text)
    for step in path:
        if isinstance(step, str):
            assert isinstance(node, Mapping)
            node = node.get(step)
        else:
            assert isinstance(node, Sequence)
            node = node.items[step]
    assert node is not None
    return node


def scalar(text: str, *path: str | int) -> Scalar:
    node = value(text, *path)
    assert isinstance(node, Scalar)
    return node


def codes(text: str) -> list[str]:
    return [d.code for d in read(text).diagnostics]


def where(place: Place) -> tuple[int, int, int, int]:
    return (place.line, place.column, place.end_line, place.end_column)


def words(place: Place, text: str) -> str:
    assert place.line == place.end_line
    return text.split("\n")[place.line - 1][place.column - 1 : place.end_column - 1]


def plain(node: Node | None) -> object:
    if isinstance(node, Mapping):
        return {key.text: plain(child) for key, child in node.entries}
    if isinstance(node, Sequence):
        return [plain(child) for child in node.items]
    return node.text if node else None


@pytest.mark.parametrize("text", ["22349.10", "7:00", "no", "0500", "2002-01-01", "~", "null", "1e3", "0x1F", "1_000"])
def test_every_scalar_stays_what_was_typed(text: str) -> None:
    node = scalar(f"a: {text}\n", "a")
    assert (node.text, node.plain) == (text, True)


def test_quoted_text_is_not_plain() -> None:
    assert scalar("a: 'no'\n", "a").plain is False
    assert scalar("a: |\n  no\n", "a").plain is False


def test_nodes_know_their_places() -> None:
    text = 'section: "21453"\nversions:\n  - effective: 2002-01-01\n    states: {current: [stop], next: [go]}\n\n# end\n'
    root = mapping_of(text)
    assert where(root.place) == (1, 1, 4, 42)
    assert where(root.key_place("versions")) == (2, 1, 2, 9)
    assert where(value(text, "section").place) == (1, 10, 1, 17)
    assert where(value(text, "versions").place) == (3, 3, 4, 42)
    assert where(value(text, "versions", 0).place) == (3, 5, 4, 42)
    assert where(value(text, "versions", 0, "states").place) == (4, 13, 4, 42)
    assert where(value(text, "versions", 0, "states", "current", 0).place) == (4, 24, 4, 28)


def test_flow_and_block_collections_are_told_apart() -> None:
    text = "a: {b: [1]}\nc:\n  - d: 1\n"
    assert [value(text, "a").flow, value(text, "a", "b").flow] == [True, True]  # type: ignore[union-attr]
    assert [value(text, "c").flow, value(text, "c", 0).flow] == [False, False]  # type: ignore[union-attr]


def test_block_text_ends_with_its_last_words_not_with_the_next_key() -> None:
    text = "text: |\n  (a) one\n  (b) two\n\n\n# comment\nnext: 1\n"
    assert where(value(text, "text").place) == (1, 7, 3, 10)
    assert scalar(text, "text").text == "(a) one\n(b) two\n"


def test_columns_count_characters_also_beyond_the_basic_plane() -> None:
    text = "a: '§ 🚗 é'\nb: x\n"
    assert words(value(text, "a").place, text) == "'§ 🚗 é'"
    assert where(value(text, "b").place) == (2, 4, 2, 5)


@pytest.mark.parametrize("odd", ["\u2028", "\u2029", "\x85"])
def test_only_line_feeds_count_as_lines_as_in_editors(odd: str) -> None:
    text = f"a: 'one{odd}two'\nb: x\n"
    assert value(text, "b").place.line == 2


def test_windows_line_ends_and_byte_order_mark() -> None:
    text = "\ufeffa: x\r\nb: y\r\n"
    assert where(value(text, "a").place) == (1, 4, 1, 5)
    assert where(value(text, "b").place) == (2, 4, 2, 5)


def test_mapping_answers_by_key() -> None:
    root = mapping_of("a: 1\nb: 2\n")
    assert root.get("c") is None
    assert "a" in root
    assert list(root) == ["a", "b"]
    assert root.key_place("c") == root.place


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("a: one two three\n", "two"),
        ('a: "one two three"\n', "two"),
        ("a: 'it''s two here'\n", "two"),
        ('a: "tab\\tand \\u00e9 two"\n', "two"),
        ("a: one\n   and two\n", "two"),
        ("a: >\n  one\n  and two\n\n  more\n", "two"),
        ("a: |\n  one\n  and two\n    more\n", "two"),
        ("a: |-\n  one\n\n\n  and two\n", "two"),
        ('a: "one\n   and \\\n   two"\n', "two"),
        ("a: 'one\r\n\r\n  and two'\r\n", "two"),
    ],
)
def test_part_of_a_scalar_has_its_own_place(text: str, part: str) -> None:
    node = scalar(text, "a")
    start = node.text.index(part)
    assert words(node.place_of(start, start + len(part)), text) == part


def test_place_past_the_end_of_a_scalar() -> None:
    text = "when: a ==\n"
    node = scalar(text, "when")
    assert where(node.place_of(4, 4)) == (1, 11, 1, 11)
    assert node.place_of(3, 99) == node.place


@pytest.mark.parametrize(
    ("text", "code", "line", "column", "says"),
    [
        ("title: Foo: bar\n", "R001", 1, 11, "colon followed by a space"),
        ("a: b\n   c: d\n", "R001", 2, 4, "already has its value"),
        ("a:\n\tb: 1\n", "R001", 2, 1, "tab"),
        ("a: |\n\tx\n", "R001", 2, 1, "tab"),
        ("a: @x\n", "R001", 1, 4, "cannot begin with"),
        ('a: "abc\nb: 1\n', "R001", 1, 4, "quote is never closed"),
        ("a: [1, 2\nb: 1\n", "R001", 2, 2, "not closed"),
        ("a: {b: 1\n", "R001", 1, 8, "not closed"),
        ("a: 'it's'\n", "R001", 1, 8, "text follows a value"),
        ("a: 1\n- b\n", "R001", 2, 1, "list item stands among keys"),
        ("a:\n  b: 1\n c: 2\n", "R001", 3, 2, "indentation"),
        ("a: 1\nb\nc: 2\n", "R001", 2, 1, "neither"),
        ("a: - b\n", "R001", 1, 4, "list item cannot begin"),
        ("", "R003", 1, 1, "empty"),
        ("\n\n# only a comment\n", "R003", 1, 1, "empty"),
        ("---\n", "R003", 1, 1, "empty"),
        ("a: 1\nb: x\0y\n", "R004", 2, 5, "zero bytes"),
        ("a: \x1b[31m\n", "R004", 1, 4, "U+001B"),
        ("a: 1\nb: 2\na: 3\n", "R005", 3, 1, "written twice"),
        ("a: {x: 1, x: 2}\n", "R005", 1, 11, "written twice"),
        ("a: &x 1\n", "R006", 1, 4, "anchors"),
        ("a: &x [1]\nb: 1\n", "R006", 1, 4, "anchors"),
        ("a:\n  <<: {b: 1}\n", "R007", 2, 3, "merge"),
        ("a: !!python/object/apply:os.system ['echo']\n", "R008", 1, 4, "tags"),
        ("a: !x 1\n", "R008", 1, 4, "tags"),
        ("[" * 100, "R009", 1, 61, "nested deeper"),
        ("a: 1\n---\nb: 2\n", "R011", 2, 1, "second document"),
        ("[a, b]: 1\n", "R012", 1, 1, "key is a list"),
        ("? {a: b}\n: 1\n", "R012", 1, 3, "key is a mapping"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(text: str, code: str, line: int, column: int, says: str) -> None:
    file = read(text)
    (found,) = file.diagnostics
    assert (found.code, found.place.line, found.place.column) == (code, line, column)
    assert says in found.message
    assert found.level == "error"


def test_a_key_written_twice_shows_both_places_and_the_first_is_kept() -> None:
    file = read("a: 1\nb: 2\na: 3\n")
    (found,) = file.diagnostics
    assert [(place.line, note) for place, note in found.related] == [(1, "first written here")]
    assert plain(file.root) == {"a": "1", "b": "2"}


def test_all_problems_of_a_file_are_told_at_once() -> None:
    text = "a: 1\na: 2\nb: &x 1\nc: *x\nd: !t 1\n[e]: 1\n"
    assert codes(text) == ["R005", "R006", "R006", "R008", "R012"]


def test_quoted_signs_are_text() -> None:
    assert plain(root_of("a: '&x'\nb: '*x'\nc: '!x'\nd: \"# no comment\"\n")) == {
        "a": "&x",
        "b": "*x",
        "c": "!x",
        "d": "# no comment",
    }


def test_a_tree_that_is_not_certain_is_not_handed_on() -> None:
    assert read("a: &x [1]\nb: *x\n").root is None
    assert read("a: [1\n").root is None
    assert read("a: &x [1]\nb: 1\n").root is not None


@pytest.mark.parametrize(
    "text",
    [
        "a: &a [x, x, x]\n" + "".join(f"b{n}: &b{n} [*a, *a, *a, *a, *a, *a, *a, *a]\n" for n in range(10_000)),
        "[" * 1_900_000,
        "{a: " * 400_000,
        "- " * 900_000,
        "? " * 900_000,
        "a: !!x &y 1\n" * 100_000,
        "#" * 1_900_000,
        "a" * 1_900_000,
        '"' + "\\" * 1_900_000,
        "a:\n" + "".join(" " * n + "a:\n" for n in range(1, 1500)),
        "x" * 10_000_000,
    ],
)
def test_bombs_are_answered_quickly(text: str) -> None:
    started = time.process_time()
    file = read(text)
    assert time.process_time() - started < 1
    assert len(file.diagnostics) <= 51


def test_a_file_over_the_limit_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_bytes(b"[" * 10_000_000)
    (found,) = read_source(path, tmp_path).diagnostics
    assert found.code == "R010"
    assert len("x" * MAX_BYTES) == 2_000_000


@pytest.mark.parametrize(
    ("data", "code", "line", "column"),
    [
        ("a: é\n".encode("utf-16"), "R004", 1, 1),
        (b"a: 1\nb: caf\xe9\n", "R004", 2, 7),
        (b"SQLite format 3\0\x10\0\x01\x01\xff\xfe", "R004", 1, 1),
        (b"", "R003", 1, 1),
        (b"\xef\xbb\xbfa: 1\n", None, 0, 0),
    ],
)
def test_bytes_that_are_no_text(tmp_path: Path, data: bytes, code: str | None, line: int, column: int) -> None:
    path = tmp_path / "codes" / "a.yaml"
    path.parent.mkdir()
    path.write_bytes(data)
    file = read_source(path, tmp_path)
    assert file.path == "codes/a.yaml"
    found = [(d.code, d.place.line, d.place.column) for d in file.diagnostics]
    assert found == ([(code, line, column)] if code else [])


def test_what_cannot_be_opened(tmp_path: Path) -> None:
    for path in (tmp_path / "missing.yaml", tmp_path, Path("nul\0name")):
        file = read_source(path, tmp_path)
        assert [d.code for d in file.diagnostics] == ["R002"]
        assert file.root is None


def test_every_code_has_a_rule_text() -> None:
    assert [code for code, _, _ in SOURCE_RULES] == [f"R{n:03}" for n in range(1, 13)]
    assert all(why.endswith(".") for _, _, why in SOURCE_RULES)


ALLOWED = "# regdb: allow R204, vague-word -- the code's own misprint"


def suppressions(text: str) -> list[tuple[int, int]]:
    return [(c.first_line, c.last_line) for c in read(text).comments]


def test_comment_at_the_end_of_a_line_allows_on_that_line() -> None:
    (comment,) = read(f"a: 1\nb: x {ALLOWED}\n").comments
    assert comment.rules == ("R204", "vague-word")
    assert comment.reason == "the code's own misprint"
    assert where(comment.place) == (2, 6, 2, 6 + len(ALLOWED))
    assert (comment.first_line, comment.last_line) == (2, 2)


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (f"{ALLOWED}\na: 1\nb: 2\n", (2, 2)),
        (f"a: 1\n{ALLOWED}\n\n# more\nb:\n  c: 1\n  d:\n    - x\ne: 1\n", (5, 8)),
        (f"r:\n  {ALLOWED}\n  - id: a\n    x: |\n      one\n      two\n  - id: b\n", (3, 6)),
        (f"r:\n  - id: a\n    {ALLOWED}\n    x: 1\n    y: 2\n", (4, 4)),
        (f"a: 1\n{ALLOWED}\n", (2, 2)),
        (f"text: | {ALLOWED}\n  words\n", (1, 1)),
        ("a: 1\n# regdb: allow-file R204 -- because\nb: 2\n", (1, 4)),
    ],
)
def test_lines_that_a_comment_reaches(text: str, lines: tuple[int, int]) -> None:
    assert suppressions(text) == [lines]


@pytest.mark.parametrize(
    "text",
    [
        f'a: "x {ALLOWED}"\n',
        "a: 'x\n  # regdb: allow R204 -- why\n  '\n",
        f"text: |\n  law\n  {ALLOWED}\n  law\n",
        f"text: >\n  {ALLOWED}\n",
        f"a: x{ALLOWED}\n",
    ],
)
def test_a_hash_in_text_is_no_comment(text: str) -> None:
    assert suppressions(text) == []


def test_a_comment_after_a_block_of_text_is_a_comment() -> None:
    assert suppressions(f"text: |\n  law\n{ALLOWED}\nb: 1\n") == [(4, 4)]


@pytest.mark.parametrize(
    ("comment", "rules", "reason"),
    [
        ("#regdb:allow R204--x y", ("R204",), "x y"),
        ("# regdb: allow R204", ("R204",), ""),
        ("# regdb: allow R204 --   ", ("R204",), ""),
        ("# regdb: alow R204 -- x", (), ""),
        ("# regdb: allow -- x", (), ""),
        ("# regdb: allow R204 because", (), ""),
    ],
)
def test_forms_of_a_comment(comment: str, rules: tuple[str, ...], reason: str) -> None:
    (found,) = read(f"a: 1 {comment}\n").comments
    assert (found.rules, found.reason) == (rules, reason)


TEXTS = st.text(alphabet=st.sampled_from("ab:-[]{},#&*!|>'\"%@` \n\t\r\\?<~é\u2028\x85\x00\ufeff0"), max_size=60)


@settings(max_examples=400, deadline=None)
@given(TEXTS)
def test_reading_never_raises_and_places_lie_inside(text: str) -> None:
    file = read(text)
    lines = file.text.split("\n")
    assert (file.root is not None) or file.diagnostics
    for found in file.diagnostics:
        assert 1 <= found.place.line <= found.place.end_line <= len(lines)
        assert 1 <= found.place.column <= len(lines[found.place.line - 1]) + 1
    if file.root is not None:
        check_places(file.root, len(file.text))


def check_places(node: Node, size: int) -> None:
    assert 0 <= node.start <= node.content_end <= size
    if isinstance(node, Scalar):
        for at in range(len(node.text)):
            assert node.place_of(at, at + 1).line >= node.place.line
    for child in node.items if isinstance(node, Sequence) else ():
        check_places(child, size)
    for key, child in node.entries if isinstance(node, Mapping) else ():
        check_places(key, size)
        check_places(child, size)


VALUES = st.recursive(
    st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), max_size=30) | st.from_regex("[a-z: #'\n]*"),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text("abcdef", min_size=1), inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=150, deadline=None)
@given(VALUES, st.booleans())
def test_the_tree_is_what_yaml_says_it_is(data: object, flow: bool) -> None:
    text = yaml.safe_dump({"root": data}, default_flow_style=flow, allow_unicode=True)
    file = read(text)
    if "&" not in text:
        assert plain(file.root) == yaml.load(text, Loader=yaml.BaseLoader)
