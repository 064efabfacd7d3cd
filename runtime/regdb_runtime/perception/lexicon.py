"""The vocabulary's phrases and word classes, compiled into one trie that finds every phrase of a sentence in one pass."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from regdb.vocabulary import Fact, Value, Vocabulary
from regdb_runtime.perception.normalise import normalise
from regdb_runtime.perception.sentences import Sentence, tokens
from regdb_runtime.perception.word_set import word_set

SWALLOW = "swallow"
"""The word class whose phrases mean something else than the shorter phrases within them."""
GAP = "~"
"""In a phrase: up to `GAP_WORDS` words that are no mark."""
GAP_WORDS = 4
NUMBER = "{n}"
BREAKS = frozenset(",.;:!?()\n-")
QUOTES = frozenset("\"'[]")

FILLERS = word_set(
    """a an the this that these those some any several many few multiple various both all each every our its their his her my your is are was
    were be been being am s have had currently now already still also very just clearly really quite directly immediately visible immediate
    apparent obvious other another certain large small big little tall short old new active notable specific particular slowly quickly
    safely carefully there it fully completely more most discernible single"""
) | frozenset("\"'[]")
"""Words a phrase is read over: articles, forms of `be`, adverbs and adjectives that change no fact. Negations are never among them."""


@dataclass(frozen=True, slots=True)
class Effect:
    """What a phrase says: a fact and its value; None stands for the number found in the phrase."""

    fact: str
    value: Value | None


@dataclass(slots=True)
class Entry:
    """One phrase; one without effects swallows the shorter ones in it. `legend`: it counts only as the whole of a sentence, quotation or sign.

    `crossing`: whether it speaks of somebody crossing, and of a place to cross.
    """

    phrase: str
    effects: list[Effect] = field(default_factory=list)
    legend: bool = False
    crossing: tuple[bool, bool] = (False, False)


@dataclass(slots=True)
class Match:
    """A phrase found: tokens first..last (inclusive), `mask` has the bit of each token it rests on."""

    entry: Entry
    first: int
    last: int
    mask: int
    number: int = -1


class PhraseError(ValueError):
    """A phrase that cannot be compiled: an unknown word class, or nothing but words that are read over."""


_DIGITS = frozenset("0123456789")
ARTICLES = frozenset(("the", "a", "an"))
GLUE = word_set(
    """at in on near along around from with through behind beside within across toward into by of to for and or is as off over under enter read
    say state show cover ahead follow not block obstruct ban prohibit forbid mark designate after before between due {n}"""
)
"""Words beside which an article changes nothing: prepositions, verbs that take objects."""
_SOLID = ("vehicle", "person", "light_head", "place")
"""Word classes whose words no gap passes over: what stands behind them belongs to them."""
_PIECES = re.compile(r"\{[^}]+\}|[^{]+")
_END = ""


class Lexicon:
    """Compiled phrases. `classes`: word class -> its phrases; `members`: word -> the classes it belongs to by itself."""

    def __init__(self, classes: Mapping[str, tuple[str, ...]]) -> None:
        self.root: dict[str, object] = {}
        self.members: dict[str, tuple[str, ...]] = {}
        self.longer: dict[str, list[list[str]]] = {}
        self.entries: dict[str, Entry] = {}
        for name, words in classes.items():
            self._add_class(name, words)
        self.solid = frozenset(word for name in _SOLID for word in self.class_of(name))
        self.own = self.class_of("own")
        self.owned = {word: _owned(keys) for word, keys in self.members.items()}
        self._starts: dict[str, tuple[dict[str, object], ...]] = {}

    def _add_class(self, name: str, words: Iterable[str]) -> None:
        key = "{" + name + "}"
        self.longer.setdefault(key, [])
        for word in words:
            parts = [part for part in tokens(normalise(word).text) if part not in FILLERS]
            if len(parts) == 1:
                self.members[parts[0]] = (*self.members.get(parts[0], ()), key)
            elif parts:
                self.longer[key].append(parts)

    def class_of(self, name: str) -> frozenset[str]:
        """The single words of a class."""
        key = "{" + name + "}"
        return frozenset(word for word, keys in self.members.items() if key in keys)

    def add(self, phrase: str, effect: Effect | None = None) -> None:
        """Compile one phrase. Raises PhraseError."""
        entry = self.entries.get(phrase)
        if entry is None:
            entry = self.entries[phrase] = Entry(phrase, [], phrase.startswith("^"))
            for path in self._paths(phrase):
                self._insert(path, entry)
        if effect is not None and effect not in entry.effects:
            entry.effects.append(effect)

    def _paths(self, phrase: str) -> Iterator[list[str]]:
        parts = [piece for part in phrase.removeprefix("^").split() for piece in ([part] if "|" in part else _PIECES.findall(part))]
        choices = [list(self._choices(part)) for part in parts]
        for chosen in itertools.product(*choices):
            path = [token for tokens_ in chosen for token in tokens_]
            if not path or path[0] == GAP or path[-1] == GAP:
                raise PhraseError(f"phrase {phrase!r} has nothing to hold on to at one end")
            yield path

    def _choices(self, part: str) -> Iterator[list[str]]:
        """The token sequences one part of a phrase stands for."""
        if part in (GAP, NUMBER):
            yield [part]
            return
        for word in part.split("|"):
            if word.startswith("{"):
                if word not in self.longer:
                    raise PhraseError(f"no word class {word} is declared")
                yield [word]
                yield from self.longer[word]
            else:
                yield [token for token in tokens(normalise(word).text) if token not in BREAKS and token not in FILLERS]

    def _insert(self, path: list[str], entry: Entry) -> None:
        node = self.root
        for token in path:
            node = node.setdefault(token, {})  # type: ignore[assignment]
        found: list[Entry] = node.setdefault(_END, [])  # type: ignore[assignment]
        if entry not in found:
            found.append(entry)

    def starts(self, word: str) -> tuple[dict[str, object], ...]:
        """The nodes a phrase may begin at with this word."""
        known = self._starts.get(word)
        if known is None:
            keys = (word, *self.members.get(word, ()), *((NUMBER,) if word[0] in "0123456789" else ()))
            known = tuple(self.root[key] for key in keys if key in self.root)  # type: ignore[misc]
            if len(self._starts) < 60_000:
                self._starts[word] = known
        return known

    def find(self, sentence: Sentence) -> list[Match]:
        """Every phrase of the sentence, overlapping ones too, in order of their first token."""
        words = sentence.words
        kept = [at for at, word in enumerate(words) if word not in FILLERS]
        sequence = [words[at] for at in kept]
        found: list[Match] = []
        starts, known, size = self.starts, self._starts, len(sequence)
        for begin, word in enumerate(sequence):
            nodes = known.get(word)
            if nodes is None:
                nodes = starts(word)
            if nodes:
                if kept[begin] and word in self.members and words[kept[begin] - 1] in self.own:
                    nodes = tuple(self.root[key] for key in (word, *self.owned[word]) if key in self.root)  # type: ignore[misc]
                following = sequence[begin + 1] if begin + 1 < size else ","
                open_ended = following in self.members or following[0] in _DIGITS
                for node in nodes:
                    if open_ended or following in node or _END in node or GAP in node:
                        self._follow(node, begin, sequence, kept, words, found)
        return found

    def _follow(
        self, node: dict[str, object], begin: int, sequence: list[str], kept: list[int], words: list[str], found: list[Match]
    ) -> None:
        """Walk the trie from one token; every end reached is a match."""
        first, size = kept[begin], len(sequence)
        stack = [(node, begin + 1, 1 << first, first if sequence[begin][0] in _DIGITS else -1, first)]
        members, own, solid = self.members, self.own, self.solid
        while stack:
            node, at, mask, number, last = stack.pop()
            entries = node.get(_END)
            if entries is not None:
                found += [Match(entry, first, last, mask, number) for entry in entries]  # type: ignore[attr-defined]
                if len(node) == 1:
                    continue
            if at >= size:
                continue
            gap = node.get(GAP)
            if gap is not None:
                for skipped in range(at, min(size, at + GAP_WORDS + 1)):
                    word = sequence[skipped]
                    if word in gap or word in members or word[0] in _DIGITS:  # type: ignore[operator]
                        stack.append((gap, skipped, mask, number, last))  # type: ignore[arg-type]
                    if word in BREAKS or word in solid:
                        break
            word, place = sequence[at], kept[at]
            if place - last > 1 and words[place - 1] in ARTICLES and not _glued(words[place - 2], word):
                continue
            following = node.get(word)
            if following is not None:
                stack.append((following, at + 1, mask | 1 << place, number, place))  # type: ignore[arg-type]
            if word in members:
                for key in members[word] if words[place - 1] not in own else self.owned[word]:
                    following = node.get(key)
                    if following is not None:
                        stack.append((following, at + 1, mask | 1 << place, number, place))  # type: ignore[arg-type]
            if word[0] in _DIGITS:
                following = node.get(NUMBER)
                if following is not None:
                    stack.append((following, at + 1, mask | 1 << place, place, place))  # type: ignore[arg-type]


def _owned(keys: tuple[str, ...]) -> tuple[str, ...]:
    """The classes of a word behind `our` or `ego`: our car is no other vehicle, it is us."""
    others = tuple(key for key in keys if key not in ("{vehicle}", "{person}"))
    return (*others, "{us}") if len(others) < len(keys) and "{us}" not in others else others


def _glued(before: str, word: str) -> bool:
    """Whether an article between these words leaves them one phrase: `in the crosswalk`, `blocking the lane`; not `cross the street`."""
    return before in GLUE or word in GLUE or before.endswith(("ing", "ed"))


def compile_lexicon(vocabulary: Vocabulary) -> Lexicon:
    """All phrases of the vocabulary, and its swallowing ones. Raises PhraseError."""
    lexicon = Lexicon(vocabulary.words)
    for fact in vocabulary:
        for word, phrases in fact.phrases.items():
            for phrase in phrases:
                lexicon.add(phrase, Effect(fact.name, _value(fact, word)))
    for phrase in vocabulary.words.get(SWALLOW, ()):
        lexicon.add(phrase)
    return lexicon


def _value(fact: Fact, word: str) -> Value | None:
    if fact.kind == "boolean":
        return word != "false"
    if fact.kind == "enumeration":
        return word
    return frozenset((word,)) if fact.kind == "set" else None
