"""The canonical form of a law file: keys in the schema's order, one indentation, tidy conditions; comments and meaning kept."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel
from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.error import YAMLError
from ruamel.yaml.resolver import VersionedResolver

from regdb_compiler import documents
from regdb_compiler.documents.interpretation import InterpretationFile
from regdb_compiler.parse import inner_model, to_data
from regdb_compiler.parse_condition import read_raw
from regdb_compiler.source import parse_text
from regdb_compiler.spell_condition import spell
from regdb_compiler.type_condition import Problem

CONDITION_KEYS = frozenset({"when", "unless"})
WIDE = 4096
"""Lines are never rewrapped: where a sentence of law breaks is its author's."""


@dataclass(frozen=True, slots=True)
class Formatted:
    """A file's canonical text; `problem` says why it was left as it is."""

    text: str
    problem: str = ""


class _TextOnly(VersionedResolver):
    """No scalar has a type: what was written plain is written plain again."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)

    @property
    def versioned_resolver(self) -> dict[str, list[Any]]:
        return {}


def format_text(text: str, model: type[BaseModel]) -> Formatted:
    """The canonical text of a file of one kind. A file that cannot be read, or would change, is returned as it is."""
    before = parse_text(text, "file")
    if before.root is None or before.diagnostics:
        first = before.diagnostics[0] if before.diagnostics else None
        return Formatted(text, f"line {first.place.line}: {first.message}" if first else "it cannot be read")
    try:
        written = _rewrite(text, model)
        again = _rewrite(written, model)
    except YAMLError as error:
        return Formatted(text, f"it cannot be rewritten: {str(error).splitlines()[0]}")
    after = parse_text(written, "file")
    if after.root is None or _meaning(to_data(after.root)) != _meaning(to_data(before.root)):
        return Formatted(text, "rewriting it would change its meaning")
    if _comments(written) != _comments(text):
        return Formatted(text, "rewriting it would lose or double a comment")
    if again != written:
        return Formatted(text, "its form does not settle")
    return Formatted(written)


def _yaml() -> YAML:
    yaml = YAML(typ="rt")
    yaml.Resolver = _TextOnly
    yaml.preserve_quotes = True
    yaml.width = WIDE
    yaml.indent(mapping=2, sequence=4, offset=2)
    yaml.allow_unicode = True
    return yaml


def _rewrite(text: str, model: type[BaseModel]) -> str:
    yaml = _yaml()
    tree = yaml.load(text)
    _order(tree, model)
    _tidy(tree)
    out = io.StringIO()
    yaml.dump(tree, out)
    lines = [line.rstrip() for line in out.getvalue().split("\n")]
    return "\n".join(lines).rstrip("\n") + "\n"


def _order(node: Any, model: Any) -> None:
    """Put keys into the order in which the schema names them; a mapping with comments between its keys stays as it is."""
    if isinstance(node, CommentedSeq):
        for item in node:
            _order(item, model)
    elif isinstance(node, CommentedMap):
        fields = _fields(model)
        for key, value in node.items():
            _order(value, inner_model(fields[key].annotation) if key in fields else model if not fields else None)
        wanted = [key for key in _names(model) if key in node] + [key for key in node if key not in fields]
        if wanted != list(node) and not _commented(node):
            for key in wanted:
                node.move_to_end(key)


def _fields(model: Any) -> Mapping[str, Any]:
    if isinstance(model, type) and issubclass(model, BaseModel):
        return {field.alias or name: field for name, field in model.model_fields.items()}
    return {}


def _names(model: Any) -> Iterable[str]:
    return _fields(model)


def _commented(node: CommentedMap) -> bool:
    """Whether a comment stands between the keys; blank lines do not count."""
    held: list[Any] = [node.ca.comment, *node.ca.items.values()]
    while held:
        part = held.pop()
        if isinstance(part, list):
            held += part
        elif part is not None and "#" in part.value:
            return True
    return False


def _tidy(node: Any) -> None:
    """Conditions in their canonical spacing; the author's words and their order stay."""
    if isinstance(node, CommentedSeq):
        for item in node:
            _tidy(item)
    elif isinstance(node, CommentedMap):
        for key, value in node.items():
            if key in CONDITION_KEYS and isinstance(value, str):
                _tidy_condition(node, key, value)
            else:
                _tidy(value)


def _tidy_condition(node: CommentedMap, key: str, value: str) -> None:
    raw = read_raw(str(value))
    if isinstance(raw, Problem) or "\n" in value.rstrip("\n"):
        return
    text = spell(raw)
    if text != value:
        node[key] = type(value)(text) if type(value) is not str else text


def _meaning(data: Any) -> Any:
    """Data without the order of keys and the spacing of conditions."""
    if isinstance(data, dict):
        return {key: _condition_meaning(value) if key in CONDITION_KEYS else _meaning(value) for key, value in data.items()}
    return [_meaning(item) for item in data] if isinstance(data, list) else data


def _condition_meaning(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    raw = read_raw(value)
    return value if isinstance(raw, Problem) else spell(raw)


_COMMENT = re.compile(r"(?:^|\s)(#.*)$", re.MULTILINE)


def _comments(text: str) -> list[str]:
    """Everything that looks like a comment, sorted: also what only looks like one must not get lost."""
    return sorted(match.strip() for match in _COMMENT.findall(text))


FORMS: tuple[tuple[Callable[[tuple[str, ...]], bool], type[BaseModel]], ...] = (
    (lambda parts: parts == ("jurisdictions.yaml",), documents.JurisdictionsFile),
    (lambda parts: parts == ("states.yaml",), documents.StatesFile),
    (lambda parts: len(parts) == 2 and parts[0] == "vocabulary", documents.VocabularyFile),
    (lambda parts: len(parts) == 2 and parts[0] == "interpretations", InterpretationFile),
    (lambda parts: len(parts) == 3 and parts[1] == "cases", documents.Cases),
    (lambda parts: len(parts) == 2 and parts[1] == "outline.yaml", documents.Outline),
    (lambda parts: len(parts) == 2, documents.Section),
)
"""Which kind of document stands where in a codes folder."""


def model_of(parts: tuple[str, ...]) -> type[BaseModel] | None:
    """The document model of a file by its path within the codes folder, None for what is no document of ours."""
    return next((model for fits, model in FORMS if fits(parts)), None)
