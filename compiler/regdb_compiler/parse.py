"""Tree -> documents: the schema gives every scalar its type; every wrong field is reported at once, with its place."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Place
from regdb_compiler.source import Mapping, Node, Scalar, Sequence, SourceFile

PARSE_RULES = (
    ("R013", "unknown-key", "A key the schema does not know, or that belongs somewhere else; nothing is ignored silently."),
    ("R014", "wrong-value", "A value the field cannot have; the message says what would be right."),
    ("R015", "missing-key", "A field that must be there is not."),
    ("R016", "bad-date", "A date that is none; dates are written 2026-03-02."),
)

D = TypeVar("D", bound=BaseModel)
Path = tuple[str | int, ...]


def to_data(node: Node) -> Any:
    """A tree without its places: text, lists and dictionaries. A plain empty or `null` scalar is None."""
    if isinstance(node, Scalar):
        return None if node.plain and node.text in ("", "null", "~") else node.text
    if isinstance(node, Sequence):
        return [to_data(item) for item in node.items]
    return {key.text: to_data(value) for key, value in node.entries}


def node_at(root: Node, path: Path) -> Node:
    """The node a path of keys and positions leads to, as far as it leads."""
    node = root
    for step in path:
        if isinstance(node, Mapping) and isinstance(step, str) and (found := node.get(step)) is not None:
            node = found
        elif isinstance(node, Sequence) and isinstance(step, int) and step < len(node.items):
            node = node.items[step]
        else:
            break
    return node


def place_at(root: Node, path: Path) -> Place:
    """The place of the value a path leads to."""
    return node_at(root, path).place


def parse_document(model: type[D], file: SourceFile) -> tuple[D | None, list[Diagnostic]]:
    """The file's tree as a document of `model`, or None with every reason why not."""
    if file.root is None:
        return None, []
    try:
        return model.model_validate(to_data(file.root)), []
    except ValidationError as error:
        return None, list(_diagnose(model, file.root, error))


def _diagnose(model: type[BaseModel], root: Node, error: ValidationError) -> Iterator[Diagnostic]:
    seen: set[tuple[Place, str]] = set()
    items = error.errors(include_url=False)
    for item in items:
        path = _yaml_path(root, item["loc"])
        if _is_consequence(item, path, items):
            continue
        found = _one(model, root, path, item)
        if (found.place, found.code) not in seen:
            seen.add((found.place, found.code))
            yield found


def _is_consequence(item: Any, path: Path, items: list[Any]) -> bool:
    """A list found too short only because its items are wrong, or a key missing only because it is misspelled."""
    loc = item["loc"]
    if item["type"] == "too_short":
        return any(len(other["loc"]) > len(loc) and other["loc"][: len(loc)] == loc for other in items)
    if item["type"] != "missing":
        return False
    beside = [str(other["loc"][-1]) for other in items if other["type"] == "extra_forbidden" and other["loc"][:-1] == loc[:-1]]
    return any(difflib.get_close_matches(key, [str(path[-1])], 1, 0.7) for key in beside)


def _yaml_path(root: Node, loc: tuple[str | int, ...]) -> Path:
    """pydantic's location without the steps that exist only in types (union branches, aliases)."""
    path: list[str | int] = []
    node: Node | None = root
    for position, step in enumerate(loc):
        if isinstance(node, Mapping) and isinstance(step, str):
            found = node.get(step)
            if found is None and position < len(loc) - 1:
                continue
            node = found
        elif isinstance(node, Sequence) and isinstance(step, int):
            node = node.items[step] if step < len(node.items) else None
        elif not isinstance(step, str) or node is not None:
            continue
        path.append(step)
    return tuple(path)


def _one(model: type[BaseModel], root: Node, path: Path, item: Any) -> Diagnostic:
    kind, message = item["type"], _plain(item)
    if kind == "extra_forbidden":
        return _unknown_key(model, root, path)
    if kind == "missing":
        inside = node_at(root, path[:-1])
        named = _named(path[:-1])
        return Diagnostic("R015", "missing-key", "error", f"`{path[-1]}` is missing{named}", _head(inside), note=f"needs `{path[-1]}`")
    node = node_at(root, path)
    code, name = ("R016", "bad-date") if "is no date" in message else ("R014", "wrong-value")
    return Diagnostic(code, name, "error", f"`{_spell(path)}`: {message}", _head(node))


