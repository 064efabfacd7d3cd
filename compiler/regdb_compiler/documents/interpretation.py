"""The fields of an interpretation's file: its source, its parameters, and how it decides each fact."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StringConstraints

from regdb_compiler.documents.scalars import Document
from regdb_compiler.documents.section import Source


def _decided(value: Any) -> Any:
    return {"formula": value} if isinstance(value, str) else value


def _valued(value: Any) -> Any:
    return {"value": value} if isinstance(value, str) else value


class ParameterDocument(Document):
    """A number with its unit, what it stands for, where it is published."""

    value: str
    meaning: str = ""
    source: str = ""


class DecisionDocument(Document):
    """How a fact is decided: by a formula, or never (`unknown`); parameters here go before those of the profile."""

    formula: str
    true_when: Literal["unsafe", "safe"] = "unsafe"
    parameters: dict[str, str] = Field(default_factory=dict)
    because: str = ""
    source: str = ""


class InterpretationFile(Document):
    """One profile; its name is its file's."""

    interpretation: Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]*$")]
    title: str
    meaning: str = ""
    source: Source
    parameters: dict[str, Annotated[ParameterDocument, BeforeValidator(_valued)]] = Field(default_factory=dict)
    facts: dict[str, Annotated[DecisionDocument, BeforeValidator(_decided)]]
