"""A question as people write it: a file or options with scene, plan, place and day, as plain dictionaries of text."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from regdb.vocabulary import Vocabulary
from regdb_runtime.errors import MissingExtra, RequestError

_KEYS = ("scene", "plan", "in", "on")


@dataclass
class Question:
    """What is asked, unread: words of the vocabulary with what was written for them. Empty place or day: not said."""

    scene: dict[str, object] = field(default_factory=dict)
    plan: dict[str, object] = field(default_factory=dict)
    place: str = ""
    day: str = ""


def read_question(path: Path) -> Question:
    """Read a YAML or JSON file. Raises RequestError when it cannot be read or is none, MissingExtra for YAML without PyYAML."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RequestError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from error
    data = _load(text, path)
    if not isinstance(data, Mapping):
        raise RequestError(f"{path} is no scene; write `scene:` and `plan:` with facts below them")
    strange = [str(key) for key in data if key not in _KEYS]
    if strange:
        raise RequestError(f"{path} has {', '.join(map(repr, strange))}; a scene file has: {', '.join(_KEYS)}")
    parts = {name: data.get(name) or {} for name in ("scene", "plan")}
    for name, part in parts.items():
        if not isinstance(part, Mapping):
            raise RequestError(f"{path}: `{name}` is no list of facts with values")
    return Question(dict(parts["scene"]), dict(parts["plan"]), str(data.get("in") or ""), str(data.get("on") or ""))


def _load(text: str, path: Path) -> Any:
    """JSON by the standard library; anything else as YAML whose scalars stay text."""
    try:
        return json.loads(text)
    except ValueError as error:
        if path.suffix == ".json":
            raise RequestError(f"{path} is no JSON: {error}") from error
    try:
        import yaml
    except ModuleNotFoundError:
        raise MissingExtra("PyYAML", "compiler", f"reading {path} as YAML (JSON works without)") from None
    try:
        return yaml.load(text, Loader=yaml.BaseLoader)  # every scalar stays text, so 7:00 and no survive
    except yaml.YAMLError as error:
        raise RequestError(f"{path} is no YAML: {' '.join(str(error).split())}") from error


def add_facts(question: Question, facts: Iterable[str], vocabulary: Vocabulary) -> list[str]:
    """Put `name=value` options into scene or plan, where the vocabulary says they belong. The problems come back."""
    problems = []
    for text in facts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name:
            problems.append(f"{text!r} is no fact with a value; write it as name=value")
        elif _is_planned(name, vocabulary):
            question.plan[name] = value
        else:
            question.scene[name] = value
    return problems


def _is_planned(name: str, vocabulary: Vocabulary) -> bool:
    declared = vocabulary.facts.get(name) or vocabulary.facts.get(f"plan.{name}")
    return declared is not None and declared.source == "plan"
