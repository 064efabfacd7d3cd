"""What a state asks the model: the paper's sentence word for word, then the facts that its rules read, then what would settle a verdict."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field

from regdb.regulation import Regulation
from regdb.states import StateMachine
from regdb.vocabulary import Fact, Vocabulary
from regdb_runtime.errors import RequestError
from regdb_runtime.legality import View
from regdb_runtime.perception.answer_schema import AnswerLimits, answer_schema, can_be_asked, names_of
from regdb_runtime.perception.describer import Prompt

Turns = tuple[tuple[str, str], ...]
"""(question, answer) of earlier ticks, oldest first."""


@dataclass(frozen=True)
class PromptSettings:
    """How much is asked at once. `facts`: how many facts of the rules, `look_for`: how many that would settle a verdict; a small model
    (7B, 4-bit) loses track of longer lists. `shots`: turns of earlier ticks that go along (0: none, as in the paper's zero-shot
    experiments). `paper_tokens`, `answer_tokens`: how long an answer in prose, and one by the schema, may become; at the 20-40 tokens a
    second of the paper's graphics card 64 are about two seconds."""

    facts: int = 8
    look_for: int = 4
    shots: int = 0
    paper_tokens: int = 64
    answer_tokens: int = 128
    limits: AnswerLimits = field(default_factory=AnswerLimits)


class PromptMaker:
    """Prompts by state. Without a view of the law, and with nothing missing, the paper's sentence alone.

    `asks`: the facts that this model is to tell; None stands for every fact of source perception. Facts that a picture cannot answer, or
    that no phrase of the vocabulary reveals, are never asked.
    """

    def __init__(
        self, machine: StateMachine, vocabulary: Vocabulary, view: View | None = None, settings: PromptSettings | None = None,
        asks: Collection[str] | None = None,
    ) -> None:  # fmt: skip
        self._machine, self._vocabulary = machine, vocabulary
        self._view, self.settings = view, settings or PromptSettings()
        told = asks if asks is not None else [fact.name for fact in vocabulary if fact.source == "perception"]
        self._asks = frozenset(name for name in told if name in vocabulary and can_be_asked(vocabulary.facts[name]))
        self._ranked: dict[str, tuple[str, ...]] = {}
        self._rules: tuple[Regulation, ...] | None = view.rules if view is not None else None

    @property
    def asks(self) -> frozenset[str]:
        """The facts that may be asked about."""
        return self._asks

    def under(self, view: View | None) -> PromptMaker:
        """The same maker for the law of another place or day; this one where the rules are the same."""
        if view is self._view or (view is not None and view.rules is self._rules):
            return self
        return PromptMaker(self._machine, self._vocabulary, view, self.settings, self._asks)

    def sentence(self, state_id: str) -> str:
        """The state's own prompt, else its super-state's: the paper's, word for word. Raises RequestError for a state that is not there."""
        state = self._machine.states.get(state_id)
        if state is None:
            raise RequestError(f"unknown state {state_id!r}; a prompt is asked for by a state's id, such as {self._first()!r}")
        return state.prompt or self._machine.super_states[state.super_state].prompt

    def prompt(self, state_id: str, missing: Iterable[str] = (), history: Sequence[tuple[str, str]] = ()) -> Prompt | None:
        """What to ask in this state; None where nothing is asked (emergency). `missing`: facts that would settle an unknown verdict, the most
        wanted first (`Verdict.missing`). Raises RequestError for a state that is not there."""
        sentence = self.sentence(state_id)
        if not sentence:
            return None
        wanted = tuple(dict.fromkeys(name for name in missing if name in self._asks))[: self.settings.look_for]
        further = tuple(name for name in self.concerned(state_id) if name not in wanted)[: self.settings.facts]
        turns = tuple(history)[-self.settings.shots :] if self.settings.shots else ()
        if not wanted and not further:
            return Prompt(sentence, None, turns, state_id, self.settings.paper_tokens)
        facts = [self._vocabulary.facts[name] for name in (*wanted, *further)]
        schema = answer_schema(facts, self.settings.limits)
        return Prompt(self._worded(sentence, wanted, further), schema, turns, state_id, self.settings.answer_tokens)

    def concerned(self, state_id: str) -> tuple[str, ...]:
        """Facts asked about that rules of the transitions out of this state read, those that decide most first; nothing without a view."""
        if self._rules is None:
            return ()
        found = self._ranked.get(state_id)
        if found is None:
            found = self._ranked[state_id] = self._rank(state_id, self._rules)
        return found

    def _rank(self, state_id: str, rules: tuple[Regulation, ...]) -> tuple[str, ...]:
        """Each rule gives every asked fact that it reads an equal part of one; a fact for which nothing may be assumed counts double; what is
        read here more than elsewhere comes before what every state asks."""
        following = self._machine.states[state_id].next
        here, everywhere = dict.fromkeys(self._asks, 0.0), dict.fromkeys(self._asks, 0.0)
        for rule in rules:
            read = [name for name in rule.facts if name in self._asks]
            reaches = any(rule.concerns(state_id, state) for state in following)
            for name in read:
                everywhere[name] += 1 / len(read)
                here[name] += 1 / len(read) if reaches else 0.0
        weight = {
            name: part * part / everywhere[name] * (1.0 if self._vocabulary.facts[name].assumption is not None else 2.0)
            for name, part in here.items() if part
        }  # fmt: skip
        return tuple(sorted(weight, key=lambda name: (-weight[name], name)))

    def _worded(self, sentence: str, wanted: tuple[str, ...], further: tuple[str, ...]) -> str:
        parts = [sentence]
        if wanted:
            parts.append("Look for these first:\n" + "\n".join(_line(self._vocabulary.facts[name]) for name in wanted))
        if further:
            parts.append("Then for these:\n" + "\n".join(_line(self._vocabulary.facts[name]) for name in further))
        parts.append(
            'Answer in JSON: "seen" and "not_seen" hold names of these lists; leave out what you cannot make out. '
            '"sign_text" holds the words on signs as written, "speed_limit" the number on a speed limit sign.'
        )
        return "\n".join(parts)

    def _first(self) -> str:
        return next(iter(self._machine.states), "none")


def _line(fact: Fact) -> str:
    names = names_of(fact)
    named = fact.name if names == (fact.name,) else " or ".join(names)
    return f"- {named}: {fact.meaning}"
