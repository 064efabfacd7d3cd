"""Three-valued truth: True, False, and None for unknown, joined as Kleene's strong logic joins them."""

from collections.abc import Iterable

Truth = bool | None
"""True, False, or None: not known. Unknown is never false."""

UNKNOWN: None = None


def negate(value: Truth) -> Truth:
    """Not: unknown stays unknown."""
    return None if value is None else not value


def conjoin(values: Iterable[Truth]) -> Truth:
    """And: false if any is false, else unknown if any is unknown, else true (also of nothing)."""
    result: Truth = True
    for value in values:
        if value is False:
            return False
        if value is None:
            result = None
    return result


def disjoin(values: Iterable[Truth]) -> Truth:
    """Or: true if any is true, else unknown if any is unknown, else false (also of nothing)."""
    result: Truth = False
    for value in values:
        if value is True:
            return True
        if value is None:
            result = None
    return result


def spell(value: Truth) -> str:
    """The word a person reads: true, false or unknown."""
    return "unknown" if value is None else "true" if value else "false"
