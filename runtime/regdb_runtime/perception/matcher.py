"""Free text about a driving scene -> statements about facts with the words they rest on, and what was set aside; silence says nothing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from regdb.units import UnitError, to_si, unit_named
from regdb.vocabulary import Value, Vocabulary
from regdb_runtime.perception.context import context_of
from regdb_runtime.perception.evidence import Certainty, Reading, Span, Statement
from regdb_runtime.perception.lexicon import ARTICLES, FILLERS, GAP, QUOTES, Match, compile_lexicon
from regdb_runtime.perception.normalise import Normalised, normalise
from regdb_runtime.perception.relations import ACTS, PLACES_CROSSED, LightWords, Shown, crossing_is_act, lights
from regdb_runtime.perception.scope import Context
from regdb_runtime.perception.sentences import Sentence, sentences
from regdb_runtime.perception.speeds import FACTS as SPEED_FACTS
from regdb_runtime.perception.speeds import Speed, SpeedWords, speeds

LIGHT_FACTS = ("signal.color", "signal.shape", "signal.flashing", "signal.present")
"""What the relation of light and colour speaks of."""
_OF_A_LIGHT = frozenset(("signal.shape", "signal.flashing"))
"""Said of one light among several: kept for each, with its words."""
_SPEEDS = frozenset(SPEED_FACTS.values())


@dataclass(frozen=True, slots=True)
class _Said:
    """One value of one fact, the tokens it rests on, and how it is meant."""

    fact: str
    value: Value
    mask: int
    rule: str
    hedged: bool


class Matcher:
    """Compiled once from the vocabulary; reads any number of texts. Raises PhraseError for a vocabulary whose phrases do not compile."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary
        self._lexicon = compile_lexicon(vocabulary)
        self._lights = LightWords.of(self._lexicon)
        self._speeds = SpeedWords.of(self._lexicon)
        for entry in self._lexicon.entries.values():
            said = {effect.fact for effect in entry.effects}
            entry.crossing = not said.isdisjoint(ACTS), not said.isdisjoint(PLACES_CROSSED)
        self._facts = vocabulary.facts
        self._has_lights = bool(self._lights.heads) and all(name in vocabulary for name in LIGHT_FACTS)
        self._entails = {fact.name: tuple(name for name in fact.entails if name in vocabulary) for fact in vocabulary if fact.entails}

    def read(self, text: str, captured: float = 0.0, frame: str = "", prompt: str = "", model: str = "") -> Reading:
        """All that the text says of the vocabulary's facts; places are in `text` as given."""
        normal = normalise(text)
        statements: list[Statement] = []
        aside: list[tuple[str, Span, str]] = []
        make = partial(Statement, source="model", captured=captured, frame=frame, prompt=prompt, model=model)
        before = False
        for sentence in sentences(normal):
            reader = _SentenceReader(self, normal, sentence)
            reader.read(before)
            for said in reader.said:
                certainty: Certainty = "hedged" if said.hedged else "asserted"
                statements.append(make(said.fact, said.value, certainty, spans=reader.spans(said.mask), rule=said.rule))
            aside += ((name, reader.span(mask), why) for name, mask, why in reader.aside)
            before = reader.ends_with_light
        return Reading(text, tuple(statements), tuple(aside))


