"""The outline document: every section of a code's chapters, with what has become of it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StringConstraints, model_validator

from regdb_compiler.documents.scalars import Document


def _headed(value: Any) -> Any:
    return {"heading": value} if isinstance(value, str) else value


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
