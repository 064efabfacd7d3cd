"""The protocol every vision-language client keeps: a frame and a prompt in, a text out, before a deadline or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, runtime_checkable

from regdb_runtime.observation import Provenance

Failure = Literal["", "deadline", "connection", "status", "malformed", "too_large", "cancelled"]

Box = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels of a frame; the origin is the upper left corner."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One camera image. `captured`: seconds since the run began. `image`: encoded bytes of `media_type`; `id` names it in evidence and records."""

    id: str
    captured: float
    image: bytes
    media_type: str = "image/jpeg"
    width: int = 0
    height: int = 0


@dataclass(frozen=True)
class Prompt:
    """What is asked: text, the JSON Schema an answer should keep (None: free text), turns of earlier ticks, and whether a crop is asked about.

    `history`: (question, answer) of earlier ticks, oldest first. `crop`: the part of the frame that is shown, (left, top, right, bottom) in
    pixels of the frame as captured; None shows all of it. `max_tokens`: how long an answer may become.
    """

    text: str
    schema: Mapping[str, Any] | None = None
    history: tuple[tuple[str, str], ...] = ()
    name: str = ""
    max_tokens: int = 128
    crop: Box | None = None


@dataclass(frozen=True, slots=True)
class Description:
    """An answer or a failure; never both empty. `took`: wall-clock seconds of the call. `cut`: the answer ran into its greatest length, so that
    its last sentence is not whole."""

    text: str
    failure: Failure = ""
    detail: str = ""
    took: float = 0.0
    model: str = ""
    usage: Mapping[str, int] = field(default_factory=dict)
    cut: bool = False


class Describer(Protocol):
    """A client. It never raises and never outlasts the deadline: a failure is an answer too."""

    @property
    def provenance(self) -> Provenance: ...

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """Ask; `deadline` in wall-clock seconds from now bounds the whole call, every phase of it."""
        ...


@runtime_checkable
class Closing(Protocol):
    """A client that holds something: `close` ends a call in flight (its answer is then the failure `cancelled`) and lets go of it."""

    def close(self) -> None: ...
