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

_UNUSUAL = 0.05
"""What a rule counts that speaks of manoeuvres beyond the paper's machine only."""


@dataclass(frozen=True)
class PromptSettings:
    """How much is asked at once.

    `facts`: how many facts of the rules, `look_for`: how many that would settle a verdict; a small model (7B, 4-bit) loses track of longer
    lists. `rotating`: how many of `facts` take turns, so that at 2 Hz each of the 50 or so that a state's rules read is asked about every
    6 s; the others are asked every time. `shots`: turns of earlier ticks that go along (0: none, as in the paper's zero-shot experiments).
    `paper_tokens`, `answer_tokens`: how long an answer in prose, and one by the schema, may become; at the 20-40 tokens a second of the
    paper's graphics card 64 are about two seconds.
    """

    facts: int = 8
    rotating: int = 4
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
        self._reach: dict[tuple[frozenset[str] | None, frozenset[str] | None], frozenset[str]] = {}
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

    def prompt(
        self, state_id: str, missing: Iterable[str] = (), history: Sequence[tuple[str, str]] = (), relevant: Collection[str] | None = None,
        turn: int = 0,
    ) -> Prompt | None:  # fmt: skip
        """What to ask in this state; None where nothing is asked (emergency). `missing`: facts that would settle an unknown verdict, the most
        wanted first (`Verdict.missing`). `relevant`: the facts that matter here, None for all: no train is asked about where the map has no
        rails. `turn`: the number of the call, by which facts take turns. Raises RequestError for a state that is not there."""
        sentence = self.sentence(state_id)
        if not sentence:
            return None
        here = self._asks if relevant is None else self._asks.intersection(relevant)
        wanted = tuple(dict.fromkeys(name for name in missing if name in self._asks))[: self.settings.look_for]
        further = self._in_turn([name for name in self.concerned(state_id) if name in here and name not in wanted], turn)
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

    def _in_turn(self, names: list[str], turn: int) -> tuple[str, ...]:
        """The first facts, and so many of the rest as take turns."""
        most, rotating = self.settings.facts, min(self.settings.rotating, self.settings.facts)
        first, rest = names[: most - rotating], names[most - rotating :]
        if len(rest) <= rotating:
            return (*first, *rest)
        begin = turn * rotating % len(rest)
        return (*first, *(rest + rest)[begin : begin + rotating])

    def _rank(self, state_id: str, rules: tuple[Regulation, ...]) -> tuple[str, ...]:
        """A rule is worth the more, the fewer states it can follow from (one for turns on red says more at a light than one that binds
        always), and gives every asked fact that it reads an equal part; a fact for which nothing may be assumed counts double. Rules for
        manoeuvres beyond the paper's machine (to park, to back) come behind, save in those states themselves."""
        states = self._machine.states
        usual = frozenset(name for name in states[state_id].next if states[state_id].extension or not states[name].extension)
        weight = dict.fromkeys(self._asks, 0.0)
        for rule in rules:
            read = [name for name in rule.facts if name in self._asks]
            if read and state_id in (sources := self._sources(rule)):
                worth = 1.0 if any(rule.concerns(state_id, name) for name in usual) else _UNUSUAL
                for name in read:
                    weight[name] += worth * len(states) / len(sources) / len(read)
        for name in self._asks:
            weight[name] *= 1.0 if self._vocabulary.facts[name].assumption is not None else 2.0
        return tuple(sorted((name for name, value in weight.items() if value), key=lambda name: (-weight[name], name)))

    def _sources(self, rule: Regulation) -> frozenset[str]:
        """The states from which a transition leads that the rule speaks of."""
        key = rule.current, rule.next
        if key not in self._reach:
            states = self._machine.states.values()
            self._reach[key] = frozenset(state.id for state in states if any(rule.concerns(state.id, following) for following in state.next))
        return self._reach[key]

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
