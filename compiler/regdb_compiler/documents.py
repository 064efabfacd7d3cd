"""The fields authors may write: section, vocabulary, jurisdiction, state and case documents as pydantic models.

Every scalar arrives as text and gets its type here. Places are not kept in the models: `parse` maps a field's path to its node.
"""

from __future__ import annotations

import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints, model_validator


def _boolean(value: Any) -> Any:
    if isinstance(value, str):
        if value in ("true", "false"):
            return value == "true"
        raise ValueError(f"write true or false, not {value!r}")
    return value


def _date(value: Any) -> Any:
    if isinstance(value, str):
        try:
            if len(value) != 10:
                raise ValueError
            return datetime.date.fromisoformat(value)
        except ValueError:
            raise ValueError(f"{value!r} is no date; write it as 2026-03-02") from None
    return value


def _integer(value: Any) -> Any:
    if isinstance(value, str):
        if value.isascii() and value.isdigit():
            return int(value)
        raise ValueError(f"write a whole number, not {value!r}")
    return value


def _listed(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


def _vagueness(value: Any) -> Any:
    return {"score": value} if isinstance(value, str) else value


def _expectation(value: Any) -> Any:
    return {"verdict": value} if isinstance(value, str) else value


def _headed(value: Any) -> Any:
    return {"heading": value} if isinstance(value, str) else value


Boolean = Annotated[bool, BeforeValidator(_boolean)]
Date = Annotated[datetime.date, BeforeValidator(_date)]
Integer = Annotated[int, BeforeValidator(_integer)]
Words = Annotated[tuple[str, ...], BeforeValidator(_listed)]
Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9]+(?:[-_][a-z0-9]+)*$")]
Subdivision = Annotated[str, StringConstraints(pattern=r"^(?:\([A-Za-z0-9]+\))*$")]
Force = Literal["absolute", "prima_facie", "basic", "penalty_tier", "advisory"]
Raw = dict[str, Any]
"""Keys and values the vocabulary gives their types later: scenes, plans, attributes."""


class Document(BaseModel):
    """Every document refuses unknown keys and never changes."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Source(Document):
    """Where the text was read, the second place it was compared with, when, and how sure we are."""

    url: str = ""
    also: Words = ()
    checked: Date
    confidence: Literal["verified", "seen", "recalled"]
    note: str = ""


class Definition(Document):
    """A named condition, for this jurisdiction and below."""

    name: Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]*$")]
    when: str
    quote: str = ""


class Bounds(Document):
    """How far a delegation reaches, in the attribute's unit."""

    min: str = ""
    max: str = ""


class Delegation(Document):
    """What a section lets local authorities change: direction, bounds, sign, and on whose roads not."""

    id: str = ""
    to: Words
    attribute: str = ""
    direction: Literal["stricter", "looser", "either"] = "either"
    bounds: Bounds = Bounds()
    values: Words = ()
    of: Words = ()
    sign: Boolean = False
    not_on: Words = ()
    condition: str = ""


class Condition(Document):
    """The condition in words, and in the condition language."""

    text: str
    when: str = ""
    unless: str = ""


class States(Document):
    """The transitions a regulation speaks of; nothing means every state."""

    current: Words = ()
    next: Words = ()


class Vagueness(Document):
    """0 (a number or plain fact) to 5 (a bare appeal to judgement); above 0 with its reason."""

    score: Annotated[Integer, Field(ge=0, le=5)]
    because: str = ""


class Expectation(Document):
    """What a test of the law expects; only what is written is compared, lists as sets."""

    verdict: Literal["legal", "illegal", "unknown"] | None = None
    deciding: Words | None = None
    limits: dict[str, str] | None = None
    unknown: Words | None = None
    assumed: Words | None = None


