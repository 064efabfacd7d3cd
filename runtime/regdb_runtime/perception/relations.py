"""What single phrases cannot say: a light with its colours, arrows and flashing, and whether `pedestrian crossing` is an act or a place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from regdb_runtime.perception.lexicon import ARTICLES, BREAKS, FILLERS, Lexicon
from regdb_runtime.perception.sentences import Sentence
from regdb_runtime.perception.word_set import word_set

LINKS = word_set(
    """is are was were be being been remain remaining remained stay show showing shown showed display displaying displayed turn turning turned
    indicate indicating indicated become became change changing changed appear appearing seem seeming look looking go going went staying
    read reading lit illuminated flash flashing flashed glow glowing glowed have having has blink blinking
    blinked switch switched switching shine shining shone with in to emit emitting at"""
)
"""Between a light and its colour: `the light IS red`, `SHOWING green`."""
_LEFT_WORDS = word_set(
    """solid steady circular round bright illuminated lit flashing blinking single large traffic left right straight turn turning and or , /
    bold clear vertical horizontal pointing signal light arrow color colored hue hued lamp led"""
)
_FLASHING = word_set("flashing blinking flash blink flashed")
_PRONOUNS = word_set("it they which that both")
_FORWARD = 14
"""Tokens after a light within which its colour is looked for."""


@dataclass(frozen=True, slots=True)
class Shown:
    """A light said to show a colour. `mask`: the tokens it rests on; `anchor`: the first of them that context is judged at.

    `still`: the colour somebody waits to see changed.
    """

    color: str
    arrow: bool
    flashing: bool
    mask: int
    anchor: int
    still: bool = False


@dataclass(frozen=True, slots=True)
class LightWords:
    """The vocabulary's word classes that lights need: heads, arrows, colours by word, other things with colours, words near warning lamps."""

    heads: frozenset[str]
    arrows: frozenset[str]
    colors: dict[str, str]
    things: frozenset[str]
    warning: frozenset[str]

    @classmethod
    def of(cls, lexicon: Lexicon) -> LightWords:
        """From the classes whose names begin with `light_`."""
        colors = {word: color for color in ("red", "yellow", "green") for word in lexicon.class_of(f"light_{color}")}
        heads, arrows, things, warning = (lexicon.class_of(f"light_{name}") for name in ("head", "arrow", "thing", "warning"))
        return cls(heads, arrows, colors, things, warning)


def lights(sentence: Sentence, words: LightWords, swallowed: int, before: bool) -> Iterator[Shown]:
    """Every colour a light of the sentence is said to show. `before`: the sentence before ended speaking of a light."""
    said = sentence.words
    heads = [
        at for at, word in enumerate(said)
        if (word in words.heads or word in words.arrows) and not swallowed >> at & 1 and not _of_another(said, at, words)
    ]  # fmt: skip
    if not heads and not before:
        return
    origin = _waiting_from(said, words)
    if origin >= 0 and heads:
        mask = 1 << origin | 1 << heads[0]
        yield Shown(words.colors[said[origin]], arrow=False, flashing=False, mask=mask, anchor=origin, still=True)
        return
    colors = [at for at, word in enumerate(said) if word in words.colors and not swallowed >> at & 1]
    if not colors:
        return
    taken: set[int] = set()
    for place, head in enumerate(heads):
        for at in _left(said, head, words):
            taken.add(at)
            yield _shown(said, at, head, words)
        following = heads[place + 1] if place + 1 < len(heads) else len(said)
        for at in _right(said, head, following, words):
            if at not in taken:
                taken.add(at)
                yield _shown(said, at, head, words)
    first = next((at for at, word in enumerate(said) if word not in ("yes", "no", ",")), 0)
    if before and not taken and said[first] in _PRONOUNS:
        for at in _right(said, first, len(said), words):
            yield _shown(said, at, first, words)


def _waiting_from(said: list[str], words: LightWords) -> int:
    """The colour of `waiting for the light to change from red to green`, which it has still; -1 where nobody waits so."""
    if "from" not in said or not {"wait", "waiting", "until"}.intersection(said):
        return -1
    at = said.index("from") + 1
    return at if at + 1 < len(said) and said[at] in words.colors and said[at + 1] == "to" else -1


