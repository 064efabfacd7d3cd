"""Outcomes as JUnit XML, which build servers read: a file is a suite, a law test is a case."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree import ElementTree as ET

from regdb_compiler.law_tests.outcome import Outcome
from regdb_compiler.law_tests.to_text import outcome_text
from regdb_compiler.report.to_junit import NOT_XML


def render(outcomes: Iterable[Outcome]) -> str:
    """One suite for each file that has tests; a broken test is an error, a failed one a failure."""
    by_path: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        by_path.setdefault(outcome.test.where.path, []).append(outcome)
    root = ET.Element("testsuites", {"name": "regdb law tests", **_counts([item for found in by_path.values() for item in found])})
    for path, found in sorted(by_path.items()):
        suite = ET.SubElement(root, "testsuite", {"name": _xml(path), **_counts(found), "skipped": "0"})
        for outcome in found:
            _case(suite, outcome)
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _counts(found: list[Outcome]) -> dict[str, str]:
    count = {status: sum(1 for item in found if item.status == status) for status in ("failed", "broken")}
    return {"tests": str(len(found)), "failures": str(count["failed"]), "errors": str(count["broken"])}


def _case(suite: ET.Element, outcome: Outcome) -> None:
    test = outcome.test
    case = ET.SubElement(suite, "testcase", classname=_xml(test.subject), name=_xml(test.name), file=_xml(test.where.path), line=str(test.where.line))
    if outcome.status != "passed":
        tag = "failure" if outcome.status == "failed" else "error"
        told = [f"{item.key}: expected {item.expected}, got {item.got}" for item in outcome.differences] or list(outcome.reasons)
        ET.SubElement(case, tag, type=outcome.status, message=_xml("; ".join(told))).text = _xml(outcome_text(outcome))


def _xml(text: str) -> str:
    """Text without the characters that XML cannot hold."""
    return NOT_XML.sub("?", text)
