"""A rule's example put into a small codes folder that is clean otherwise, so that a page can be executed.

An example is a YAML mapping. Its keys go where they belong: `section`, `title`, `location`, `topic` and `source` to the section,
`text`, `delegates`, `definitions` and `regulations` to its version, the rest to its regulation. `regulations` lists several,
`versions` several versions; `facts` are declared besides, `cases` stand in the cases folder, `outline` lists the state's
sections, `local` is a regulation of the city, `path` is the file's path and `file` its whole text, `append` is put at the
file's end as it stands. null takes a field away.
`texts` are attached as official text: section -> its words, or [the words that were accepted, the words attached since].
`interpretations` are profiles by name, whose other fields are filled in.
"""

from __future__ import annotations

import copy
import datetime
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from regdb_compiler.diagnostics import Diagnostic
from regdb_compiler.driver import Build, build
from regdb_compiler.lint.rule import Rule
from regdb_compiler.official.passage import Passage
from regdb_compiler.official.reading import SourceText
from regdb_compiler.official.shelf import Shelf, accept, attach, write_shelf

WORLD = Path(__file__).parent / "example_world"
SECTION_KEYS = ("section", "title", "location", "topic", "source")
VERSION_KEYS = ("text", "note", "enacted_by", "omitted", "definitions", "delegates")
OWN_KEYS = ("regulations", "versions", "facts", "cases", "outline", "local", "path", "file", "append", "texts", "interpretations")
Example = Mapping[str, Any]


def read_example(text: str) -> Example:
    """An example from its YAML; every scalar stays text, as authors' files are read. Raises ValueError if it is no mapping."""
    data = _typed(yaml.load(text, Loader=yaml.BaseLoader))  # BaseLoader makes nothing but text
    if not isinstance(data, dict):
        raise ValueError("an example is a mapping of fields")
    return data


def write_example(example: Example, folder: Path) -> Path:
    """Write the small codes folder with the example in it under `folder`; returns the example's file."""
    codes = folder / "codes"
    shutil.copytree(WORLD, codes, dirs_exist_ok=True)
    if "facts" in example:
        _dump(codes / "vocabulary" / "more.yaml", {"facts": example["facts"]})
    for name, fields in example.get("interpretations", {}).items():
        blank = {"interpretation": name, "title": "A profile", "source": {"checked": "2026-01-02", "confidence": "recalled"}}
        _dump(codes / "interpretations" / f"{name}.yaml", {**blank, **fields})
    if "texts" in example:
        _attach(folder / "texts", example["texts"])
    if "cases" in example:
        _dump(codes / "st" / "cases" / "example.yaml", {"cases": example["cases"]})
    if "outline" in example:
        _dump(codes / "st" / "outline.yaml", {"listing": "seen", "outline": example["outline"]})
    if "local" in example:
        _dump(codes / "ci" / "80.yaml", _section({**example["local"], "section": "80", "topic": "city-speed"}, {"authority": "ST 40"}))
    path: Path = codes / example.get("path", f"st/{example.get('section', '100')}.yaml")
    path.parent.mkdir(parents=True, exist_ok=True)
    if "file" in example:
        path.write_text(example["file"], "utf-8", newline="")
    else:
        _dump(path, _section(example, {}))
    if "append" in example:
        path.write_text(path.read_text("utf-8") + example["append"], "utf-8", newline="")
    return path


def _attach(folder: Path, texts: Mapping[str, Any]) -> None:
    shelf, day = Shelf(folder), datetime.date(2026, 1, 2)
    for turn in range(2):
        told = {name: [words] if isinstance(words, str) else words for name, words in texts.items()}
        passages = tuple(Passage(name, "", words[turn]) for name, words in told.items() if turn < len(words))
        shelf = attach(shelf, "st", SourceText("https://example.org", "plain", "", passages), day)
        for name, words in told.items() if turn == 0 else ():
            shelf = accept(shelf, "st", name, day) if len(words) > 1 else shelf
    write_shelf(shelf)


def build_example(example: Example, folder: Path) -> Build:
    """The small codes folder with the example in it, read and resolved."""
    write_example(example, folder)
    return build(folder / "codes", added=())


def find_in_example(rule: Rule, text: str, folder: Path) -> list[Diagnostic]:
    """What a rule finds in one example of its page."""
    return list(rule.check(build_example(read_example(text), folder)))


def _section(example: Example, extra: Mapping[str, Any]) -> dict[str, Any]:
    """The clean section with the example's fields in it."""
    section = yaml.load((WORLD / "_clean.yaml").read_text("utf-8"), Loader=yaml.BaseLoader)
    clean = section["versions"][0]
    for key in SECTION_KEYS:
        if key in example:
            _put(section, key, example[key])
    if "versions" in example:
        section["versions"] = [_version(clean, item, extra) for item in example["versions"]]
    else:
        section["versions"] = [_version(clean, {key: value for key, value in example.items() if key not in SECTION_KEYS}, extra)]
    return dict(section)


def _version(clean: Mapping[str, Any], example: Example, extra: Mapping[str, Any]) -> dict[str, Any]:
    version = copy.deepcopy(dict(clean))
    regulation = {**version["regulations"][0], **extra}
    for key in VERSION_KEYS:
        if key in example:
            _put(version, key, example[key])
    rest = {key: value for key, value in example.items() if key not in (*VERSION_KEYS, *OWN_KEYS)}
    whole = "regulations" in example or not rest.keys() - {"effective", "until"}
    for key in ("effective", "until") if whole else ():
        if key in rest:
            _put(version, key, rest.pop(key))
    version["regulations"] = [_laid(regulation, item) for item in example.get("regulations", [rest])]
    return version


def _laid(regulation: Mapping[str, Any], fields: Mapping[str, Any]) -> dict[str, Any]:
    found = copy.deepcopy(dict(regulation))
    for key, value in fields.items():
        _put(found, key, {**found["condition"], **value} if key == "condition" else value)
    for key in [key for key, value in found["condition"].items() if value is None]:
        del found["condition"][key]
    return found


def _put(target: dict[str, Any], key: str, value: Any) -> None:
    if key == "source" and isinstance(value, dict):
        value = {name: told for name, told in {**target.get(key, {}), **value}.items() if told is not None}
    if value is None:
        target.pop(key, None)
    else:
        target[key] = value


def _typed(data: Any) -> Any:
    """`null` is the one word of an example that is not text."""
    if isinstance(data, dict):
        return {key: _typed(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_typed(item) for item in data]
    return None if data == "null" else data


def _dump(path: Path, data: Mapping[str, Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    text = yaml.dump(_quoted(data), Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=10_000)
    path.write_text(text, "utf-8")


class _Text(str):
    """Text that is written in quotes, as section numbers are."""

    __slots__ = ()


class _Dumper(yaml.SafeDumper):
    """Writes scalars plain where they can be, since the reader takes all of them as text."""

    def ignore_aliases(self, data: Any) -> bool:  # noqa: ARG002
        return True


def _plain(dumper: yaml.SafeDumper, data: str) -> yaml.ScalarNode:
    if "\n" in data:
        return dumper.represent_scalar("tag:yaml.org,2002:str", data, style="|")
    return yaml.ScalarNode("tag:yaml.org,2002:str", data, style='"' if isinstance(data, _Text) else None)


def _quoted(data: Mapping[str, Any]) -> dict[str, Any]:
    return {key: _Text(value) if key == "section" else value for key, value in data.items()}


_Dumper.add_representer(str, _plain)
_Dumper.add_representer(_Text, _plain)