def _plain(item: Any) -> str:
    """pydantic's message in the words of somebody who writes YAML."""
    kind, context = item["type"], item.get("ctx", {})
    if kind == "value_error":
        return str(context["error"])
    if kind == "literal_error":
        options = context["expected"].replace(" or ", ", ").replace("'", "").split(", ")
        near = difflib.get_close_matches(str(item["input"]), options, 1)
        return f"{item['input']!r} is none of {', '.join(options)}" + (f"; did you mean {near[0]}?" if near else "")
    wants = {"string_type": "text", "dict_type": "keys with values", "model_type": "keys with values", "tuple_type": "a list",
             "list_type": "a list", "model_attributes_type": "keys with values"}  # fmt: skip
    if kind in wants:
        got = "nothing" if item["input"] is None else "a list" if isinstance(item["input"], list) else (
            "keys with values" if isinstance(item["input"], dict) else "text")  # fmt: skip
        return f"expected {wants[kind]}, found {got}"
    if kind in {"less_than_equal", "greater_than_equal"}:
        return f"at most {context['le']}" if "le" in context else f"at least {context['ge']}"
    if kind == "string_pattern_mismatch":
        return f"{item['input']!r} does not have the form {context['pattern']}"
    return str(item["msg"][:1].lower() + item["msg"][1:])


def _unknown_key(model: type[BaseModel], root: Node, path: Path) -> Diagnostic:
    key = str(path[-1])
    inside = node_at(root, path[:-1])
    place = inside.key_place(key) if isinstance(inside, Mapping) else inside.place
    here = _fields(_model_at(model, path[:-1]))
    near = difflib.get_close_matches(key, here, 1, 0.7)
    present = set(inside) if isinstance(inside, Mapping) else set()
    if near and near[0] not in present:
        fix = Fix("safe", f"write `{near[0]}`", (Edit(place, near[0]),))
        return _key_error(f"unknown key `{key}`{_named(path[:-1])}", place, f"did you mean `{near[0]}`?", fix)
    for depth in range(len(path) - 2, -1, -1):
        if key in _fields(_model_at(model, path[:depth])) and not isinstance(path[depth], int):
            return _key_error(f"`{key}` does not belong in `{path[-2]}`", place, f"it belongs one level up{_named(path[:depth])}")
    for name in here:
        if key in _fields(_model_at(model, (*path[:-1], name))):
            return _key_error(f"`{key}` does not belong here", place, f"it belongs inside `{name}`")
    return _key_error(f"unknown key `{key}`{_named(path[:-1])}", place, "known: " + ", ".join(here))


def _key_error(message: str, place: Place, note: str, fix: Fix | None = None) -> Diagnostic:
    return Diagnostic("R013", "unknown-key", "error", message, place, note=note, fix=fix)


def _named(path: Path) -> str:
    """` in regulation` for a path that leads into `regulations: [...]`; empty at the top."""
    words = [str(step) for step in path if isinstance(step, str)]
    if not words:
        return ""
    return f" in {words[-1].rstrip('s') if path and isinstance(path[-1], int) else words[-1]}"


def _spell(path: Path) -> str:
    return ".".join(str(step) for step in path if isinstance(step, str)) or "the file"


def _head(node: Node) -> Place:
    """A node's place, of one with several lines only the first."""
    place = node.place
    if place.end_line == place.line:
        return place
    if isinstance(node, Mapping) and node.entries:
        return node.entries[0][0].place
    return Place(place.path, place.line, place.column, place.line, place.column + 1)


def _fields(model: Any) -> list[str]:
    if isinstance(model, type) and issubclass(model, BaseModel):
        return [field.alias or name for name, field in model.model_fields.items()]
    return []


def _model_at(model: Any, path: Path) -> Any:
    """The model that validates what stands at a path, or None."""
    for step in path:
        if isinstance(step, int):
            continue
        if not (isinstance(model, type) and issubclass(model, BaseModel)):
            continue
        field = next((f for name, f in model.model_fields.items() if (f.alias or name) == step), None)
        model = inner_model(field.annotation) if field is not None else None
    return model


def inner_model(annotation: Any) -> Any:
    """The document model inside an annotation (of a list, a dictionary, an optional), or None."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((found for part in get_args(annotation) if (found := inner_model(part)) is not None), None)