class _SentenceReader:
    """One sentence read: what it says and what is set aside, in order."""

    def __init__(self, matcher: Matcher, normal: Normalised, sentence: Sentence) -> None:
        self.matcher, self.normal, self.sentence = matcher, normal, sentence
        self.said: list[_Said] = []
        self.aside: list[tuple[str, int, str]] = []
        self.ends_with_light = False
        self._decided: dict[int, str] = {}

    def read(self, before: bool) -> None:
        """Find, weigh and record."""
        matcher, words = self.matcher, self.sentence.words
        all_found = matcher._lexicon.find(self.sentence)
        found = _longest(all_found, words)
        swallowed = 0
        for match in all_found:
            if not match.entry.effects and (GAP in match.entry.phrase or _close(match, words)):
                swallowed |= match.mask
        shown = list(lights(self.sentence, matcher._lights, swallowed, before)) if matcher._has_lights else []
        self.ends_with_light = any(word in matcher._lights.heads for word in words)
        limits = [found for found in speeds(self.sentence, matcher._speeds) if found.fact in matcher._facts] if self.sentence.numbers else []
        facts = [match for match in found if self._meant(match)]
        if not facts and not shown and not limits:
            return
        self._decided = {limit.number: limit.fact for limit in limits}
        denying = 0
        for match in facts:
            denying |= match.mask
        places = [(match.first, match.last) for match in facts] + [(light.anchor, light.mask.bit_length() - 1) for light in shown]
        context = context_of(self.sentence, denying, places)
        for match in facts:
            self._record(match, context)
        for light in shown:
            self._record_light(light, context)
        for limit in limits:
            self._record_speed(limit, context)
        self._settle()

    def _meant(self, match: Match) -> bool:
        """False for a crossing read as an act where it is a place, and the other way round."""
        words = self.sentence.words
        acts, places = match.entry.crossing
        if not acts and not places:
            return True
        for at in range(match.first, match.last + 1):
            if match.mask >> at & 1 and words[at] in ("crossing", "cross"):
                if not acts and (at == match.first or words[at - 1] != "pedestrian"):
                    continue
                start, end = self.sentence.starts[at - 1], self.sentence.ends[at - 1]
                if crossing_is_act(words, self.normal.text[start:end] if at else "", at) is not acts:
                    return False
        return True

    def _record(self, match: Match, context: Context) -> None:
        places = [at for at in range(match.first, match.last + 1) if match.mask >> at & 1]
        why = context.why_aside(places)
        denied = not context.denied.isdisjoint(places)
        hedged = not context.hedged.isdisjoint(places)
        for effect in match.entry.effects:
            value = effect.value if effect.value is not None else self._number(effect.fact, match.number)
            if value is None or (effect.fact in _SPEEDS and self._decided.get(match.number, effect.fact) != effect.fact):
                continue
            if effect.fact == "signal.color" and not why:
                why = next((context.colors_aside[at] for at in range(match.first, match.last + 1) if at in context.colors_aside), "")
            if why or (denied and not isinstance(value, bool)):
                self.aside.append((effect.fact, match.mask, why or "denied"))
            else:
                meant = value is not denied if isinstance(value, bool) else value
                self.said.append(_Said(effect.fact, meant, match.mask, f"phrase {match.entry.phrase!r}", hedged))

    def _number(self, name: str, at: int) -> Value | None:
        """The number at this token in SI; without a unit the fact's usual one is meant. None where the unit does not fit."""
        number = self.sentence.numbers.get(at)
        if number is not None and not number.unit:
            number = next((other for other in self.sentence.numbers.values() if other.value == number.value and other.unit), number)
        fact = self.matcher._facts[name]
        if number is None:
            return None
        if fact.kind == "count":
            return int(number.value) if not number.unit and number.value == int(number.value) else None
        try:
            unit = unit_named(number.unit or fact.unit)
        except UnitError:
            return None
        return to_si(number.value, unit.symbol) if fact.kind == "quantity" and unit.dimension == fact.dimension else None

    def _record_speed(self, limit: Speed, context: Context) -> None:
        first = (limit.mask & -limit.mask).bit_length() - 1
        value = self._number(limit.fact, limit.number)
        last = limit.mask.bit_length() - 1
        why = context.why_aside([first, last]) or ("denied" if first in context.denied or last in context.denied else "")
        if value is None:
            return
        if why:
            self.aside.append((limit.fact, limit.mask, why))
        else:
            self.said.append(_Said(limit.fact, value, limit.mask, "number on a sign", first in context.hedged or last in context.hedged))

    def _record_light(self, light: Shown, context: Context) -> None:
        first, last = light.anchor, light.mask.bit_length() - 1
        if light.still:
            self.said.append(_Said("signal.color", light.color, light.mask, "waits for a change", hedged=False))
            return
        why = context.why_aside([first, last])
        why = why or next((context.colors_aside[at] for at in range(first, last + 1) if at in context.colors_aside), "")
        if not why and (first in context.denied or last in context.denied):
            why = "denied"
        if why:
            self.aside.append(("signal.color", light.mask, why))
            return
        hedged = first in context.hedged or last in context.hedged
        shape = "arrow" if light.arrow else "circular"
        self.said.append(_Said("signal.color", light.color, light.mask, "light and colour", hedged))
        if light.arrow:
            self.said.append(_Said("signal.shape", shape, light.mask, "light and colour", hedged))
        if light.flashing:
            self.said.append(_Said("signal.flashing", value=True, mask=light.mask, rule="light and colour", hedged=hedged))

    def _settle(self) -> None:
        """What the facts entail, then each statement once, in the order of its place."""
        for said in tuple(self.said):
            if said.value is not False and said.value != "none":
                for name in self.matcher._entails.get(said.fact, ()):
                    self.said.append(_Said(name, value=True, mask=said.mask, rule=f"{said.rule}, by {said.fact}", hedged=said.hedged))
        once: dict[tuple[str, Value, int], _Said] = {}
        for said in self.said:
            key = said.fact, said.value, said.mask if said.fact in _OF_A_LIGHT else 0
            held = once.get(key)
            if held is None or (held.hedged and not said.hedged):
                once[key] = said
        self.said = sorted(once.values(), key=lambda item: item.mask & -item.mask)

    def spans(self, mask: int) -> tuple[Span, ...]:
        """The words at these tokens, neighbouring ones joined."""
        made: list[Span] = []
        first = last = (mask & -mask).bit_length() - 1
        for at in range(first + 1, mask.bit_length()):
            if mask >> at & 1:
                if any(word not in FILLERS for word in self.sentence.words[last + 1 : at]):
                    made.append(self._place(first, last))
                    first = at
                last = at
        made.append(self._place(first, last))
        return tuple(made)

    def span(self, mask: int) -> Span:
        """From the first to the last of these tokens."""
        return self._place((mask & -mask).bit_length() - 1, mask.bit_length() - 1)

    def _place(self, first: int, last: int) -> Span:
        return Span(*self.normal.original(self.sentence.starts[first], self.sentence.ends[last]))


