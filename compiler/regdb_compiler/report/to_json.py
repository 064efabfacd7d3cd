"""Findings as JSON, in a form that stays: `JSON_SCHEMA` describes it."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Place, fingerprints, in_order
from regdb_compiler.report.summary import summarize

VERSION = 1
_PLACE = {
    "type": "object",
    "required": ["path", "line", "column", "end_line", "end_column"],
    "properties": {
        "path": {"type": "string"},
        **{key: {"type": "integer", "minimum": 1} for key in ("line", "column", "end_line", "end_column")},
    },
    "additionalProperties": False,
}
_EDIT = {
    "type": "object",
    "required": ["place", "text"],
    "properties": {"place": _PLACE, "text": {"type": "string"}},
    "additionalProperties": False,
}
_FIX = {
    "type": ["object", "null"],
    "required": ["kind", "title", "edits"],
    "properties": {
        "kind": {"enum": ["safe", "unsafe", "legal"]},
        "title": {"type": "string"},
        "edits": {"type": "array", "items": _EDIT},
    },
    "additionalProperties": False,
}
_RELATED = {
    "type": "object",
    "required": ["place", "message"],
    "properties": {"place": _PLACE, "message": {"type": "string"}},
    "additionalProperties": False,
}
_FINDING = {
    "code": {"type": "string", "pattern": "^[A-Z]{1,4}[0-9]{3,4}$"},
    "level": {"enum": ["error", "warning", "info"]},
    **{key: {"type": "string"} for key in ("name", "message", "note", "help", "law", "fingerprint")},
    "place": _PLACE,
    "related": {"type": "array", "items": _RELATED},
    "fix": _FIX,
}
_COUNTS = ("errors", "warnings", "infos", "files", "fixable")
JSON_SCHEMA: dict[str, Any] = {
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": "Findings of regdb",
    "type": "object",
    "required": ["version", "summary", "diagnostics"],
    "properties": {
        "version": {"const": VERSION},
        "summary": {
            "type": "object",
            "required": list(_COUNTS),
            "properties": {key: {"type": "integer", "minimum": 0} for key in _COUNTS},
            "additionalProperties": False,
        },
        "diagnostics": {
            "type": "array",
            "items": {
                "type": "object",
                "required": sorted(_FINDING),
                "properties": _FINDING,
                "additionalProperties": False,
            },
        },
    },
    "additionalProperties": False,
}


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, str]) -> str:
    """One JSON object with a summary and the findings in order."""
    findings = in_order(diagnostics)
    told = [_finding(d, name) for d, name in zip(findings, fingerprints(findings, sources), strict=True)]
    data = {"version": VERSION, "summary": asdict(summarize(findings)), "diagnostics": told}
    return json.dumps(data, indent=2, ensure_ascii=True) + "\n"


def _finding(d: Diagnostic, name: str) -> dict[str, Any]:
    return {
        "code": d.code,
        "name": d.name,
        "level": d.level,
        "message": d.message,
        "place": _place(d.place),
        "note": d.note,
        "help": d.help,
        "law": d.law,
        "related": [{"place": _place(place), "message": message} for place, message in d.related],
        "fix": _fix(d.fix) if d.fix else None,
        "fingerprint": name,
    }


def _place(place: Place) -> dict[str, Any]:
    return asdict(place)


def _fix(fix: Fix) -> dict[str, Any]:
    return {"kind": fix.kind, "title": fix.title, "edits": [_edit(edit) for edit in fix.edits]}


def _edit(edit: Edit) -> dict[str, Any]:
    return {"place": _place(edit.place), "text": edit.text}
