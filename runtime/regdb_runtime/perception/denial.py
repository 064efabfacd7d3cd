"""How far a denial reaches: `no cars, cyclists or pedestrians`, `is not crossing`, `traffic lights are not visible`."""

from __future__ import annotations

from regdb_runtime.perception.cues import HEARTS, NO_DENIAL, OPENERS, PLACES, TAKES_OBJECT
from regdb_runtime.perception.lexicon import FILLERS
from regdb_runtime.perception.scope import STRONG, Context, Cue
from regdb_runtime.perception.word_set import word_set

_LIST_ENDS = frozenset(("or", "nor", "and"))
NOT_REACH, AFTER_REACH = 3, 6
"""Tokens over which `not` and `... not visible` reach."""


def negation(context: Context, cue: Cue, breaks: set[int]) -> None:
    said = context.said
    at = cue.last + 1
    if at < len(said) and ((said[at] in (",", ".") and cue.first == 0) or said[at] in NO_DENIAL):
        return
    context.denied.update(range(at, _reach(said, at, breaks)))


def _reach(said: list[str], at: int, breaks: set[int]) -> int:
    """Where the reach of a denial that begins at this token ends."""
    passed = False
    while at < len(said):
        word = said[at]
        if word in STRONG or (at in breaks and (passed or word != "that")):
            return at
        if word == ",":
            if not _list_goes_on(said, at):
                return at
            passed = False
        elif word == "and":
            if at + 1 < len(said) and said[at + 1] in OPENERS:
                return at
            passed = False
        elif word in ("or", "nor"):
            passed = False
        elif word in PLACES and passed:
            after = at + 1
            while after < len(said) and (said[after] in FILLERS or said[after] == "immediate"):
                after += 1
            if after >= len(said) or said[after] not in HEARTS:
                return at
            at = after
        elif passed and word.endswith("ing") and len(word) > 5 and said[at - 1] != "sign":
            return at
        elif word not in FILLERS and word not in ("of", "1"):
            passed = True
        at += 1
    return at


def _list_goes_on(said: list[str], at: int) -> bool:
    """Whether the comma here is one of a list that `or`, `nor` or a short `and` ends: `no cars, cyclists or pedestrians`."""
    if at + 1 < len(said) and said[at + 1] in ("or", "nor"):
        return True
    if at + 1 < len(said) and (said[at + 1] in OPENERS or said[at + 1] in ("and", "but", "so", "with")):
        return False
    for later in range(at + 1, min(len(said), at + 9)):
        if said[later] in ("or", "nor"):
            return True
        if said[later] in STRONG or said[later] in ("is", "are", "the", "with"):
            return False
    return False


def refusal(context: Context, cue: Cue, breaks: set[int]) -> None:
    """`not a stop sign`, `not crossing`, `not controlled by a light`; `did not stop at the light` denies only the stopping."""
    said = context.said
    at = cue.last + 1
    while at < len(said) and said[at] in FILLERS and said[at] not in TAKES_OBJECT:
        at += 1
    if at >= len(said) or said[at] in NO_DENIAL:
        return
    if said[at] in TAKES_OBJECT:
        while at < len(said) and said[at] in TAKES_OBJECT:
            at += 1
        context.denied.update(range(at, _reach(said, at, breaks)))
        return
    context.denied.add(at)
    if said[at] in PLACES or said[at].endswith("ed"):
        for later in range(at + 1, min(len(said), at + 1 + NOT_REACH)):
            if later in breaks or said[later] in STRONG or said[later] == ",":
                break
            context.denied.add(later)


def said_after(context: Context, cue: Cue, last_of: list[tuple[int, int]], breaks: set[int]) -> None:
    """`traffic lights are not visible`, `pedestrians: none`, `the cones have been removed`."""
    said = context.said
    if said[cue.first] in ("none", "no", "0", "false"):
        listed = cue.first > 0 and said[cue.first - 1] in ":-"
        if not listed or (cue.last + 1 < len(said) and said[cue.last + 1] not in ",;"):
            return
    near = [(first, last) for first, last in last_of if last < cue.first and cue.first - last <= AFTER_REACH]
    if not near:
        return
    edge = max(last for _, last in near)
    if any(edge < at < cue.first for at in breaks) or "," in said[edge + 1 : cue.first]:
        return
    reached = edge
    for first, last in sorted(near, key=lambda item: -item[1]):
        between = said[last + 1 : reached]
        if last == edge or (reached - last <= 3 and any(word in _LIST_ENDS or word == "," for word in between)):
            if cue.kind == "ended_after":
                context.aside.setdefault(first, "ended")
            elif not _ABOUT_IT.intersection(said[max(0, first - 4) : first]):
                context.denied.add(first)
            reached = first


_ABOUT_IT = word_set("status state color phase gesture legend text speed side end")
"""`The status of the light is not visible` denies no light."""
