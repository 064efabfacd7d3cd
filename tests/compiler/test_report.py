"""Every format says where, what and what then, also for hostile sources."""

import json
import re
import time
from typing import Any
from xml.etree import ElementTree as ET

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Place, fingerprint
from regdb_compiler.report import FORMATS, to_json, to_sarif
from regdb_compiler.report import text as text_report
from regdb_compiler.report.columns import fit, total_width
from regdb_compiler.source import SOURCE_RULES, parse_text

PATH = "codes/cvc/21760.yaml"
SOURCE = "\n" * 16 + "        quote: less than 3 feet\n"
QUOTE = Diagnostic(
    "R204",
    "quote-not-in-text",
    "error",
    "these words are not in the attached text of this version",
    Place(PATH, 17, 16, 17, 32),
    note='nearest passage: "less than three feet"',
    help="quote the law word for word; the number belongs in `attributes`",
    law="Cal. Veh. Code § 21760(c), in force since 2014-09-16",
    fix=Fix("safe", "quote the nearest passage", (Edit(Place(PATH, 17, 16, 17, 32), "less than three feet"),)),
)
FRAME = """\
error[R204] quote-not-in-text: these words are not in the attached text of this
    version
  --> codes/cvc/21760.yaml:17:16
   |
17 |         quote: less than 3 feet
   |                ^^^^^^^^^^^^^^^^ nearest passage: "less than three feet"
   |
   = help: quote the law word for word; the number belongs in `attributes`
           [fix: safe]
   = law:  Cal. Veh. Code § 21760(c), in force since 2014-09-16

1 error in 1 file (1 fixable with --fix)
"""


def finding(line: int, column: int, end_column: int, *, end_line: int = 0, **more: Any) -> Diagnostic:
    place = Place("a.yaml", line, column, end_line or line, end_column)
    return Diagnostic("R999", "thing", more.pop("level", "error"), more.pop("message", "m"), place, **more)


def frame(text: str, d: Diagnostic) -> list[str]:
    """The frame's lines without head, place and closing line."""
    return text_report.render([d], {"a.yaml": text}).split("\n")[3:-3]


def test_the_frame_of_the_design() -> None:
    assert text_report.render([QUOTE], {PATH: SOURCE}) == FRAME


def test_both_places_of_a_conflict_are_shown() -> None:
    file = parse_text("a: 1\nb: 2\na: 3\n", "a.yaml")
    assert (
        text_report.render(file.diagnostics, {"a.yaml": file.text})
        == """\
error[R005] duplicate-key: `a` is written twice in one mapping
 --> a.yaml:3:1
  |
3 | a: 3
  | ^ written again here
 --> a.yaml:1:1
  |
1 | a: 1
  | - first written here
  |
  = help: keep one of the two

1 error in 1 file
"""
    )


def test_a_range_over_lines_shows_its_first_and_last() -> None:
    text = "a: one\n  two\n  three\n  four\nb: 1\n"
    assert frame(text, finding(1, 4, 7, end_line=4, note="all of this")) == [
        "1 | a: one",
        "  |    ^^^",
        "...",
        "4 |   four",
        "  |   ^^^^ all of this",
    ]
    assert frame(text, finding(1, 4, 6, end_line=2)) == ["1 | a: one", "  |    ^^^", "2 |   two", "  |   ^^^"]


@pytest.mark.parametrize(
    ("line", "part", "shown", "carets"),
    [
        ("a:\tb", "b", "a:    b", "      ^"),
        ("a:\tb", "\t", "a:    b", "  ^^^^"),
        ("車両: 停止 x", "停止", "車両: 停止 x", "      ^^^^"),
        ("cafe\u0301 = x", "x", "cafe\u0301 = x", "       ^"),
        ("a: 🚗 b", "b", "a: 🚗 b", "      ^"),
        ("a\u200bb", "b", "a\u200bb", " ^"),
        ("a\x1b[31m b", "b", "a?[31m b", "       ^"),
        ("a \u202eb c", "c", "a ?b c", "     ^"),
    ],
)
def test_the_caret_stands_under_its_word(line: str, part: str, shown: str, carets: str) -> None:
    start = line.index(part) + 1
    assert frame(line, finding(1, start, start + len(part))) == [f"1 | {shown}", f"  | {carets}"]


