"""The XML of a map file: opened once, and read element by element with errors that name the file and the element."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

from regdb_runtime.errors import MapError


class XmlNode:
    """One element with its place in the file; whatever is wrong with it becomes a MapError of one sentence."""

    __slots__ = ("element", "file", "where")

    def __init__(self, element: ET.Element, file: str, where: str) -> None:
        self.element, self.file, self.where = element, file, where

    @property
    def tag(self) -> str:
        return self.element.tag

    def fail(self, problem: str) -> MapError:
        """The error to raise for this element."""
        return MapError(f"{self.file}: {self.where} {problem}")

    def _child(self, element: ET.Element) -> XmlNode:
        identity = element.get("id")
        place = f"{element.tag} {identity}" if identity is not None else f"{element.tag} of {self.where}"
        return XmlNode(element, self.file, place)

    def __iter__(self) -> Iterator[XmlNode]:
        return (self._child(element) for element in self.element)

    def all(self, tag: str) -> list[XmlNode]:
        """Every child of this name, in the file's order."""
        return [self._child(element) for element in self.element.findall(tag)]

    def find(self, tag: str) -> XmlNode | None:
        """The first child of this name, None without."""
        element = self.element.find(tag)
        return None if element is None else self._child(element)

    def need(self, tag: str) -> XmlNode:
        """The first child of this name; MapError without."""
        found = self.find(tag)
        if found is None:
            raise self.fail(f"has no <{tag}>")
        return found

    def attribute(self, name: str) -> str:
        """An attribute that must be there."""
        value = self.element.get(name)
        if value is None:
            raise self.fail(f"has no attribute {name!r}")
        return value

    @property
    def text(self) -> str:
        return (self.element.text or "").strip()

    def number(self) -> float:
        """The element's text as a finite number."""
        return self._number(self.text, "holds ")

    def number_of(self, name: str, default: float | None = None) -> float:
        """An attribute as a finite number."""
        if default is not None and name not in self.element.attrib:
            return default
        return self._number(self.attribute(name), f"has {name}=")

    def _number(self, text: str, verb: str) -> float:
        try:
            value = float(text)
        except ValueError:
            raise self.fail(f"{verb}{text!r}, which is no number") from None
        if not math.isfinite(value):
            raise self.fail(f"{verb}{text!r}, which is no finite number")
        return value


def open_xml(path: str | Path, root: str) -> XmlNode:
    """The root element of a file, which must have the name `root`; MapError names what is wrong."""
    file = Path(path)
    try:
        element = ET.parse(file).getroot()
    except OSError as problem:
        raise MapError(f"{file}: cannot be read: {problem.strerror or problem}") from None
    except ET.ParseError as problem:
        raise MapError(f"{file}: is not well-formed XML: {problem}") from None
    if element.tag != root:
        raise MapError(f"{file}: the root element is <{element.tag}>, a file of this format begins with <{root}>")
    return XmlNode(element, str(file), f"<{root}>")