def _of_another(said: list[str], head: int, words: LightWords) -> bool:
    """Whether the light is a vehicle's: `its red lights`, `the lights on the bus`, `a school bus with flashing red lights`."""
    if any(word in ("its", "their", "his") for word in said[max(0, head - 3) : head]):
        return True
    after = said[head + 1 : head + 5]
    if len(after) > 1 and after[0] in ("on", "of") and any(word in words.things for word in after[1:]):
        return True
    return not _FLASHING.isdisjoint(said) and not words.warning.isdisjoint(said[max(0, head - 8) : head + 9])


def _shown(said: list[str], at: int, head: int, words: LightWords) -> Shown:
    first, last = min(at, head), max(at, head)
    span = said[max(0, first - 2) : last + 2]
    arrow = any(word in words.arrows for word in said[first : last + 2])
    flashing = any(word in _FLASHING for word in span)
    return Shown(words.colors[said[at]], arrow, flashing, 1 << at | 1 << head, first)


def _left(said: list[str], head: int, words: LightWords) -> Iterator[int]:
    """Colours that stand before the head and belong to it: `red and green lights`, `green left-turn arrow`."""
    at = head - 1
    colored = False
    while at >= 0:
        word = said[at]
        if word in words.colors:
            colored = True
            yield at
        elif (word in ARTICLES and not colored) or (word not in _LEFT_WORDS and word not in FILLERS):
            return
        at -= 1


def _right(said: list[str], head: int, following: int, words: LightWords) -> Iterator[int]:
    """Colours said of the head after it: `the light ahead is red`, `lights, currently displaying red signals`; of a change the last."""
    linked = changing = astray = False
    found: list[int] = []
    for at in range(head + 1, min(len(said), head + 1 + _FORWARD)):
        word = said[at]
        if word in ";!?" or (found and word in _NOT_YET):
            break
        if word in words.colors:
            apart = at > head + 1 and not linked and said[at - 1] not in (":", ",", "(", "-")
            if apart or (astray and not changing) or _colors_another(said, at, words):
                break
            if changing:
                found.clear()
            found.append(at)
            changing = astray = False
        elif word in _CHANGES and found:
            changing = True
        elif word in LINKS:
            linked = True
        elif at >= following and (word in words.heads or word in words.arrows) and not found:
            break
        elif found and word not in FILLERS and word not in _BETWEEN:
            astray = True
    yield from found


_CHANGES = word_set("now then to turned turn turning changed change became")
"""Between two colours of one light: the last is what it shows."""
_BETWEEN = frozenset(("and", "or", ",", "/", "have", "it", "light", "signal", "but"))
_NOT_YET = word_set("until till before when if once unless will would should must wait waiting so")
"""What comes after these is no colour that the light has now."""


def _colors_another(said: list[str], at: int, words: LightWords) -> bool:
    """Whether the colour word belongs to a thing named right after it that is no light: `a red car`."""
    if at + 1 >= len(said):
        return False
    word = said[at + 1]
    if word in BREAKS or word in LINKS or word in FILLERS or word in words.heads or word in words.arrows or word in words.colors:
        return False
    return word in words.things


ACTS = frozenset(("pedestrian.on_roadway", "pedestrian.in_crosswalk"))
PLACES_CROSSED = frozenset(("crosswalk.present", "sign.pedestrian_crossing"))
"""What `crossing` can mean beside a person: what the person does, or where."""
_OBJECTS = word_set(
    """the a an this that our its my another in at from slowly quickly street road highway intersection lane outside without between { [ avenue
    main both one two 1 2 east west north south"""
)
_NOUN_BEFORE = word_set(
    """the a an this that marked zebra railroad railway level grade designated school nearest raised signalized unsignalized painted at train"""
)
_UNREAL = word_set("to can may will should must could would might and")
_STARTED = word_set("start started starting begin began beginning begun seen continue")


def crossing_is_act(said: list[str], raw: str, at: int) -> bool:
    """Whether the `cross` or `crossing` at this token is what a person does. `raw`: the token before it as written."""
    before = said[at - 1] if at else ""
    if said[at] == "crossing":
        if before in _NOUN_BEFORE:
            return False
        if before == "pedestrian" and raw == "pedestrian":
            return at + 1 < len(said) and said[at + 1] in _OBJECTS
        return not (at + 1 < len(said) and said[at + 1] in ("sign", "zone", "area", "guard", "signal", "light"))
    if said[at] == "cross" and before in _UNREAL:
        return before == "to" and at > 1 and said[at - 2] in _STARTED
    return True
