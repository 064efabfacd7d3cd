"""Sheets for people: 80 columns, no empty fields, colour only when asked."""

import pytest
from regdb_compiler.commands import options
from regdb_compiler.commands.sheet import LABEL, WIDTH, Sheet


def test_fields_stand_beside_their_labels_and_empty_ones_leave_nothing() -> None:
    sheet = Sheet()
    sheet.heading("Title")
    sheet.field("Short", "words " * 30)
    sheet.field("None", "")
    sheet.items("List", ["a", "b"])
    sheet.items("Empty", [])
    lines = sheet.render().splitlines()
    assert lines[0] == "Title"
    assert lines[1].startswith("  Short".ljust(LABEL) + "words")
    assert lines[2].startswith(" " * LABEL + "words")
    assert lines[-2:] == ["  List".ljust(LABEL) + "a", " " * LABEL + "b"]
    assert max(map(len, lines)) <= WIDTH


def test_long_lines_keep_their_indent_and_long_words_stay_whole() -> None:
    sheet = Sheet()
    sheet.line("  " + "word " * 40)
    sheet.passage("https://example.org/" + "x" * 90 + "\n\n(a) short")
    lines = sheet.render().splitlines()
    assert all(line.startswith("  word") for line in lines[:3])
    assert "    https://example.org/" + "x" * 90 in lines
    assert lines[-2:] == ["", "    (a) short"]


def test_gaps_never_double() -> None:
    sheet = Sheet()
    sheet.gap()
    sheet.heading("A")
    sheet.gap()
    sheet.gap()
    sheet.heading("B")
    assert sheet.render() == "A\n\nB\n"


def test_colour_only_when_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = Sheet(color=True)
    sheet.heading("A")
    assert sheet.render() == "\033[1mA\033[0m\n"
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setattr(options.sys.stdout, "isatty", lambda: True, raising=False)
    assert options.has_color()
    monkeypatch.setenv("NO_COLOR", "1")
    assert not options.has_color()


def test_a_day_knows_whether_it_was_asked_for() -> None:
    assert str(options.asked_day("2026-03-02")) == "2026-03-02"
    assert options.asked_day("2026-03-02").number == 739677
    assert str(options.asked_day("")).endswith(" (today)")
