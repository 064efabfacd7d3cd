"""`regdb schema`: valid JSON Schema that takes what the compiler takes, refuses what it refuses, and completes."""

import json
import re
from pathlib import Path
from typing import Any, ClassVar

import jsonschema
import pytest
import yaml
from pydantic import BaseModel
from regdb_compiler import documents
from regdb_compiler.commands.schema import NAMES
from regdb_compiler.driver import Build
from regdb_compiler.emit.field_meanings import MEANINGS
from regdb_compiler.emit.to_json_schema import MODELS, json_schema

from regdb.cli import main


def _schema(small: Build, name: str) -> dict[str, Any]:
    corpus = small.corpus
    return json_schema(name, corpus.vocabulary, corpus.machine, corpus.tree)


class _Core(yaml.CSafeLoader):
    """YAML 1.2's core schema: `on`, `no` and dates are text, as an editor's schema check sees them."""

    yaml_implicit_resolvers: ClassVar[dict[str, Any]] = {}


for _tag, _form, _first in (
    ("null", r"~|null|", ["~", "n", ""]), ("bool", r"true|false", ["t", "f"]), ("int", r"[-+]?[0-9]+", list("-+0123456789")),
    ("float", r"[-+]?[0-9]+\.[0-9]+", list("-+0123456789")),
):  # fmt: skip
    _Core.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", re.compile(rf"(?:{_form})$"), _first)


def _as_editors_read(text: str) -> Any:
    return yaml.load(text, _Core)


def _validator(small: Build, name: str) -> jsonschema.Draft202012Validator:
    schema = _schema(small, name)
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def _kind(path: Path) -> str:
    if path.parent.name in {"vocabulary", "cases", "interpretations"}:
        return path.parent.name.removesuffix("s") if path.parent.name == "interpretations" else path.parent.name
    return path.stem if path.stem in NAMES else "section"


def test_every_file_that_compiles_is_valid(small: Build, small_codes: Path) -> None:
    paths = list(small_codes.rglob("*.yaml"))
    assert {_kind(path) for path in paths} == {"section", "vocabulary", "states", "jurisdictions", "interpretation"}
    for path in paths:
        _validator(small, _kind(path)).validate(_as_editors_read(path.read_text("utf-8")))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("legality: false", "legality: maybe"), ("exception_to: [a]", "exceptionto: [a]"), ("force: prima_facie", "force: strong"),
        ("next: [follow]", "next: [folow]"), ("max_speed: posted", "max_sped: posted"), ("posted.speed: 30 mph", "posted.sped: 30 mph"),
        ("verdict: unknown", "verdict: never"), ("effective: 1959-09-18\n", "since: 1959-09-18\n"), ("title: Posted speed\n", ""),
        ("direction: stricter", "direction: lower"), ("confidence: seen", "confidence: sure"),
    ],
)  # fmt: skip
def test_what_the_compiler_refuses_an_editor_marks(small: Build, small_codes: Path, old: str, new: str) -> None:
    text = (small_codes / "cvc" / "22350.yaml").read_text("utf-8")
    assert old in text
    assert not _validator(small, "section").is_valid(_as_editors_read(text.replace(old, new)))


def test_short_forms_are_taken(small: Build, small_codes: Path) -> None:
    data = _as_editors_read((small_codes / "cvc" / "22350.yaml").read_text("utf-8"))
    rule = data["versions"][0]["regulations"][0]
    rule["vagueness"], rule["applies_to"], data["location"] = 3, "bus", "Division 11"
    rule["tests"][0]["expect"] = "legal"
    _validator(small, "section").validate(data)
    rule["vagueness"] = 6
    assert not _validator(small, "section").is_valid(data)


def test_names_of_the_codes_are_offered_with_their_meaning(small: Build) -> None:
    definitions = _schema(small, "section")["$defs"]
    scene = definitions["LawTest"]["properties"]["scene"]["properties"]
    assert scene["weather.kind"] == {"enum": ["none", "rain", "fog", "unknown"], "description": "The weather."}
    assert "overtaking" in definitions["States"]["properties"]["next"]["anyOf"][0]["enum"]
    fields = definitions["Regulation"]["properties"]
    assert fields["attributes"]["properties"]["road_type"]["enum"] == ["highway", "freeway", "alley"]
    assert fields["requires_sign"]["enum"] == ["emergency.siren", "sign.school"]
    assert fields["applies_to"]["anyOf"][0]["enum"] == ["passenger", "bus", "motortruck"]
    assert "los_angeles" in definitions["LawTest"]["properties"]["in"]["enum"]
    assert definitions["LawTest"]["properties"]["plan"]["properties"]["speed"]["examples"] == ["25 mph"]


def test_every_field_is_described_and_no_description_is_left_over() -> None:
    declared = {**vars(documents), **vars(documents.interpretation)}
    models = {name: item for name, item in declared.items() if isinstance(item, type) and issubclass(item, BaseModel)}
    del models["Document"]
    assert set(MEANINGS) == set(models)
    for name, model in models.items():
        assert set(MEANINGS[name]) == {field.alias or key for key, field in model.model_fields.items()}, name


@pytest.mark.parametrize("name", NAMES)
def test_identifiers_carry_the_version(small: Build, name: str) -> None:
    assert _schema(small, name)["$id"] == f"urn:regdb:file:{name}:1.0"
    assert name in MODELS


def test_the_command_lists_prints_and_writes(small_codes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def run(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as caught:
            main(["schema", *arguments, "--codes", str(small_codes)])
        return int(caught.value.code or 0), *capsys.readouterr()

    assert run() == (0, "section\ncases\nvocabulary\nstates\njurisdictions\noutline\ninterpretation\n", "")
    code, out, _ = run("section")
    assert (code, json.loads(out)["title"]) == (0, "A section of a code")
    code, listed, _ = run("--write", str(tmp_path / "schema"))
    assert code == 0
    assert listed.split() == [str(tmp_path / "schema" / f"{name}.json") for name in NAMES]
    assert (tmp_path / "schema" / "section.json").read_text("utf-8") == out
    code, _, err = run("sections")
    assert code == 2
    assert "there is no schema 'sections'" in err


def test_the_shipped_codes_are_valid(codes: Path) -> None:
    from regdb_compiler.read_corpus import read_corpus

    corpus = read_corpus(codes)
    validators = {
        name: jsonschema.Draft202012Validator(json_schema(name, corpus.vocabulary, corpus.machine, corpus.tree)) for name in NAMES
    }
    wrong = {item.place.path for item in corpus.diagnostics}
    checked = 0
    for name, file in corpus.files.items():
        if name not in wrong:
            validators[_kind(Path(name))].validate(_as_editors_read(file.text))
            checked += 1
    assert checked > 50
