"""Signs that look alike: the closed question that tells them apart, and its answer as statements."""

from __future__ import annotations

from collections.abc import Sequence

from regdb.vocabulary import Fact, Value, Vocabulary
from regdb_runtime.perception.evidence import Choice, Question, Reading, Statement
from regdb_runtime.perception.policies import CHOICE, Held, Moment

NONE = "none of these"
"""The answer that is always there: a model that has to choose would choose."""


def open_question(vocabulary: Vocabulary, fact: Fact, held: Sequence[Held], now: Moment) -> Question | None:
    """The question about a fact, while the model says it is so, it looks like others, and not enough answers have come where we are."""
    policy = fact.fusion
    if policy is None or not policy.asks:
        return None
    live = [item for item in held if item.statement.source in ("model", "scripted") and item.captured <= now.time]
    near = [item for item in live if policy.fresh.covers(*now.age(item))]
    said = any(item.statement.rule != CHOICE and item.statement.value is True for item in near)
    answers = {item.captured for item in near if item.statement.rule == CHOICE}
    return make_question(vocabulary, fact) if said and len(answers) < policy.confirmations else None


def make_question(vocabulary: Vocabulary, fact: Fact) -> Question:
    """Which of the look-alikes it is. Labels are the facts' first phrases, in the order of their names so that none comes first by rank."""
    assert fact.fusion is not None
    names = sorted({fact.name, *fact.fusion.asks})
    choices = tuple(_choice(vocabulary, text) for text in names)
    listed = "; ".join(f"({chr(97 + index)}) {choice.label}" for index, choice in enumerate(choices))
    last = f"({chr(97 + len(choices))}) {NONE}"
    asked = fact.fusion.question or "Look closely at the sign or signal in this picture. Which one is it"
    return Question(fact.name, choices, f"{asked}: {listed}; {last}? Answer with one letter.")


def _choice(vocabulary: Vocabulary, text: str) -> Choice:
    name, _, word = text.partition("=")
    fact = vocabulary.fact(name)
    phrases = fact.phrases.get(word) or fact.phrases.get("true") or next(iter(fact.phrases.values()), ())
    value: Value = word or True
    return Choice(name, value, phrases[0] if phrases else fact.meaning)


def read_choice(question: Question, text: str) -> int | None:
    """The index of the choice that an answer names by its letter, its index beyond the last for none of them; None when it names no one."""
    words = [word.strip("().:,;\"' ").lower() for word in text.split()]
    letters = [chr(97 + index) for index in range(len(question.choices) + 1)]
    named = {letters.index(word) for word in words[:1] if word in letters}
    if not named:
        low = text.lower()
        spoken = {index for index, choice in enumerate(question.choices) if choice.label.lower() in low}
        named = {index for index in spoken if not any(question.choices[index].label in question.choices[other].label for other in spoken - {index})}
        named |= {len(question.choices)} if NONE in low else set()
    return named.pop() if len(named) == 1 else None


def answer(question: Question, text: str, captured: float, frame: str = "", model: str = "") -> Reading:
    """An answer as statements: the chosen one is so, the other boolean ones are not; nothing when the answer cannot be read."""
    index = read_choice(question, text)
    if index is None:
        return Reading(text)
    found = []
    for place, choice in enumerate(question.choices):
        if place == index or choice.value is True:
            value = choice.value if place == index else False
            found.append(Statement(choice.fact, value, captured=captured, rule=CHOICE, frame=frame, prompt=f"choice:{question.fact}", model=model))
    return Reading(text, tuple(found))
