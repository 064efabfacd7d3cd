"""What every document is made of: scalars that get their type from the schema, and documents that refuse unknown keys."""

from __future__ import annotations

import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, StringConstraints


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


def listed(value: Any) -> Any:
    """One word stands for a list of it."""
    return [value] if isinstance(value, str) else value


Boolean = Annotated[bool, BeforeValidator(_boolean)]
Date = Annotated[datetime.date, BeforeValidator(_date)]
Integer = Annotated[int, BeforeValidator(_integer)]
Words = Annotated[tuple[str, ...], BeforeValidator(listed)]
Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9]+(?:[-_][a-z0-9]+)*$")]
Subdivision = Annotated[str, StringConstraints(pattern=r"^(?:\([A-Za-z0-9]+\))*$")]
Force = Literal["absolute", "prima_facie", "basic", "penalty_tier", "advisory"]
Raw = dict[str, Any]
"""Keys and values the vocabulary gives their types later: scenes, plans, attributes."""


class Document(BaseModel):
    """Every document refuses unknown keys and never changes."""

    model_config = ConfigDict(extra="forbid", frozen=True)
