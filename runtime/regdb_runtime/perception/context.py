"""How each piece of a sentence is meant: asserted, denied, hedged, or set aside as supposed, advised, asked, generic, future or ended."""

from __future__ import annotations

from dataclasses import dataclass, field

from regdb_runtime.perception.cues import ASKING, CUES, DEFINITE, NOT_PAST, POINTING, HEARTS, NO_DENIAL, OPENERS, PLACES, TAKES_OBJECT, WEAK_ADVICE
from regdb_runtime.perception.lexicon import FILLERS
from regdb_runtime.perception.sentences import Sentence, tokens
from regdb_runtime.perception.word_set import word_set

_STRONG = frozenset(";:()?")
_DENIALS = frozenset(("negation", "not", "denied_after"))
_LIST_ENDS = frozenset(("or", "nor", "and"))
NOT_REACH, HEDGE_REACH, AFTER_REACH, FUTURE_REACH = 3, 6, 6, 5
"""Tokens over which `not`, `may`, `... not visible` and `will` reach."""


def _compiled() -> dict[str, list[tuple[tuple[str, ...], str]]]:
    found: dict[str, list[tuple[tuple[str, ...], str]]] = {}
    for kind, phrases in CUES.items():
        for phrase in phrases:
            first, *rest = tokens(phrase)
            found.setdefault(first, []).append((tuple(rest), kind))
    for entries in found.values():
        entries.sort(key=lambda entry: -len(entry[0]))
    return found


_BY_FIRST = _compiled()


@dataclass(slots=True)
class Cue:
    """A cue found: tokens first..last."""

    kind: str
    first: int
    last: int


@dataclass(slots=True)
class Context:
    """What reaches which token. `denied`, `hedged`, `aside`: token index -> whether, or why; `cues` for what asks about more."""

    said: list[str]
    cues: list[Cue] = field(default_factory=list)
    denied: set[int] = field(default_factory=set)
    hedged: set[int] = field(default_factory=set)
    aside: dict[int, str] = field(default_factory=dict)
    soft: dict[int, str] = field(default_factory=dict)
    colors_aside: dict[int, str] = field(default_factory=dict)

    def why_aside(self, places: list[int]) -> str:
        """Why a phrase that rests on these tokens is no statement about the scene now; empty when it is one."""
        for at in places:
            if at in self.aside:
                return self.aside[at]
        if places[0] in self.soft and not definite(self.said, places[0]):
            return self.soft[places[0]]
        return ""


def definite(said: list[str], first: int, determiners: frozenset[str] = DEFINITE) -> bool:
    """Whether one of these determiners stands before the noun phrase that begins here: `the red light`, not `pedestrians`."""
    at = first - 1
    while at >= 0 and first - at <= 4:
        word = said[at]
        if word in determiners:
            return True
        if word in ("and", "or", "any", "of") or not word.isalpha() or word in PLACES:
            return False
        at -= 1
    return False


def cues_of(said: list[str], spoken_for: int) -> list[Cue]:
    """Every cue, longest first at each token; tokens that a fact's phrase has used (`no parking`) begin none."""
    found: list[Cue] = []
    for at, word in enumerate(said):
        if word in _BY_FIRST:
            seen: set[str] = set()
            for rest, kind in _BY_FIRST[word]:
                if kind not in seen and not (kind in _DENIALS and spoken_for >> at & 1) and (not rest or tuple(said[at + 1 : at + 1 + len(rest)]) == rest):
                    seen.add(kind)
                    found.append(Cue(kind, at, at + len(rest)))
    return found


def context_of(sentence: Sentence, spoken_for: int, last_of: list[tuple[int, int]]) -> Context:
    """Read the cues. `spoken_for`: tokens used by phrases that hold a negation of their own; `last_of`: (first, last) of the phrases."""
    said = sentence.words
    context = Context(said, cues_of(said, spoken_for))
    if sentence.ending == "?":
        _asked(context)
    breaks = {cue.first for cue in context.cues if cue.kind == "break"}
    for cue in context.cues:
        if cue.kind == "negation":
            _negation(context, cue, breaks)
        elif cue.kind == "not":
            _not(context, cue, breaks)
        elif cue.kind in ("denied_after", "ended_after"):
            _said_after(context, cue, last_of, breaks)
        elif cue.kind == "hedge":
            _hedge(context, cue, last_of)
        elif cue.kind in _ASIDE:
            _ASIDE[cue.kind](context, cue)
    return context


def _asked(context: Context) -> None:
    said = context.said
    start = 0
    for at, word in enumerate(said):
        if (at == 0 or said[at - 1] in (",", ";", ":", "and", "-")) and word in ASKING:
            start = at
            break
    else:
        return
    for at in range(start, len(said)):
        context.aside[at] = "question"


def _negation(context: Context, cue: Cue, breaks: set[int]) -> None:
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
        if word in _STRONG or (at in breaks and (passed or word != "that")):
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
        if said[later] in _STRONG or said[later] in ("is", "are", "the", "with"):
            return False
    return False


def _not(context: Context, cue: Cue, breaks: set[int]) -> None:
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
            if later in breaks or said[later] in _STRONG or said[later] == ",":
                break
            context.denied.add(later)


def _said_after(context: Context, cue: Cue, last_of: list[tuple[int, int]], breaks: set[int]) -> None:
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


