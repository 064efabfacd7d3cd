"""Findings as JUnit XML, which build servers read: a file is a suite, a finding a failed case."""

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from xml.etree import ElementTree as ET

from regdb_compiler.diagnostics import Diagnostic, in_order

NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, str]) -> str:
    """One suite for each file looked at; a file without findings is one passed case. Info does not fail."""
    by_path: dict[str, list[Diagnostic]] = defaultdict(list, {path: [] for path in sources})
    for finding in in_order(diagnostics):
        by_path[finding.place.path].append(finding)
    suites = ET.Element("testsuites", name="regdb")
    for path, findings in sorted(by_path.items()):
        _suite(suites, path, findings)
    cases = sum(max(len(findings), 1) for findings in by_path.values())
    failures = sum(int(suite.get("failures", "0")) for suite in suites)
    suites.set("tests", str(cases))
    suites.set("failures", str(failures))
    ET.indent(suites)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(suites, encoding="unicode") + "\n"


def _suite(suites: ET.Element, path: str, findings: list[Diagnostic]) -> None:
    failures = sum(1 for finding in findings if finding.level != "info")
    count = {"tests": str(max(len(findings), 1)), "failures": str(failures), "errors": "0", "skipped": "0"}
    suite = ET.SubElement(suites, "testsuite", {"name": _xml(path), **count})
    if not findings:
        ET.SubElement(suite, "testcase", classname=_xml(path), name="no findings")
    for finding in findings:
        _case(suite, finding)


def _case(suite: ET.Element, d: Diagnostic) -> None:
    name = f"{d.code} {d.name} at {d.place.line}:{d.place.column}"
    case = ET.SubElement(suite, "testcase", classname=_xml(d.place.path), name=name, line=str(d.place.line))
    words = "\n".join(part for part in (f"{d.place}: {d.message}", d.note, d.help, d.law) if part)
    if d.level == "info":
        ET.SubElement(case, "system-out").text = _xml(words)
    else:
        ET.SubElement(case, "failure", type=d.level, message=_xml(d.message)).text = _xml(words)


def _xml(text: str) -> str:
    """Text without the characters that XML cannot hold."""
    return NOT_XML.sub("?", text)
