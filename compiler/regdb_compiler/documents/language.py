"""The documents of the language: vocabulary, jurisdictions, states."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from regdb_compiler.documents.scalars import Boolean, Document, Words


class Assumed(Document):
    """What stands in for an unknown fact, within which sensing range, and why."""

    assume: Any
    within: str = ""
    because: str


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


class Attribute(Document):
    """An attribute as declared in the vocabulary."""

    kind: Literal["limit", "scope"]
    quantity: str = ""
    fact: str = ""
    direction: Literal["", "max", "min"] = ""
    meaning: str


class VocabularyFile(Document):
    """A file of the vocabulary."""

    facts: dict[str, Fact] = Field(default_factory=dict)
    attributes: dict[str, Attribute] = Field(default_factory=dict)


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