def test_a_long_line_is_cut_around_the_caret() -> None:
    line = "text: " + "word " * 60 + "WRONG " + "word " * 60
    start = line.index("WRONG") + 1
    source, carets = frame(line, finding(1, start, start + 5))
    assert source.startswith("1 | ...")
    assert source.endswith("...")
    assert max(len(source), len(carets)) <= 80
    assert source[carets.index("^") : carets.rindex("^") + 1] == "WRONG"


def test_a_line_of_a_megabyte_is_cut_at_once() -> None:
    line = "é" * 1_000_000 + "X" + "é" * 1_000_000
    started = time.process_time()
    source, carets = frame(line, finding(1, 1_000_001, 1_000_002))
    assert time.process_time() - started < 0.5
    assert source.startswith("1 | ...é")
    assert source.endswith("é...")
    assert source[carets.index("^")] == "X"


def test_a_long_note_goes_under_the_carets() -> None:
    lines = frame("a: one two", finding(1, 8, 11, note="this is a long note " * 6))
    assert lines[:2] == ["1 | a: one two", "  |        ^^^"]
    assert all(line.startswith("  |        ") for line in lines[2:])
    assert max(map(len, lines)) <= 80


def test_a_place_beyond_the_text_shows_no_source() -> None:
    assert frame("a: 1", finding(9, 1, 2)) == []
    assert frame("", finding(1, 1, 1)) == []


def test_colour_is_only_colour() -> None:
    coloured = text_report.render([QUOTE], {PATH: SOURCE}, color=True)
    assert "\033[" in coloured
    assert re.sub(r"\033\[[0-9;]*m", "", coloured) == FRAME


def test_closing_line() -> None:
    def closing(*findings: Diagnostic) -> str:
        return text_report.render(findings, {}).rstrip("\n").split("\n")[-1]

    other = Diagnostic("R1", "x", "info", "m", Place("b.yaml", 1, 1, 1, 1))
    assert closing() == "no findings"
    assert closing(finding(1, 1, 2), finding(2, 1, 2), finding(3, 1, 2, level="warning")) == ("2 errors, 1 warning in 1 file")
    assert closing(finding(1, 1, 2), other) == "1 error, 1 info in 2 files"


def test_findings_come_in_the_order_of_their_places_whatever_order_they_were_made_in() -> None:
    findings = [finding(3, 1, 2), finding(1, 5, 6), QUOTE, finding(1, 1, 2)]
    for render in FORMATS.values():
        assert render(findings, {}) == render(findings[::-1], {})


def test_concise() -> None:
    expected = "codes/cvc/21760.yaml:17:16: error[R204] quote-not-in-text: these words are not in the attached text of this version\n"
    assert FORMATS["concise"]([QUOTE], {PATH: SOURCE}) == expected
    assert FORMATS["concise"]([finding(1, 1, 2, message="two\nlines\x1b")], {}).count("\n") == 1


def test_github_escapes_what_would_end_the_command() -> None:
    d = Diagnostic("R1", "x", "info", "100%\nsure: a,b", Place("a,b:c%.yaml", 1, 2, 1, 3))
    assert FORMATS["github"]([d], {}) == (
        "::notice file=a%2Cb%3Ac%25.yaml,line=1,col=2,endLine=1,endColumn=3,title=R1 x::100%25%0Asure: a,b\n"
    )


def test_json_is_as_its_schema_says() -> None:
    told = json.loads(FORMATS["json"]([QUOTE, finding(1, 1, 2, related=((QUOTE.place, "see"),))], {PATH: SOURCE}))
    jsonschema.validate(told, to_json.JSON_SCHEMA, cls=jsonschema.Draft202012Validator)
    assert told["summary"] == {"errors": 2, "warnings": 0, "infos": 0, "files": 2, "fixable": 1}
    assert told["diagnostics"][1]["fix"]["edits"][0]["text"] == "less than three feet"
    jsonschema.validate(json.loads(FORMATS["json"]([], {})), to_json.JSON_SCHEMA)


