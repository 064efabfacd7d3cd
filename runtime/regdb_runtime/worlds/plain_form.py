"""Frozen dataclasses to JSON's plain values and back, checked by their annotations; defaults are left out."""

from __future__ import annotations

import dataclasses
import types
import typing
from collections.abc import Mapping
from functools import cache
from typing import Any, TypeVar, cast

from regdb_runtime.errors import WorldError

T = TypeVar("T")


def to_plain(value: object) -> Any:
    """Dicts, lists, numbers, texts; fields at their default are left out."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {item.name: to_plain(getattr(value, item.name)) for item in dataclasses.fields(value) if not _is_default(value, item)}
    if isinstance(value, Mapping):
        return {str(key): to_plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [to_plain(item) for item in value]
    return value


def from_plain(kind: type[T], value: object, place: str) -> T:
    """The dataclass again. Raises WorldError that names the place."""
    return cast(T, _read(kind, value, place))


def _is_default(holder: object, item: dataclasses.Field[Any]) -> bool:
    if item.default is not dataclasses.MISSING:
        return bool(getattr(holder, item.name) == item.default)
    return item.default_factory is not dataclasses.MISSING and getattr(holder, item.name) == item.default_factory()


def _read(kind: Any, value: object, place: str) -> object:
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if dataclasses.is_dataclass(kind):
        return _read_dataclass(cast(type, kind), value, place)
    if origin in (types.UnionType, typing.Union):
        return None if value is None else _read(next(item for item in arguments if item is not types.NoneType), value, place)
    if origin is tuple:
        return _read_tuple(arguments, value, place)
    if origin is typing.Literal:
        if value not in arguments:
            raise WorldError(f"{place} cannot be {value!r}; it is one of: {', '.join(map(str, arguments))}")
        return value
    if kind is float and isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if isinstance(kind, type) and not isinstance(value, kind):
        raise WorldError(f"{place} is {value!r}, not a {kind.__name__}")
    if origin is not None and not isinstance(value, Mapping):
        raise WorldError(f"{place} is {value!r}, not a mapping")
    return value


def _read_tuple(arguments: tuple[Any, ...], value: object, place: str) -> tuple[object, ...]:
    if not isinstance(value, (list, tuple)):
        raise WorldError(f"{place} is {value!r}, not a list")
    if len(arguments) == 2 and arguments[1] is Ellipsis:
        return tuple(_read(arguments[0], item, f"{place}[{index}]") for index, item in enumerate(value))
    if len(value) != len(arguments):
        raise WorldError(f"{place} has {len(value)} items, not {len(arguments)}")
    return tuple(_read(kind, item, f"{place}[{index}]") for index, (kind, item) in enumerate(zip(arguments, value, strict=True)))


def _read_dataclass(kind: type, value: object, place: str) -> object:
    if not isinstance(value, Mapping):
        raise WorldError(f"{place} is {value!r}, not a mapping")
    hints = _hints(kind)
    strange = [name for name in value if name not in hints]
    if strange:
        raise WorldError(f"{place} has no field {strange[0]!r}; its fields are: {', '.join(hints)}")
    try:
        return kind(**{name: _read(hints[name], item, f"{place}.{name}") for name, item in value.items()})
    except TypeError as error:
        raise WorldError(f"{place}: {error}") from None


@cache
def _hints(kind: type) -> dict[str, Any]:
    return typing.get_type_hints(kind)
