"""Rows of `fact_fusion` as each fact's rules of belief."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from regdb.content_hash import Table
from regdb.fusion_policy import FusionPolicy, Permissive, Reach

_COLUMNS = (
    "fact", "ages", "holds_s", "holds_m", "fresh_s", "fresh_m", "confirmations", "within_s", "apart_s", "replaced", "permissive",
    "permissive_above", "permissive_below", "corroboration", "strictest", "least", "most", "step", "asks", "question", "ends", "places",
    "because",
)  # fmt: skip


def read_fusion(tables: Mapping[str, Table]) -> dict[str, FusionPolicy]:
    """Fact -> its policy; none in a file of an earlier minor."""
    if "fact_fusion" not in tables:
        return {}
    return {row[0]: _policy(dict(zip(_COLUMNS, row, strict=True))) for row in tables["fact_fusion"].select(*_COLUMNS)}


def _policy(row: Mapping[str, Any]) -> FusionPolicy:
    words = {name: tuple(json.loads(row[name])) for name in ("permissive", "corroboration", "strictest", "asks", "ends", "places")}
    return FusionPolicy(
        row["ages"], _reach(row, "holds"), _reach(row, "fresh"), row["confirmations"], row["within_s"], row["apart_s"],
        Permissive(words["permissive"], row["permissive_above"], row["permissive_below"]), words["corroboration"], bool(row["replaced"]),
        words["strictest"], row["least"], row["most"], row["step"], words["asks"], row["question"], words["ends"], words["places"],
        row["because"],
    )  # fmt: skip


def _reach(row: Mapping[str, Any], name: str) -> Reach:
    seconds, metres = row[f"{name}_s"], row[f"{name}_m"]
    return Reach(math.inf if seconds is None else seconds, math.inf if metres is None else metres)