def test_junit_has_a_case_for_every_finding_and_one_for_every_clean_file() -> None:
    bad = finding(1, 1, 2, message="<&\x00\x1b\ufffe> \ud800")
    told = FORMATS["junit"]([bad, finding(2, 1, 2, level="info"), QUOTE], {PATH: SOURCE, "clean.yaml": "a: 1\n"})
    suites = ET.fromstring(told)
    assert suites.attrib == {"name": "regdb", "tests": "4", "failures": "2"}
    assert [suite.get("name") for suite in suites] == ["a.yaml", "clean.yaml", PATH]
    assert [len(suite.findall("testcase/failure")) for suite in suites] == [1, 0, 1]
    assert ET.fromstring(FORMATS["junit"]([], {})).get("tests") == "0"


REGION = {
    "type": "object",
    "required": ["startLine", "startColumn", "endLine", "endColumn"],
    "properties": {key: {"type": "integer", "minimum": 1} for key in ("startLine", "startColumn", "endLine", "endColumn")},
    "additionalProperties": False,
}
ARTIFACT = {
    "type": "object",
    "required": ["uri"],
    "properties": {"uri": {"type": "string", "pattern": r"^[A-Za-z0-9/._~%-]+$|^file:///"}},
    "additionalProperties": False,
}
MESSAGE = {
    "type": "object",
    "required": ["text"],
    "properties": {"text": {"type": "string", "minLength": 1}},
    "additionalProperties": False,
}
LOCATION = {
    "type": "object",
    "required": ["physicalLocation"],
    "properties": {
        "id": {"type": "integer", "minimum": -1},
        "message": MESSAGE,
        "physicalLocation": {
            "type": "object",
            "required": ["artifactLocation", "region"],
            "properties": {"artifactLocation": ARTIFACT, "region": REGION},
            "additionalProperties": False,
        },
    },
    "additionalProperties": False,
}
REPLACEMENT = {
    "type": "object",
    "required": ["deletedRegion"],
    "properties": {
        "deletedRegion": REGION,
        "insertedContent": {"type": "object", "properties": {"text": {"type": "string"}}, "additionalProperties": False},
    },
    "additionalProperties": False,
}
CHANGE = {
    "type": "object",
    "required": ["artifactLocation", "replacements"],
    "properties": {
        "artifactLocation": ARTIFACT,
        "replacements": {"type": "array", "minItems": 1, "items": REPLACEMENT},
    },
    "additionalProperties": False,
}
RESULT = {
    "type": "object",
    "required": ["message", "ruleId", "ruleIndex", "level", "locations", "partialFingerprints"],
    "properties": {
        "ruleId": {"type": "string"},
        "ruleIndex": {"type": "integer", "minimum": 0},
        "level": {"enum": ["none", "note", "warning", "error"]},
        "message": MESSAGE,
        "locations": {"type": "array", "items": LOCATION},
        "relatedLocations": {"type": "array", "uniqueItems": True, "items": LOCATION},
        "partialFingerprints": {"type": "object", "additionalProperties": {"type": "string"}},
        "fixes": {
            "type": "array",
            "uniqueItems": True,
            "items": {
                "type": "object",
                "required": ["artifactChanges"],
                "properties": {
                    "description": MESSAGE,
                    "artifactChanges": {"type": "array", "minItems": 1, "uniqueItems": True, "items": CHANGE},
                },
                "additionalProperties": False,
            },
        },
        "suppressions": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["kind"],
                "properties": {"kind": {"enum": ["inSource", "external"]}, "justification": {"type": "string"}},
                "additionalProperties": False,
            },
        },
    },
    "additionalProperties": False,
}
RULE = {
    "type": "object",
    "required": ["id"],
    "properties": {
        "id": {"type": "string"},
        "name": {"type": "string"},
        "shortDescription": MESSAGE,
        "help": MESSAGE,
        "defaultConfiguration": {
            "type": "object",
            "properties": {"level": {"enum": ["none", "note", "warning", "error"]}},
            "additionalProperties": False,
        },
    },
    "additionalProperties": False,
}
DRIVER = {
    "type": "object",
    "required": ["name"],
    "properties": {
        "name": {"type": "string"},
        "version": {"type": "string"},
        "rules": {"type": "array", "uniqueItems": True, "items": RULE},
    },
    "additionalProperties": False,
}
# The parts of the published SARIF 2.1.0 schema that this output uses, closed against anything else.
SARIF = {
    "type": "object",
    "required": ["version", "runs"],
    "properties": {
        "$schema": {"type": "string", "format": "uri"},
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["tool"],
                "properties": {
                    "tool": {
                        "type": "object",
                        "required": ["driver"],
                        "properties": {"driver": DRIVER},
                        "additionalProperties": False,
                    },
                    "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                    "results": {"type": "array", "items": RESULT},
                },
                "additionalProperties": False,
            },
        },
    },
    "additionalProperties": False,
}


