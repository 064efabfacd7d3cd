"""What rules are made of: pages, the parts of a condition as written, edits of keys and items."""

import pytest
from regdb_compiler.diagnostics import Edit
from regdb_compiler.fixes import apply_edits
from regdb_compiler.lint.edits import delete_item, delete_key, insert_key_after, replace_words
from regdb_compiler.lint.page import read_page
from regdb_compiler.lint.written import parts_of, spelled
from regdb_compiler.source import Mapping, Scalar, Sequence, parse_text

PAGE = """The offence.

Why:
    Because.

Fails:
    a: 1
      b

Passes:
    a: 2

Fix (unsafe):
    It is mended.
"""


def root(text: str) -> Mapping:
    node = parse_text(text, "a.yaml").root
    assert isinstance(node, Mapping)
    return node


def made(text: str, edit: Edit | None) -> str:
    assert edit is not None
    return apply_edits(text, [edit])


def test_a_page_has_its_parts() -> None:
    page = read_page(PAGE)
    assert (page.summary, page.why, page.passes, page.fix, page.fix_kind) == ("The offence.", "Because.", "a: 2", "It is mended.", "unsafe")
    assert page.fails == "a: 1\n  b"
    assert read_page("Only this.").fix_kind == ""


@pytest.mark.parametrize(
    "text",
    ["a.b", "known(a)", "a in {x, y}", "x in a", "t within 07:00..09:00", "a - 2 mph <= 3 * b", "not a"],
)
def test_a_part_stands_where_it_is_written(text: str) -> None:
    condition = f"(first or {text}) and last"
    assert text in {condition[part.start : part.end] for part in parts_of(condition)}


def test_what_cannot_be_read_has_no_parts() -> None:
    assert parts_of("a = b") == parts_of("") == ()


def test_parts_that_say_the_same_are_spelled_the_same() -> None:
    one, other = ([part for part in parts_of(text) if part.join is None] for text in ("a  <  3 mph", "a < 3 mph"))
    assert spelled(one[0].raw) == spelled(other[0].raw)
    assert spelled(parts_of("a < -3 mph")[0].raw) != spelled(parts_of("a < 3 mph")[0].raw)
    assert spelled(parts_of("a and b")[0].raw) != spelled(parts_of("a or b")[0].raw)


def test_a_key_is_taken_out_with_its_lines() -> None:
    text = "a: 1\nb:\n  - x\n  - y  # last\nc: 3\n"
    assert made(text, delete_key(root(text), "b")) == "a: 1\nc: 3\n"
    assert made(text, delete_key(root(text), "c")) == "a: 1\nb:\n  - x\n  - y  # last\n"
    assert delete_key(root(text), "z") is None
    assert delete_key(root("{a: 1, b: 2}\n"), "b") is None


def test_the_first_key_of_an_item_is_let_be() -> None:
    items = root("r:\n  - id: a\n    b: 1\n").get("r")
    assert isinstance(items, Sequence)
    item = items.items[0]
    assert isinstance(item, Mapping)
    assert delete_key(item, "id") is None
    assert delete_key(item, "b") is not None


def test_a_key_is_put_in_with_its_indentation() -> None:
    text = "r:\n  a: {x: 1}  # why\n  b: 2"
    inner = root(text).get("r")
    assert isinstance(inner, Mapping)
    assert made(text, insert_key_after(inner, "a", "n: 0")) == "r:\n  a: {x: 1}  # why\n  n: 0\n  b: 2"
    assert made(text, insert_key_after(inner, "b", "n: 0")) == f"{text}\n  n: 0\n"
    assert insert_key_after(inner, "z", "n: 0") is None


def test_items_are_taken_out_of_lists() -> None:
    flow, block = "a: [x, y, z]\n", "a:\n  - x\n  - y\n  - z\n"
    for text, wanted in ((flow, "a: [x, z]\n"), (block, "a:\n  - x\n  - z\n")):
        node = root(text).get("a")
        assert isinstance(node, Sequence)
        assert made(text, delete_item(node, 1)) == wanted
        assert (delete_item(node, 0) is None) == node.flow


def test_words_are_replaced_on_one_line_only() -> None:
    text = "a: 'it is so'\nb: >-\n  it is\n  so\n"
    one, folded = root(text).get("a"), root(text).get("b")
    assert isinstance(one, Scalar)
    assert isinstance(folded, Scalar)
    assert made(text, replace_words(one, 3, 5, "was")).startswith("a: 'it was so'\n")
    assert replace_words(folded, 0, 2, "x") is None
