"""Outcomes and coverage as stable JSON."""

from __future__ import annotations

import datetime
import json
from collections.abc import Iterable
from typing import Any

from regdb.explanation import RuleReason, show_bound
from regdb.meaning import Decision
from regdb.truth import spell
from regdb_compiler.law_tests.coverage import KINDS, Coverage
from regdb_compiler.law_tests.outcome import Outcome, tally

FORMAT_VERSION = 1


def render(outcomes: Iterable[Outcome], coverage: Coverage | None = None) -> str:
    """One JSON object: `summary`, `tests`, and `coverage` where it was counted. Ends with a line feed."""
    kept = tuple(outcomes)
    found = tally(kept)
    data: dict[str, Any] = {
        "version": FORMAT_VERSION,
        "summary": {
            "passed": found.passed, "failed": found.failed, "broken": found.broken,
            "regulations": found.regulations, "cases": found.cases,
        },
        "tests": [_outcome(item) for item in kept],
    }  # fmt: skip
    if coverage is not None:
        data["coverage"] = coverage_data(coverage)
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def _outcome(outcome: Outcome) -> dict[str, Any]:
    test = outcome.test
    data: dict[str, Any] = {
        "name": test.name,
        "status": outcome.status,
        "path": test.where.path,
        "line": test.where.line,
        "regulation": test.entry.id if test.entry is not None else None,
        "subject": test.subject,
        "on": datetime.date.fromordinal(test.day).isoformat(),
        "in": test.place,
        "plan": None if test.plan is None else {"current": test.plan.current, "next": test.plan.next},
    }
    if outcome.decision is not None:
        data["decision"] = _decision(outcome.decision)
    if outcome.status != "passed":
        data["differences"] = [{"key": d.key, "expected": d.expected, "got": d.got} for d in outcome.differences]
        data["reasons"] = list(outcome.reasons)
    if outcome.status == "failed" and outcome.explanation is not None:
        found = outcome.explanation
        data["because"] = [_reason(item) for item in found.because]
        data["unless"] = [_reason(item) for item in found.unless]
        data["turn"] = [str(change) for change in found.turn]
    return data


def _decision(decision: Decision) -> dict[str, Any]:
    return {
        "verdict": decision.verdict,
        "deciding": [rule.id for rule in decision.deciding],
        "limits": {name: show_bound(item.bound, item.limit) for name, item in sorted(decision.combined.items())},
        "unknown": list(decision.missing),
        "assumed": list(decision.assumed),
    }


def _reason(reason: RuleReason) -> dict[str, Any]:
    return {
        "id": reason.regulation.id,
        "citation": reason.regulation.citation,
        "holds": spell(reason.holds),
        "evidence": [
            {"literal": item.literal, "truth": spell(item.truth), "values": dict(item.values), "assumed": list(item.assumed)}
            for item in reason.evidence
        ],
    }


def coverage_data(found: Coverage) -> dict[str, Any]:
    """Counts for each code and in all, and every item that no test has shown."""
    return {
        "percent": round(found.percent, 2),
        "total": _counts(found, None),
        "codes": {code: _counts(found, code) for code in found.codes},
        "uncovered": [
            {"regulation": row.regulation.id, "kind": item.kind, "what": item.what, "path": item.place.path, "line": item.place.line}
            for row, item in found.uncovered
        ],
    }


def _counts(found: Coverage, code: str | None) -> dict[str, Any]:
    pairs = {kind: found.count(code, kind) for kind in KINDS}
    return {kind: {"covered": covered, "all": total} for kind, (covered, total) in pairs.items()}
