"""Findings as SARIF 2.1.0 (OASIS standard, 2020-03-27), which code hosts and editors read."""

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any
from urllib.parse import quote

from regdb_compiler.diagnostics import Diagnostic, Fix, Level, Place, RuleText, fingerprints, in_order

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
LEVELS: dict[Level, str] = {"error": "error", "warning": "warning", "info": "note"}
FINGERPRINT = "regdbLine/v1"


def render(
    diagnostics: Sequence[Diagnostic],
    sources: Mapping[str, str],
    *,
    suppressed: Sequence[tuple[Diagnostic, str]] = (),
    rules: Iterable[RuleText] = (),
    version: str = "",
) -> str:
    """One run with all findings; `suppressed` are findings with the reasons their comments give for allowing them."""
    reasons = dict(suppressed)
    findings = in_order([*diagnostics, *reasons])
    ordered = _rules(findings, rules)
    index = {rule["id"]: at for at, rule in enumerate(ordered)}
    results = [_result(d, index[d.code], name, reasons.get(d)) for d, name in zip(findings, fingerprints(findings, sources), strict=True)]
    driver = {"name": "regdb", **({"version": version} if version else {}), "rules": ordered}
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return json.dumps({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2) + "\n"


def _rules(findings: Iterable[Diagnostic], rules: Iterable[RuleText]) -> list[dict[str, Any]]:
    """Every rule once, by code: those given with their explanations, and those that only a finding names."""
    told = {d.code: (d.name, d.name.replace("-", " "), d.level) for d in findings}
    for code, name, explanation in rules:
        told[code] = (name, explanation, told[code][2] if code in told else "error")
    return [
        {
            "id": code,
            "name": name,
            "shortDescription": {"text": explanation},
            "help": {"text": explanation},
            "defaultConfiguration": {"level": LEVELS[level]},
        }
        for code, (name, explanation, level) in sorted(told.items())
    ]


def _result(d: Diagnostic, rule: int, name: str, reason: str | None) -> dict[str, Any]:
    words = "\n".join(part for part in (d.message, d.note, d.help, d.law) if part)
    result: dict[str, Any] = {
        "ruleId": d.code,
        "ruleIndex": rule,
        "level": LEVELS[d.level],
        "message": {"text": words},
        "locations": [_location(d.place)],
        "partialFingerprints": {FINGERPRINT: name},
    }
    if d.related:
        result["relatedLocations"] = [
            {"id": at, **_location(place), "message": {"text": message}} for at, (place, message) in enumerate(d.related)
        ]
    if d.fix and d.fix.edits:
        result["fixes"] = [_fix(d.fix)]
    if reason is not None:
        result["suppressions"] = [{"kind": "inSource", "justification": reason}]
    return result


def _location(place: Place) -> dict[str, Any]:
    return {"physicalLocation": {"artifactLocation": _artifact(place.path), "region": _region(place)}}


def _artifact(path: str) -> dict[str, str]:
    """A path as a URI reference; a drive letter or a colon must not read as a scheme."""
    uri = quote(path.replace("\\", "/"), safe="/")
    return {"uri": f"file://{uri}" if uri.startswith("/") else uri}


def _region(place: Place) -> dict[str, int]:
    return {
        "startLine": place.line,
        "startColumn": place.column,
        "endLine": place.end_line,
        "endColumn": place.end_column,
    }


def _fix(fix: Fix) -> dict[str, Any]:
    by_path: dict[str, list[dict[str, Any]]] = {}
    for edit in fix.edits:
        replacement = {"deletedRegion": _region(edit.place), "insertedContent": {"text": edit.text}}
        by_path.setdefault(edit.place.path, []).append(replacement)
    changes = [{"artifactLocation": _artifact(path), "replacements": parts} for path, parts in by_path.items()]
    return {"description": {"text": f"{fix.title} ({fix.kind})"}, "artifactChanges": changes}