class LawTest(Document):
    """A scene and a plan, and what the law says of them."""

    name: str
    scene: Raw = Field(default_factory=dict)
    plan: Raw = Field(default_factory=dict)
    expect: Annotated[Expectation, BeforeValidator(_expectation)]
    on: Date | None = None
    in_: str = Field(default="", alias="in")


class Regulation(Document):
    """One regulation as annotated."""

    id: Slug
    subdivision: Subdivision | None = None
    exception_to: Words = ()
    overrides: Words = ()
    authority: str = ""
    condition: Condition
    result: str
    legality: Boolean
    attributes: dict[str, str] = Field(default_factory=dict)
    states: States = States()
    requires_sign: str = ""
    applies_to: Words = ()
    force: Force | None = None
    tags: tuple[Slug, ...] = ()
    topic: Slug | None = None
    effective: Date | None = None
    until: Date | None = None
    quote: str = ""
    vagueness: Annotated[Vagueness, BeforeValidator(_vagueness)] = Vagueness(score=0)
    tests: tuple[LawTest, ...] = ()


class Omitted(Document):
    """Subdivisions of a version that no regulation carries, and why; nothing means the section as a whole.

    `not_for_ads` binds no vehicle under way, `not_expressible` cannot be said in the condition language, `elsewhere` is carried
    by something else (a fact's meaning, a delegation, another regulation)."""

    subdivision: Annotated[tuple[Subdivision, ...], BeforeValidator(_listed)] = ()
    status: Literal["not_for_ads", "not_expressible", "elsewhere"]
    why: Annotated[str, StringConstraints(min_length=1)]


class Version(Document):
    """A section's text from `effective` (inclusive) to `until` (exclusive)."""

    effective: Date
    until: Date | None = None
    enacted_by: str = ""
    text: str
    note: str = ""
    omitted: tuple[Omitted, ...] = ()
    definitions: tuple[Definition, ...] = ()
    delegates: tuple[Delegation, ...] = ()
    regulations: tuple[Regulation, ...] = ()


class Section(Document):
    """One section with all its dated versions, oldest first."""

    section: Annotated[str, StringConstraints(pattern=r"^\d[0-9.\-]*$")]
    title: str
    location: Words
    topic: Slug
    source: Source
    versions: Annotated[tuple[Version, ...], Field(min_length=1)]


class Case(LawTest):
    """A scene that involves several sections; all the law in force takes part."""

    cites: Words


class Cases(Document):
    """A file of cases."""

    cases: tuple[Case, ...]


class Account(Document):
    """How the sections of a group stand in the ledger, and why."""

    status: Literal["partial", "not_for_ads", "not_expressible"]
    why: Annotated[str, StringConstraints(min_length=1)]


class OutlineSection(Document):
    """A section as listed: its heading and, unless its file says how it stands, its status and why."""

    heading: Annotated[str, StringConstraints(min_length=1)]
    status: Literal["partial", "not_for_ads", "not_expressible"] | None = None
    why: str = ""

    @model_validator(mode="after")
    def _with_reason(self) -> OutlineSection:
        if (self.status is None) != (not self.why):
            raise ValueError("a status needs its `why`, and a `why` its status")
        return self


Sections = dict[str, Annotated[OutlineSection, BeforeValidator(_headed)]]
"""Section number, or words for sections that are not listed one by one (22650 to 22711, rest of Division F) -> section."""


class OutlineArticle(Document):
    """An article with its sections; `all` is for those of them that have neither a file nor a status of their own."""

    article: str
    all: Account | None = None
    sections: Sections


class OutlineChapter(Document):
    """A chapter with its articles, its sections, or both."""

    chapter: str
    all: Account | None = None
    sections: Sections = Field(default_factory=dict)
    articles: tuple[OutlineArticle, ...] = ()


class Outline(Document):
    """Every section of the chapters of a code that matter, with its heading; `listing` says how sure the list itself is."""

    listing: Literal["verified", "seen", "recalled"]
    source: str = ""
    note: str = ""
    outline: tuple[OutlineChapter, ...]


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
