"""How each piece of a sentence is meant: asserted, denied, hedged, or set aside as supposed, advised, asked, generic, future or ended."""

from __future__ import annotations

from regdb_runtime.perception.cues import ASKING, CUES, POINTING, WEAK_ADVICE
from regdb_runtime.perception.denial import negation, refusal, said_after
from regdb_runtime.perception.lexicon import FILLERS
from regdb_runtime.perception.scope import STRONG, Context, Cue, comma, definite, is_past, until_comma
from regdb_runtime.perception.sentences import Sentence, tokens
from regdb_runtime.perception.word_set import word_set

_DENIALS = frozenset(("negation", "not", "denied_after"))
HEDGE_REACH, FUTURE_REACH = 6, 5
"""Tokens over which `may` and `will` reach."""
_LIGHTS = word_set("light signal red green yellow amber arrow")


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


def cues_of(said: list[str], spoken_for: int) -> list[Cue]:
    """Every cue, longest first at each token; tokens that a fact's phrase has used (`no parking`) begin none."""
    found: list[Cue] = []
    for at, word in enumerate(said):
        if word in _BY_FIRST:
            seen: set[str] = set()
            for rest, kind in _BY_FIRST[word]:
                if kind in seen or (kind in _DENIALS and spoken_for >> at & 1):
                    continue
                if not rest or tuple(said[at + 1 : at + 1 + len(rest)]) == rest:
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
            negation(context, cue, breaks)
        elif cue.kind == "not":
            refusal(context, cue, breaks)
        elif cue.kind in ("denied_after", "ended_after"):
            said_after(context, cue, last_of, breaks)
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


def _hedge(context: Context, cue: Cue, last_of: list[tuple[int, int]]) -> None:
    said = context.said
    for at in range(cue.last + 1, min(len(said), cue.last + 1 + HEDGE_REACH)):
        if said[at] in STRONG or said[at] in (",", "because", "but"):
            break
        context.hedged.add(at)
    if said[cue.first] in ("may", "might", "could"):
        for first, last in last_of:
            if last < cue.first <= last + 2 and not definite(said, first, POINTING):
                context.hedged.add(first)


def _condition(context: Context, cue: Cue) -> None:
    until_comma(context, cue, context.aside, "conditional")


def _unsure(context: Context, cue: Cue) -> None:
    until_comma(context, cue, context.aside, "unsure")


def _when(context: Context, cue: Cue) -> None:
    said = context.said
    if any(is_past(word) for word in said[cue.last + 1 : comma(said, cue.last + 1)]):
        return
    until_comma(context, cue, context.soft, "conditional")
    until_comma(context, cue, context.colors_aside, "conditional")


def _until(context: Context, cue: Cue) -> None:
    until_comma(context, cue, context.soft, "until")
    until_comma(context, cue, context.colors_aside, "until")


def _future(context: Context, cue: Cue) -> None:
    for at in range(cue.first, min(len(context.said), cue.last + 1 + FUTURE_REACH)):
        if context.said[at] in STRONG or context.said[at] == ",":
            break
        context.colors_aside.setdefault(at, "future")


def _ended(context: Context, cue: Cue) -> None:
    said = context.said
    by_other = any(word in ("pedestrian", "person", "child", "man", "woman", "cyclist") for word in said[: cue.first])
    for at in range(cue.last + 1, min(len(said), cue.last + 5)):
        if said[at] in STRONG or said[at] in (",", "and", "but"):
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
    start = max((at + 1 for at in range(cue.first) if said[at] in STRONG or said[at] == ","), default=0)
    if any(is_past(word) for word in said[start : cue.first]):
        return
    until_comma(context, cue, context.soft, "advice", commas=True)


def _other(context: Context, cue: Cue) -> None:
    """`oncoming traffic has a green light`, `the light for the cross street is red`: no light of ours."""
    said = context.said
    link = next((at for at in range(cue.first - 1, max(-1, cue.first - 4), -1) if said[at] == "for"), -1)
    if link > 0 and said[link - 1] in _LIGHTS and "at" not in said[max(0, link - 5) : link]:
        for at in range(link, max(-1, link - 8), -1):
            if said[at] in STRONG or said[at] in (",", "but"):
                break
            context.colors_aside.setdefault(at, "other road user")
        for at in range(link, min(len(said), cue.last + 6)):
            if said[at] in STRONG or said[at] in (",", "but"):
                break
            context.colors_aside.setdefault(at, "other road user")
    after = next((word for word in said[cue.last + 1 : cue.last + 3] if word not in FILLERS), "")
    if after in ("light", "signal") or any(word in ("have", "face", "facing", "get", "see", "given") for word in said[cue.last + 1 : cue.last + 4]):
        for at in range(cue.last + 1, min(len(said), cue.last + 9)):
            if said[at] in STRONG or said[at] in (",", "but", "because", "while", "and"):
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


_ASIDE = {
    "condition": _condition, "other": _other, "when": _when, "until": _until, "future": _future, "ended": _ended, "advice": _advice,
    "generic": _generic, "unsure": _unsure,
}  # fmt: skip
