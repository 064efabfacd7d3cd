"""What the servers that speak OpenAI's protocol differ in, as data: how each takes a schema, and what it calls the length of an answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

Structured = Literal["json_schema", "json_object", "none"]


@dataclass(frozen=True)
class ServerProfile:
    """One kind of server. `structured`: how it constrains an answer; `base_url`: where it listens unless told otherwise; `tokens`: its word for
    the greatest length of an answer; `further`: members every request carries."""

    name: str
    base_url: str
    structured: Structured = "json_schema"
    tokens: str = "max_tokens"
    further: Mapping[str, Any] = field(default_factory=dict)


PROFILES: Mapping[str, ServerProfile] = MappingProxyType({
    item.name: item for item in (
        ServerProfile("vllm", "http://localhost:8000/v1"),
        ServerProfile("ollama", "http://localhost:11434/v1"),
        ServerProfile("llama.cpp", "http://localhost:8080/v1", further={"cache_prompt": True}),
        ServerProfile("lm-studio", "http://localhost:1234/v1"),
        ServerProfile("openai", "https://api.openai.com/v1", tokens="max_completion_tokens"),
        ServerProfile("plain", "http://localhost:8000/v1", structured="none"),
    )
})  # fmt: skip
"""The servers known by name; `plain` is any other: prose is asked for, and the matcher reads it."""


def response_format(structured: Structured, schema: Mapping[str, Any] | None) -> dict[str, Any]:
    """The members of a request that constrain its answer; none where the server cannot, or nothing is asked for."""
    if schema is None or structured == "none":
        return {}
    if structured == "json_object":
        return {"response_format": {"type": "json_object"}}
    named = {"name": "driving_scene", "strict": False, "schema": dict(schema)}
    return {"response_format": {"type": "json_schema", "json_schema": named}}
