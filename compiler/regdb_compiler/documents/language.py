"""The documents of the language: vocabulary, jurisdictions, states."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from regdb_compiler.documents.scalars import Boolean, Document, Integer, Words


class Assumed(Document):
    """What stands in for an unknown fact, within which sensing range, and why."""

    assume: Any
    within: str = ""
    because: str


def _aged(value: Any) -> Any:
    return {"ages": value} if isinstance(value, str) else value


class Plausible(Document):
    """Numbers that can be true: anything else was misread."""

    min: str = ""
    max: str = ""
    step: str = ""


class Fusion(Document):
    """How statements on a fact are believed and forgotten. What a fact leaves out its class says."""

    ages: str = ""
    holds: Words = ()
    fresh: Words = ()
    confirm: Integer | None = None
    within: str = ""
    apart: str = ""
    permissive: Words = ()
    corroborate: Words | None = None
    replaced: Boolean | None = None
    strictest: Words = ()
    plausible: Plausible | None = None
    asks: Words = ()
    question: str = ""
    ends: Words | None = None
    places: Words | None = None
    because: str = ""


class Age(Fusion):
    """A class of facts that age alike; `sources`: facts of these sources belong to it unless their file or they themselves say otherwise."""

    meaning: str
    sources: Words = ()


class Fact(Document):
    """A fact as declared in the vocabulary."""

    type: Literal["boolean", "enumeration", "set", "quantity", "count", "time", "date"]
    meaning: str
    source: Literal["ego", "map", "perception", "clock", "plan", "history"]
    values: Words = ()
    unit: str = ""
    unknown: Literal["strict"] | Assumed = "strict"
    quiet: Any = None
    phrases: Words | dict[str, Words] = ()
    confusables: Words = ()
    codes: dict[str, str] = Field(default_factory=dict)
    because: str = ""
    entails: Words = ()
    fusion: Annotated[Fusion, BeforeValidator(_aged)] = Fusion()


class Attribute(Document):
    """An attribute as declared in the vocabulary."""

    kind: Literal["limit", "scope"]
    quantity: str = ""
    fact: str = ""
    direction: Literal["", "max", "min"] = ""
    meaning: str


class VocabularyFile(Document):
    """A file of the vocabulary."""

    ages: dict[str, Age] = Field(default_factory=dict)
    fusion: str = ""
    facts: dict[str, Fact] = Field(default_factory=dict)
    attributes: dict[str, Attribute] = Field(default_factory=dict)
    words: dict[str, Words] = Field(default_factory=dict)


class CitationStyle(Document):
    """How a code is cited."""

    short: str
    long: str = ""


class Governs(Document):
    """Territory and road owners a jurisdiction's law reaches."""

    territory: Words = ()
    road_owners: Words = ()


class Jurisdiction(Document):
    """A jurisdiction as declared."""

    name: str
    kind: Literal["model", "state", "county", "city", "district"]
    status: Literal["law", "model"] = "law"
    parent: str | None = None
    code: str = ""
    citation: CitationStyle | None = None
    governs: Governs = Governs()
    source: str = ""


class JurisdictionsFile(Document):
    """The tree of jurisdictions."""

    jurisdictions: dict[str, Jurisdiction]


class State(Document):
    """A state of the machine; `next` are states of the same super-state."""

    meaning: str
    next: Words
    aliases: Words = ()
    prompt: str = ""
    extension: Boolean = False


class SuperState(Document):
    """A super-state with its states."""

    meaning: str
    prompt: str
    next: Words
    entry: str
    exit: str
    aliases: Words = ()
    from_anywhere: Boolean = False
    states: dict[str, State]


class StatesFile(Document):
    """The state machine."""

    initial: str
    super_states: dict[str, SuperState]
