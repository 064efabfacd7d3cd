"""Document models -> JSON Schema for editors: every field described, the vocabulary's facts, states and attributes as choices."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from regdb.jurisdiction import JurisdictionTree
from regdb.states import StateMachine
from regdb.vocabulary import Fact, Vocabulary
from regdb_compiler import documents
from regdb_compiler.documents.interpretation import InterpretationFile
from regdb_compiler.emit.field_meanings import MEANINGS

VERSION = "1.0"
"""Version of the file format, part of every `$id`. A major change makes files invalid that were valid."""

MODELS: Mapping[str, type[BaseModel]] = {
    "section": documents.Section,
    "cases": documents.Cases,
    "vocabulary": documents.VocabularyFile,
    "states": documents.StatesFile,
    "jurisdictions": documents.JurisdictionsFile,
    "outline": documents.Outline,
    "interpretation": InterpretationFile,
}
"""Schema name -> the document it describes."""

_TITLES = {
    "section": "A section of a code", "cases": "Cases of the law", "vocabulary": "A file of the vocabulary",
    "states": "The state machine", "jurisdictions": "The tree of jurisdictions",
    "outline": "The outline of a code", "interpretation": "An interpretation",
}  # fmt: skip
_SHORT_FORMS: Mapping[str, JsonSchemaValue] = {
    "listed": {"type": "string", "description": "One item may stand without a list."},
    "_vagueness": {"type": "integer", "minimum": 0, "maximum": 5},
    "_aged": {"type": "string", "description": "The class alone."},
    "_headed": {"type": "string", "description": "The heading alone."},
    "_decided": {"type": "string", "description": "The formula alone, or unknown."},
    "_valued": {"type": "string", "description": "The number alone."},
    "_expectation": {"enum": ["legal", "illegal", "unknown"]},
}
"""Validators of `documents` that also take a short form, and what that form looks like."""


class _Generator(GenerateJsonSchema):
    """pydantic's schema with the short forms that its validators accept."""

    def function_before_schema(self, schema: core_schema.BeforeValidatorFunctionSchema) -> JsonSchemaValue:
        """The inner type; or, where the validator takes a short form, either of the two."""
        inner = self.generate_inner(schema["schema"])
        short = _SHORT_FORMS.get(getattr(schema["function"]["function"], "__name__", ""))
        return inner if short is None else {"anyOf": [inner, short]}


def json_schema(name: str, vocabulary: Vocabulary, machine: StateMachine, tree: JurisdictionTree) -> dict[str, Any]:
    """The schema of one kind of file (a key of `MODELS`), completed with the names that the codes declare."""
    schema = MODELS[name].model_json_schema(by_alias=True, schema_generator=_Generator, mode="validation")
    definitions = schema.get("$defs", {})
    for model, owner in [(MODELS[name].__name__, schema), *definitions.items()]:
        owner.pop("title", None)
        _describe(owner, MEANINGS[model])
    for test in ("LawTest", "Case"):
        if test in definitions:
            _complete_test(definitions[test]["properties"], vocabulary, machine, tree)
    if "Regulation" in definitions:
        _complete_regulation(definitions, vocabulary, machine)
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": f"urn:regdb:file:{name}:{VERSION}", "title": _TITLES[name]}
    return {**head, **schema}


def _describe(owner: dict[str, Any], meanings: Mapping[str, str]) -> None:
    """Give every field its meaning, in place of the title that pydantic makes of its name."""
    for name, field in owner.get("properties", {}).items():
        field.pop("title", None)
        field["description"] = meanings[name]


def _complete_test(fields: dict[str, Any], vocabulary: Vocabulary, machine: StateMachine, tree: JurisdictionTree) -> None:
    scene = {fact.name: fact_schema(fact) for fact in _sorted(vocabulary)}
    base = {
        "like": {"enum": ["quiet"], "description": "Start from the uneventful scene."},
        "silent": {"description": "Facts or sources that report nothing at present."},
    }
    _choices(fields, "scene", {"type": "object", "properties": {**base, **scene}, "additionalProperties": False})
    plan = {fact.name: fact_schema(fact) for fact in _sorted(vocabulary)}
    plan |= {fact.name.removeprefix("plan."): fact_schema(fact) for fact in _sorted(vocabulary) if fact.name.startswith("plan.")}
    states = _one_or_more(sorted(machine.names))
    _choices(fields, "plan", {"type": "object", "properties": {"current": states, "next": states, **plan}, "additionalProperties": False})
    _choices(fields, "in", {"enum": sorted({*(item.id for item in tree), *(item.code for item in tree if item.code)})})


def _complete_regulation(definitions: dict[str, Any], vocabulary: Vocabulary, machine: StateMachine) -> None:
    fields = definitions["Regulation"]["properties"]
    _choices(fields, "attributes", {"type": "object", "properties": _attributes(vocabulary), "additionalProperties": False})
    signs = [fact.name for fact in _sorted(vocabulary) if fact.kind == "boolean"]
    _choices(fields, "requires_sign", {"enum": signs})
    classes = vocabulary.facts.get("ego.vehicle_class")
    if classes is not None:
        _choices(fields, "applies_to", _one_or_more(list(classes.values)))
    names = sorted(machine.names)
    for role in ("current", "next"):
        _choices(definitions["States"]["properties"], role, _one_or_more(names))


def _choices(fields: dict[str, Any], name: str, choices: dict[str, Any]) -> None:
    """Put what the codes declare in place of what the model alone knows; the meaning stays."""
    fields[name] = {**choices, "description": fields[name]["description"]}


def _attributes(vocabulary: Vocabulary) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, item in sorted(vocabulary.attributes.items()):
        fact = vocabulary.facts.get(item.fact)
        if item.kind == "scope" and fact is not None and fact.values:
            found[name] = {"enum": list(fact.values), "description": item.meaning}
        else:
            example = {"examples": [f"25 {fact.unit}"]} if fact is not None and fact.unit else {}
            found[name] = {"type": ["string", "number", "boolean"], "description": item.meaning, **example}
    return found


def _one_or_more(words: list[str]) -> dict[str, Any]:
    one = {"enum": words}
    return {"anyOf": [one, {"type": "array", "items": one}]}


def _sorted(vocabulary: Vocabulary) -> Iterable[Fact]:
    return (vocabulary.facts[name] for name in sorted(vocabulary.facts))


def fact_schema(fact: Fact) -> dict[str, Any]:
    """What a scene may say of a fact, as an editor sees it: its values or an example, and its meaning."""
    if fact.kind == "boolean":
        return {"enum": [True, False, "unknown"], "description": fact.meaning}
    if fact.kind == "enumeration":
        return {"enum": [*fact.values, "unknown"], "description": fact.meaning}
    if fact.kind == "set":
        listed = {"type": "array", "items": {"enum": list(fact.values)}}
        return {"anyOf": [listed, {"enum": [*fact.values, "unknown"]}], "description": fact.meaning}
    examples = {"quantity": f"25 {fact.unit}", "time": "07:30", "date": "2026-03-02", "count": "2"}
    return {"type": ["string", "number"], "examples": [examples[fact.kind]], "description": fact.meaning}
