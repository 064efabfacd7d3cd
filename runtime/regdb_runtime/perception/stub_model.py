"""A model that sees the ground truth with stated errors: answers as vision-language models do, so that everything behind it can be tried.

It is labelled `scripted` and never passes for a model. Errors come from a seed, the frame and the question, so a drive repeats to the bit.
"""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from regdb.vocabulary import Fact, Value, Vocabulary
from regdb_runtime.observation import Provenance
from regdb_runtime.perception.answer_schema import NOT_SEEN, NOTHING, SEEN, names_of, read_name
from regdb_runtime.perception.describer import Description, Frame, Prompt

Truth = Callable[[Frame], Mapping[str, Value]]
"""What is there to be seen in a frame: fact -> value, False of what is plainly not there; a fact left out cannot be made out."""


@dataclass(frozen=True, slots=True)
class ErrorRates:
    """Shares. `miss`: of things there, not mentioned; `confuse`: of things there, told as a look-alike (the vocabulary's confusables);
    `invent`: of answers, which report one thing that is absent; `fail`: of questions, which get no answer."""

    miss: float = 0.0
    invent: float = 0.0
    confuse: float = 0.0
    fail: float = 0.0

    @classmethod
    def even(cls, rate: float) -> ErrorRates:
        """One rate for misses, inventions and confusions; calls never fail."""
        return cls(rate, rate, rate)


class StubModel:
    """A describer. Asked by a schema it answers in JSON about the facts asked; asked freely it describes what it sees in sentences.

    `takes`: seconds an answer needs, told in `Description.took`; nothing sleeps.
    """

    provenance: Provenance = "scripted"

    def __init__(self, vocabulary: Vocabulary, truth: Truth, errors: ErrorRates | None = None, seed: int = 0, takes: float = 0.4) -> None:
        self._vocabulary, self._truth = vocabulary, truth
        self.errors, self._seed, self._takes = errors or ErrorRates(), seed, takes

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """What it sees, or says it sees; a failure where an answer would come after the deadline."""
        chance = random.Random(f"{self._seed} {frame.id} {prompt.name} {prompt.crop}")
        if self._takes > deadline or chance.random() < self.errors.fail:
            return Description("", "deadline", f"an answer takes {self._takes:g} s", deadline, "stub")
        truth = self._truth(frame)
        asked = self._asked(prompt)
        names = [name for name in truth if self._can_say(name)] if asked is None else [name for name in asked if name in truth]
        said = self._wrong(truth, sorted(names), chance)
        text = self._sentences(said) if asked is None else self._json(said, asked)
        return Description(text, took=self._takes, model="stub")

    def _asked(self, prompt: Prompt) -> tuple[str, ...] | None:
        """Facts that a prompt's schema asks about, in its order; None where it asks freely."""
        if prompt.schema is None:
            return None
        items = prompt.schema["properties"][SEEN]["items"]
        found = [read_name(name, self._vocabulary) for name in items.get("enum", ())]
        return tuple(dict.fromkeys(item[0].name for item in found if item is not None))

    def _can_say(self, name: str) -> bool:
        fact = self._vocabulary.facts.get(name)
        return fact is not None and bool(fact.phrases) and fact.kind in {"boolean", "enumeration"}

    def _wrong(self, truth: Mapping[str, Value], names: Sequence[str], chance: random.Random) -> dict[str, Value]:
        """The truth as it is said: every fact draws its error, whether or not it makes one, so that rates do not shift the draws."""
        said: dict[str, Value] = {}
        absent = sorted(name for name in names if truth[name] is False)
        invented = chance.choice(absent) if chance.random() < self.errors.invent and absent else ""
        for name in names:
            fact, value, draw = self._vocabulary.fact(name), truth[name], chance.random()
            there = value not in (False, NOTHING)
            if there and draw < self.errors.confuse:
                other = self._look_alike(fact, chance)
                if other is not None:
                    said[other] = True
                continue
            if there and draw < self.errors.confuse + self.errors.miss:
                if fact.kind == "boolean" and chance.random() < 0.5:
                    said[name] = False
                continue
            said[name] = True if name == invented else value
        return said

    def _look_alike(self, fact: Fact, chance: random.Random) -> str | None:
        names = [name.partition("=")[0] for name in fact.confusables]
        others = [name for name in names if name in self._vocabulary and self._vocabulary.facts[name].kind == "boolean" and name != fact.name]
        return chance.choice(sorted(others)) if others else None

    def _json(self, said: Mapping[str, Value], asked: tuple[str, ...]) -> str:
        there = [item for item in self._facts(said) if item[1] not in (False, NOTHING)]
        seen = [names_of(fact)[0] if fact.kind == "boolean" else f"{name}={value}" for name, value, fact in there]
        absent = [name for name, value, fact in self._facts(said) if value is False and fact.kind == "boolean" and name in asked]
        return json.dumps({SEEN: seen, NOT_SEEN: absent} if absent else {SEEN: seen})

    def _facts(self, said: Mapping[str, Value]) -> list[tuple[str, Value, Fact]]:
        return [(name, value, self._vocabulary.facts[name]) for name, value in sorted(said.items())]

    def _sentences(self, said: Mapping[str, Value]) -> str:
        """One sentence for each thing that is there, in the vocabulary's first phrase for it; of what is absent models say nothing unasked."""
        lines = []
        for _, value, fact in self._facts(said):
            phrases = fact.phrases.get("" if fact.kind == "boolean" else str(value), ())
            plain = [phrase for phrase in phrases if "{" not in phrase]
            if value not in (False, NOTHING) and plain:
                lines.append(f"The image shows: {plain[0]}.")
        return " ".join(lines) or "The road ahead is quiet."