_LIGHTS = word_set("light signal red green yellow amber arrow")
_ABOUT_IT = word_set("status state color phase gesture legend text speed side end")
"""`The status of the light is not visible` denies no light."""


def _hedge(context: Context, cue: Cue, last_of: list[tuple[int, int]]) -> None:
    said = context.said
    for at in range(cue.last + 1, min(len(said), cue.last + 1 + HEDGE_REACH)):
        if said[at] in _STRONG or said[at] in (",", "because", "but"):
            break
        context.hedged.add(at)
    if said[cue.first] in ("may", "might", "could"):
        for first, last in last_of:
            if last < cue.first <= last + 2 and not definite(said, first, POINTING):
                context.hedged.add(first)


def _condition(context: Context, cue: Cue) -> None:
    _until_comma(context, cue, context.aside, "conditional")


def _when(context: Context, cue: Cue) -> None:
    said = context.said
    if any(is_past(word) for word in said[cue.last + 1 : _comma(said, cue.last + 1)]):
        return
    _until_comma(context, cue, context.soft, "conditional")
    _until_comma(context, cue, context.colors_aside, "conditional")


def _until(context: Context, cue: Cue) -> None:
    _until_comma(context, cue, context.soft, "until")
    _until_comma(context, cue, context.colors_aside, "until")


def _future(context: Context, cue: Cue) -> None:
    for at in range(cue.first, min(len(context.said), cue.last + 1 + FUTURE_REACH)):
        if context.said[at] in _STRONG or context.said[at] == ",":
            break
        context.colors_aside.setdefault(at, "future")


def _ended(context: Context, cue: Cue) -> None:
    said = context.said
    by_other = any(word in ("pedestrian", "person", "child", "man", "woman", "cyclist") for word in said[: cue.first])
    for at in range(cue.last + 1, min(len(said), cue.last + 5)):
        if said[at] in _STRONG or said[at] in (",", "and", "but"):
            break
        if not by_other:
            context.aside.setdefault(at, "ended")
    for at in range(cue.first, cue.last + 1):
        context.aside.setdefault(at, "ended")


def _advice(context: Context, cue: Cue) -> None:
    said = context.said
    if " ".join(said[cue.first : cue.last + 1]) in WEAK_ADVICE:
        before = cue.first - 1
        led = before < 0 or said[before] in (",", ":", "-", "and", ";", "then", "or", "but", "please", "always")
        led = led or any(other.kind == "modal" and other.last < cue.first and cue.first - other.last <= 6 for other in context.cues)
        if not led:
            return
    start = max((at + 1 for at in range(cue.first) if said[at] in _STRONG or said[at] == ","), default=0)
    if any(is_past(word) for word in said[start : cue.first]):
        return
    _until_comma(context, cue, context.soft, "advice", commas=True)


def _other(context: Context, cue: Cue) -> None:
    """`oncoming traffic has a green light`, `the light for the cross street is red`: no light of ours."""
    said = context.said
    link = next((at for at in range(cue.first - 1, max(-1, cue.first - 4), -1) if said[at] == "for"), -1)
    if link > 0 and said[link - 1] in _LIGHTS and "at" not in said[max(0, link - 5) : link]:
        for at in range(link, max(-1, link - 8), -1):
            if said[at] in _STRONG or said[at] in (",", "but"):
                break
            context.colors_aside.setdefault(at, "other road user")
        for at in range(link, min(len(said), cue.last + 6)):
            if said[at] in _STRONG or said[at] in (",", "but"):
                break
            context.colors_aside.setdefault(at, "other road user")
    if any(word in ("have", "face", "facing", "get", "see", "given") for word in said[cue.last + 1 : cue.last + 4]):
        for at in range(cue.last + 1, min(len(said), cue.last + 9)):
            if said[at] in _STRONG or said[at] in (",", "but", "because", "while"):
                break
            context.colors_aside.setdefault(at, "other road user")


def _generic(context: Context, cue: Cue) -> None:
    if cue.first and context.said[cue.first - 1] in ("ego", "our", "my", "your", "subject", "the"):
        return
    for at in range(len(context.said)):
        if at > cue.last or at <= 1 or said_of_all(context.said):
            context.soft.setdefault(at, "generic")


def said_of_all(said: list[str]) -> bool:
    """Whether the sentence begins with a bare plural or `even with`, as rules for everybody do."""
    return said[0] in ("even", "driver", "vehicle", "all", "every", "in", "when")


def is_past(word: str) -> bool:
    """Whether this is a verb of a story: `turned`, `was`."""
    return (word.endswith("ed") and word not in NOT_PAST) or word in ("was", "were", "had", "began", "came", "saw", "went", "stood")


def _comma(said: list[str], at: int) -> int:
    while at < len(said) and said[at] != "," and said[at] not in _STRONG and said[at] != "then":
        at += 1
    return at


def _until_comma(context: Context, cue: Cue, into: dict[int, str], why: str, *, commas: bool = False) -> None:
    said = context.said
    end = _comma(said, cue.last + 1)
    while commas and end < len(said) and said[end] == ",":
        end = _comma(said, end + 1)
    for at in range(cue.last + 1, end):
        into.setdefault(at, why)


_ASIDE = {
    "condition": _condition, "other": _other, "when": _when, "until": _until, "future": _future, "ended": _ended, "advice": _advice, "generic": _generic,
    "unsure": lambda context, cue: _until_comma(context, cue, context.aside, "unsure"),
}  # fmt: skip
