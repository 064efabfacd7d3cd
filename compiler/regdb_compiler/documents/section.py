"""The section document with its versions, regulations, delegations and tests; and the file of cases."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StringConstraints

from regdb_compiler.documents.scalars import Boolean, Date, Document, Force, Integer, Raw, Slug, Subdivision, Words, listed


def _vagueness(value: Any) -> Any:
    return {"score": value} if isinstance(value, str) else value


def _expectation(value: Any) -> Any:
    return {"verdict": value} if isinstance(value, str) else value


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

    subdivision: Annotated[tuple[Subdivision, ...], BeforeValidator(listed)] = ()
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