def sarif(*findings: Diagnostic, **more: Any) -> dict[str, Any]:
    told: dict[str, Any] = json.loads(to_sarif.render(findings, {PATH: SOURCE}, **more))
    jsonschema.validate(told, SARIF)
    run: dict[str, Any] = told["runs"][0]
    return run


def test_sarif_holds_places_fixes_and_fingerprints() -> None:
    run = sarif(QUOTE, finding(1, 1, 2, level="info", related=((QUOTE.place, "see"),)), version="0.1.0")
    first, second = run["results"]
    assert (first["level"], second["level"]) == ("note", "error")
    assert run["tool"]["driver"]["rules"][second["ruleIndex"]]["id"] == "R204"
    assert second["partialFingerprints"] == {"regdbLine/v1": fingerprint(QUOTE, SOURCE.split("\n")[16])}
    (replacement,) = second["fixes"][0]["artifactChanges"][0]["replacements"]
    assert replacement["insertedContent"] == {"text": "less than three feet"}


def test_sarif_without_findings_or_with_only_syntax_errors() -> None:
    assert sarif()["results"] == []
    file = parse_text("a: [", "a b/ü.yaml")
    run = sarif(*file.diagnostics, rules=SOURCE_RULES)
    assert run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"] == {"uri": "a%20b/%C3%BC.yaml"}
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == [code for code, _, _ in SOURCE_RULES]


def test_sarif_tells_what_was_allowed_and_why() -> None:
    run = sarif(suppressed=[(QUOTE, "misprint")])
    assert run["results"][0]["suppressions"] == [{"kind": "inSource", "justification": "misprint"}]


def test_a_fingerprint_outlives_moves_but_not_other_words() -> None:
    line = "        quote: less than 3 feet"
    moved = Diagnostic("R204", "quote-not-in-text", "error", "other words", Place(PATH, 99, 1, 99, 2))
    assert fingerprint(QUOTE, line) == fingerprint(moved, line.strip())
    assert fingerprint(QUOTE, line) != fingerprint(QUOTE, line + "s")
    elsewhere = Diagnostic("R204", "quote-not-in-text", "error", "m", Place("b.yaml", 17, 16, 17, 32))
    assert fingerprint(QUOTE, line) != fingerprint(elsewhere, line)


LINES = st.text(st.characters(exclude_categories=["Cs"]) | st.sampled_from("\t車🚗\u0301\u202e\x1b\x00\r"), max_size=200)


@settings(max_examples=200, deadline=None)
@given(LINES.filter(lambda line: "\n" not in line), st.integers(0, 210), st.integers(0, 210), st.integers(8, 80))
def test_a_cut_line_always_fits_and_keeps_its_mark(line: str, start: int, end: int, room: int) -> None:
    shown = fit(line, start, end, room)
    assert total_width(shown.text) <= room
    assert 0 <= shown.start <= shown.end <= room


@settings(max_examples=100, deadline=None)
@given(st.text(max_size=80), st.integers(1, 9), st.integers(1, 90), st.integers(0, 3), st.integers(1, 90))
def test_no_source_breaks_a_format(text: str, line: int, column: int, more: int, end_column: int) -> None:
    d = finding(line, column, end_column, end_line=line + more, message="m" + text, note=text, help=text, law=text)
    told = {name: render([d], {"a.yaml": text}) for name, render in FORMATS.items()}
    assert "\x1b" not in told["text"] + told["concise"]
    assert told["concise"].count("\n") == told["github"].count("\n") == 1
    ET.fromstring(told["junit"])
    jsonschema.validate(json.loads(told["json"]), to_json.JSON_SCHEMA)
    jsonschema.validate(json.loads(told["sarif"]), SARIF)
    source_lines = [row for row in told["text"].split("\n")[2:] if re.match(r" *\d* \|", row)]
    assert all(total_width(row) <= 80 for row in source_lines)
