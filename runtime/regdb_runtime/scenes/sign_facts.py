"""What the signs on the map say: by their MUTCD codes, which the vocabulary lists for its facts."""

from __future__ import annotations

from collections.abc import Mapping

from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.maps.road_map import Sign

AT_JUNCTION = frozenset((
    "sign.stop", "sign.yield", "sign.all_way", "sign.no_turn_on_red", "sign.no_right_turn", "sign.no_left_turn", "sign.no_u_turn",
    "sign.do_not_enter", "sign.one_way_against", "sign.stop_here_on_red", "sign.left_turn_only", "sign.right_turn_only", "sign.wrong_way",
))  # fmt: skip
"""Signs that speak of the junction at the lane's end, wherever along the lane they stand; all others speak from their place on."""

OF_THE_MOMENT = frozenset(("sign.school_beacon_flashing", "sign.school_hours", "sign.variable_limit"))
"""What such a sign shows now: its being on the map does not say."""

Codes = Mapping[str, tuple[str, ...]]
"""MUTCD code -> the facts of the vocabulary that such a sign makes true, or whose number it shows."""


def sign_codes(vocabulary: Vocabulary) -> Codes:
    """Code -> facts `sign.*` and `posted.*` that name it."""
    found: dict[str, list[str]] = {}
    for fact in vocabulary:
        if fact.name.startswith(("sign.", "posted.")) and fact.codes.get("mutcd") and fact.name not in OF_THE_MOMENT:
            found.setdefault(fact.codes["mutcd"], []).append(fact.name)
    return {code: tuple(names) for code, names in found.items()}


def sign_facts(sign: Sign, codes: Codes) -> dict[str, Value]:
    """What one sign says. A code with a letter more (`R10-11a`) is of the kind that has a fact; codes of other books say nothing."""
    names = codes.get(sign.code) or codes.get(sign.code.rstrip("abcdefgh")) or ()
    facts: dict[str, Value] = {}
    for name in names:
        if name.startswith("sign."):
            facts[name] = True
        elif sign.speed is not None:
            facts[name] = float(sign.speed)
    if "posted.speed" in names and sign.speed is None:
        return {}  # a limit without its number binds nobody; whoever reads it tells both
    return facts
