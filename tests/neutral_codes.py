"""A neutral conformance case as a folder of codes: jurisdictions, vocabulary, states, sections and delegations, all in YAML."""

from __future__ import annotations

import shutil
import string
from decimal import Decimal
from functools import cached_property
from pathlib import Path
from typing import Any

import yaml
from neutral_facts import infer_facts

from regdb.front import shipped_codes

EARLIEST = "1900-01-01"
TODAY = "2026-06-01"
FIRST_AUTHORITY = 9001


class NeutralCodes:
    """One case with names that the file format accepts: rules are `r1`, `r2` ... in sections of their own, codes are `ca`, `cb` ..."""

    def __init__(self, case: dict[str, Any]) -> None:
        self.case = case
        self.rules: list[dict[str, Any]] = case.get("rules") or []
        self.ids = {name: f"r{number}" for number, name in enumerate(dict.fromkeys(str(rule["id"]) for rule in self.rules), start=1)}
        self.facts = infer_facts(case)

    @property
    def date(self) -> str:
        return str(self.case.get("date") or TODAY)

    @property
    def scene(self) -> dict[str, object]:
        return {name: spell(value) for name, value in (self.case.get("scene") or {}).items()}

    @property
    def plan(self) -> dict[str, object]:
        return {name: spell(value) for name, value in (self.case.get("plan") or {}).items()}

    @cached_property
    def tree(self) -> dict[str, dict[str, Any]]:
        """The jurisdictions as told; those that only rules or the place name stand alone, one where nobody names any."""
        told = {str(name): dict(item or {}) for name, item in (self.case.get("jurisdictions") or {}).items()}
        named = [*(rule.get("jurisdiction") for rule in self.rules), self.case.get("place")]
        for name in named:
            if name is not None:
                told.setdefault(str(name), {})
        return told or {"state": {}}

    @property
    def place(self) -> str:
        return self._jurisdiction_id(str(self.case.get("place") or next(iter(self.tree))))

    def _jurisdiction_id(self, name: str) -> str:
        return f"place_{letters(list(self.tree).index(name))}"

    def code(self, name: str) -> str:
        """The folder of a jurisdiction's sections; citations need letters."""
        return f"c{letters(list(self.tree).index(name))}"

    def owner(self, rule: dict[str, Any]) -> str:
        return str(rule.get("jurisdiction") or next(iter(self.tree)))

    def kind(self, name: str) -> str:
        item = self.tree[name]
        if item.get("status") == "model":
            return "model"
        parent = item.get("parent")
        return "state" if parent is None or self.tree[str(parent)].get("status") == "model" else "city"

    def full_id(self, name: str) -> str:
        """The id in the codes of the first rule with a neutral id; a name of no rule stays unknown there too."""
        rule = next((rule for rule in self.rules if str(rule["id"]) == name), None)
        return f"no-such-{slug(name)}" if rule is None else f"{self.code(self.owner(rule))}-{self._section(name)}-{self.ids[name]}"

    def name_of(self, full: str) -> str:
        """The neutral id of a rule of the database."""
        return next(name for name in self.ids if self.full_id(name) == full)

    def _section(self, name: str) -> str:
        return str(100 + list(self.ids).index(name))

    def write(self, folder: Path) -> Path:
        """Write the codes into a new folder; returns it."""
        (folder / "vocabulary").mkdir(parents=True)
        shutil.copy(shipped_codes() / "states.yaml", folder / "states.yaml")
        dump(folder / "jurisdictions.yaml", {"jurisdictions": {self._jurisdiction_id(name): self._jurisdiction(name) for name in self.tree}})
        dump(folder / "vocabulary" / "facts.yaml", {"facts": self._facts(), "attributes": self._attributes()})
        for name in self.tree:
            (folder / self.code(name)).mkdir()
        for name in self.ids:
            versions = [rule for rule in self.rules if str(rule["id"]) == name]
            self._write_section(folder / self.code(self.owner(versions[0])), self._section(name), [self._version(rule) for rule in versions])
        for number, authority in enumerate(self._authorities, start=FIRST_AUTHORITY):
            delegation = {"to": ["city"], "direction": "either"}
            version = {"effective": EARLIEST, "text": f"Local authorities may act ({authority}).", "delegates": [delegation]}
            self._write_section(folder / self.code(self._delegating), str(number), [version])
        return folder

    @cached_property
    def _authorities(self) -> list[str]:
        return list(dict.fromkeys(str(rule["authority"]) for rule in self.rules if rule.get("authority")))

    @property
    def _delegating(self) -> str:
        """The jurisdiction whose sections give authority: the first that is a state."""
        return next((name for name in self.tree if self.kind(name) == "state"), next(iter(self.tree)))

    def _jurisdiction(self, name: str) -> dict[str, Any]:
        item = self.tree[name]
        data = {"name": name, "kind": self.kind(name), "status": item.get("status", "law"), "code": self.code(name)}
        data["citation"] = {"short": self.code(name).upper()}
        return data | ({"parent": self._jurisdiction_id(str(item["parent"]))} if item.get("parent") else {})

    def _facts(self) -> dict[str, Any]:
        policy = self.case.get("policy") or {}
        found = {}
        for name, declared in self.facts.items():
            data: dict[str, Any] = {"type": declared.kind, "meaning": f"The neutral fact {name}.", "source": "perception"}
            data |= {"values": list(declared.words)} if declared.words else {}
            data |= {"unit": declared.unit} if declared.unit else {}
            if name in policy:
                data["unknown"] = {"assume": spell(policy[name]["assume"]), "because": "the case says so"}
            found[name] = data
        return found

    def _attributes(self) -> dict[str, Any]:
        names = dict.fromkeys(str(name) for rule in self.rules for name in rule.get("limits") or {})
        return {
            name: {"kind": "limit", "quantity": name.partition("_")[2], "direction": name.partition("_")[0], "meaning": f"The limit {name}."}
            for name in names
        }

    def _version(self, rule: dict[str, Any]) -> dict[str, Any]:
        version: dict[str, Any] = {"effective": str(rule.get("effective") or EARLIEST), "text": f"The neutral rule {rule['id']}."}
        version |= {"until": str(rule["until"])} if rule.get("until") else {}
        return version | {"regulations": [self._regulation(rule)]}

    def _regulation(self, rule: dict[str, Any]) -> dict[str, Any]:
        conditions = {key: str(rule[key]) for key in ("when", "unless") if rule.get(key) is not None}
        data: dict[str, Any] = {
            "id": self.ids[str(rule["id"])],
            "condition": {"text": f"The condition of {rule['id']}.", **{key: spell_condition(text) for key, text in conditions.items()}},
            "result": f"The result of {rule['id']}.",
            "legality": spell(bool(rule.get("legality", False))),
        }
        data |= {"attributes": {str(name): spell(value) for name, value in rule["limits"].items()}} if rule.get("limits") else {}
        data |= {key: rule[key] for key in ("states", "force") if rule.get(key)}
        for key in ("exception_to", "overrides"):
            data |= {key: [self._target(str(name)) for name in listed(rule[key])]} if rule.get(key) else {}
        data |= {"tags": [slug(str(tag)) for tag in listed(rule["tags"])]} if rule.get("tags") else {}
        if rule.get("authority"):
            number = FIRST_AUTHORITY + self._authorities.index(str(rule["authority"]))
            data["authority"] = f"{self.code(self._delegating).upper()} {number}"
        return data

    def _target(self, name: str) -> str:
        group, _, word = name.partition(":")
        return f"tag:{slug(word)}" if group == "tag" and word else self.full_id(name)

    def _write_section(self, folder: Path, number: str, versions: list[dict[str, Any]]) -> None:
        versions = sorted(versions, key=lambda version: version["effective"])
        source = {"checked": TODAY, "confidence": "recalled"}
        section = {"section": number, "title": f"Section {number}", "location": ["Neutral"], "topic": "neutral", "source": source}
        dump(folder / f"{number}.yaml", section | {"versions": versions})


def listed(value: Any) -> list[Any]:
    return list(value) if isinstance(value, (list, tuple)) else [value]


def slug(name: str) -> str:
    """A tag as the file format accepts it, different for different tags."""
    return "t" + "".join(char if char.isascii() and char.isalnum() and not char.isupper() else f"x{ord(char):x}" for char in name)


def letters(number: int) -> str:
    """a, b ... z, ba, bb ...: numbers where only letters may stand."""
    text = string.ascii_lowercase[number % 26]
    return letters(number // 26) + text if number >= 26 else text


def spell(value: object) -> object:
    """A value as an author writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, set, frozenset)):
        return [spell(item) for item in value]
    if isinstance(value, float):
        return format(Decimal(repr(value)), "f")  # the condition language has no exponents
    return str(value)


def spell_condition(text: str) -> str:
    """YAML reads `when: true` as a boolean; the condition language spells it in small letters."""
    return {"True": "true", "False": "false"}.get(text, text)


def dump(path: Path, data: dict[str, Any]) -> None:
    """Write a file of the codes; all scalars are text that YAML may quote."""
    path.write_text(yaml.safe_dump(data, sort_keys=False, allow_unicode=True), encoding="utf-8")