def _longest(found: list[Match], words: list[str]) -> list[Match]:
    """Matches that lie within no longer one; legends only where they stand alone; what a swallowing phrase touches is gone."""
    kept: list[Match] = []
    masks: list[int] = []
    swallows: list[int] = []
    for match in sorted(found, key=_size):
        entry, mask = match.entry, match.mask
        if entry.legend and not _alone(match, words):
            continue
        if not entry.effects:
            if GAP in entry.phrase or _close(match, words):
                swallows.append(mask)
            continue
        if any(mask & other == mask and mask != other for other in masks):
            continue
        masks.append(mask)
        kept.append(match)
    if swallows:
        kept = [match for match in kept if not any(match.mask & other and match.mask & other != other for other in swallows if other != match.mask)]
        masks.append(0)
    return [match for match in kept if not (words[match.first] == "no" and _runs_on(match, kept))] if "no" in words else kept


def _size(match: Match) -> tuple[int, int]:
    return -match.mask.bit_count(), match.first


def _close(match: Match, words: list[str]) -> bool:
    """Whether nothing but articles stands between the tokens of a match."""
    return all(match.mask >> at & 1 or words[at] in ARTICLES for at in range(match.first, match.last + 1))


def _runs_on(match: Match, kept: list[Match]) -> bool:
    """Whether the `no` of a match denies a longer noun instead: `no parking lot` forbids no parking."""
    return any(other.first > match.first and other.mask >> match.last & 1 and other.last > match.last for other in kept)


def _alone(match: Match, words: list[str]) -> bool:
    """Whether the phrase is a legend: all of the sentence, or between quotation marks, or before the word `sign`."""
    before, after = match.first - 1, match.last + 1
    opened = before < 0 or words[before] in QUOTES or words[before] in ":-"
    closed = after >= len(words) or words[after] in QUOTES
    return (opened and closed) or (after < len(words) and words[after] == "sign")
