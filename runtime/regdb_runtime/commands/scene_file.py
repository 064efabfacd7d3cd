"""A question as people write it: a file or options with scene, plan, place and day, as plain dictionaries of text."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from regdb.vocabulary import Vocabulary
from regdb_runtime.errors import MissingExtra, RequestError

_KEYS = ("scene", "plan", "in", "on")
_MAX_BYTES = 200_000
_MAX_DEPTH = 20


@dataclass
class Question:
    """What is asked, unread: words of the vocabulary with what was written for them. Empty place or day: not said."""

    scene: dict[str, object] = field(default_factory=dict)
    plan: dict[str, object] = field(default_factory=dict)
    place: str = ""
    day: str = ""


def read_question(path: Path) -> Question:
    """Read a YAML or JSON file. Raises RequestError when it cannot be read or is none, MissingExtra for YAML without PyYAML."""
    text = _text_of(path)
    data = _load(text, path)
    if not isinstance(data, Mapping):
        raise RequestError(f"{path} is no scene; write `scene:` and `plan:` with facts below them")
    strange = [str(key) for key in data if key not in _KEYS]
    if strange:
        shown = ", ".join(map(repr, strange[:3])) + (f" and {len(strange) - 3} more" if len(strange) > 3 else "")
        raise RequestError(f"{path} has {shown}; a scene file has: {', '.join(_KEYS)}")
    parts = {name: data.get(name) or {} for name in ("scene", "plan")}
    for name, part in parts.items():
        if not isinstance(part, Mapping):
            raise RequestError(f"{path}: `{name}` is no list of facts with values")
    return Question(dict(parts["scene"]), dict(parts["plan"]), str(data.get("in") or ""), str(data.get("on") or ""))


def _load(text: str, path: Path) -> Any:
    """JSON by the standard library; anything else as YAML whose scalars stay text."""
    try:
        return json.loads(text, object_pairs_hook=partial(_each_once, path))
    except RecursionError:
        raise RequestError(f"{path} is nested too deeply for a scene") from None
    except json.JSONDecodeError as error:
        if path.suffix == ".json":
            raise RequestError(f"{_at(path, error.lineno, error.colno)}: this is no JSON: {error.msg}") from error
    try:
        import yaml
    except ModuleNotFoundError:
        raise MissingExtra("PyYAML", "compiler", f"reading {path} as YAML (JSON works without)") from None
    try:
        _refuse_tricks(yaml.parse(text, Loader=yaml.BaseLoader), path)
        loader = yaml.BaseLoader(text)  # every scalar stays text, so 7:00 and no survive
        node = loader.get_single_node()
        _refuse_doubles(node, path)
        return loader.construct_document(node) if node is not None else None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = _at(path, mark.line + 1, mark.column + 1) if mark is not None else str(path)
        raise RequestError(f"{where}: this is no YAML: {error.problem or error.context}") from error
    except yaml.YAMLError as error:
        raise RequestError(f"{path} is no YAML: it holds a character that is no text") from error


def _text_of(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(_MAX_BYTES + 1)
    except OSError as error:
        raise RequestError(f"{path} cannot be read: {error.strerror}") from error
    if len(data) > _MAX_BYTES:
        raise RequestError(f"{path} is larger than {_MAX_BYTES // 1000} KB, which no scene is")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise RequestError(f"{path} is not UTF-8 text") from None


def _refuse_tricks(events: Iterable[Any], path: Path) -> None:
    """Aliases, which can stand for more than any memory holds, and nesting deeper than any scene. Raises RequestError."""
    depth = 0
    for event in events:
        kind = type(event).__name__
        depth += kind.endswith("StartEvent") - kind.endswith("EndEvent")
        if kind == "AliasEvent" or depth > _MAX_DEPTH:
            what = "aliases are not used in scenes" if kind == "AliasEvent" else "this is nested too deeply for a scene"
            raise RequestError(f"{_at(path, event.start_mark.line + 1, event.start_mark.column + 1)}: {what}")


def _each_once(path: Path, pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object whose keys are each written once. Raises RequestError."""
    found = dict(pairs)
    if len(found) != len(pairs):
        double = next(key for key, _ in pairs if [name for name, _ in pairs].count(key) > 1)
        raise RequestError(f"{path}: {double!r} is written twice")
    return found


def _refuse_doubles(node: Any, path: Path) -> None:
    """A key that is written twice in one mapping: one of the two would be lost silently. Raises RequestError."""
    pairs = node.value if getattr(node, "id", "") == "mapping" else []
    seen: set[str] = set()
    for key, value in pairs:
        if str(key.value) in seen:
            raise RequestError(f"{_at(path, key.start_mark.line + 1, key.start_mark.column + 1)}: {key.value!r} is written twice")
        seen.add(str(key.value))
        _refuse_doubles(value, path)


def _at(path: Path, line: int, column: int) -> str:
    return f"{path}:{line}:{column}"


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
