"""Folders and packages that add jurisdictions to the codes: merged, told apart, and refused where they contradict."""

import shutil
from pathlib import Path

import pytest
from regdb_compiler.cache import input_hash
from regdb_compiler.driver import build
from regdb_runtime.database import RegulationDatabase

from regdb.front import ADDED_CODES, CODES_GROUP, FrontError, added_codes, database

TOWN = """\
jurisdictions:
  santa_monica:
    name: City of Santa Monica
    kind: city
    parent: california
    code: smmc
    citation: {short: SMMC, long: Santa Monica Mun. Code §}
    governs: {territory: [incorporated], road_owners: [city]}
"""
FACTS = """\
facts:
  beach.bike_path: {type: boolean, source: map, meaning: The way is a bicycle path on the beach.}
"""
SECTION = """\
section: "3.12"
title: Beach path
location: [Article 3]
topic: beach-path
source: {checked: 2026-11-21, confidence: recalled}
versions:
  - effective: 2000-01-01
    text: |
      (a) No motor vehicle is driven on the beach path.
    regulations:
      - id: a
        condition: {text: On the beach path., when: beach.bike_path}
        result: must not drive there
        legality: false
        authority: CVC 22358
        quote: beach path
        vagueness: 0
"""


@pytest.fixture
def town(tmp_path: Path) -> Path:
    """A folder with a city, one fact and one section."""
    folder = tmp_path / "smmc_codes"
    for name, text in {"jurisdictions.yaml": TOWN, "vocabulary/beach.yaml": FACTS, "smmc/3.12.yaml": SECTION}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")
    return folder


def installed(site: Path, folder: Path, value: str) -> None:
    """What an installer leaves: the package and the metadata that names it."""
    shutil.copytree(folder, site / folder.name)
    (site / folder.name / "__init__.py").write_text("raise AssertionError('no code of a codes package is run')\n")
    info = site / "smmc_codes-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: smmc-codes\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{CODES_GROUP}]\nsanta_monica = {value}\n")


def test_a_folder_adds_jurisdiction_facts_and_sections(small_codes: Path, town: Path) -> None:
    found = build(small_codes, added=[town])
    assert [item.code for item in found.diagnostics if item.code != "R602"] == []
    assert [item.id for item in found.corpus.tree.path("santa_monica")][-2:] == ["california", "santa_monica"]
    assert "beach.bike_path" in found.corpus.vocabulary
    assert "smmc-3.12" in {section.id for section in found.corpus.sections}
    assert "smmc_codes/smmc/3.12.yaml" in found.corpus.files


def test_without_it_nothing_is_added(small_codes: Path) -> None:
    assert build(small_codes).corpus.added == ()
    assert "santa_monica" not in build(small_codes, added=[]).corpus.tree


def test_a_jurisdiction_declared_twice_is_an_error_with_both_places(small_codes: Path, town: Path) -> None:
    path = town / "jurisdictions.yaml"
    path.write_text(path.read_text().replace("santa_monica:", "california:"))
    (found,) = [item for item in build(small_codes, added=[town]).corpus.diagnostics if item.code == "R110"]
    assert found.place.path == "smmc_codes/jurisdictions.yaml"
    assert [place.path for place, _ in found.related] == ["small_codes/jurisdictions.yaml"]


def test_a_code_taken_is_an_error(small_codes: Path, town: Path) -> None:
    path = town / "jurisdictions.yaml"
    path.write_text(path.read_text().replace("code: smmc", "code: cvc"))
    codes = [item.code for item in build(small_codes, added=[town]).corpus.diagnostics]
    assert codes == ["R110", "R103"]


def test_a_parent_that_is_not_there_is_an_error(small_codes: Path, town: Path) -> None:
    path = town / "jurisdictions.yaml"
    path.write_text(path.read_text().replace("parent: california", "parent: nevada"))
    found = build(small_codes, added=[town]).corpus.diagnostics
    assert ("R110", "`nevada`" in found[0].message) == (found[0].code, True)


@pytest.mark.parametrize("kind", ["fact", "attribute"])
def test_a_word_declared_twice_is_an_error_with_both_places(small_codes: Path, town: Path, kind: str) -> None:
    corpus = build(small_codes, added=[]).corpus
    if kind == "fact":
        text = f"facts:\n  {next(iter(corpus.vocabulary.facts))}: {{type: boolean, source: map, meaning: Again.}}\n"
    else:
        text = f"attributes:\n  {next(iter(corpus.vocabulary.attributes))}: {{kind: limit, quantity: plan.speed, direction: max, meaning: Again.}}\n"
    (town / "vocabulary" / "again.yaml").write_text(text)
    (found,) = [item for item in build(small_codes, added=[town]).corpus.diagnostics if item.code == "R411"]
    assert found.message.startswith(kind)
    assert found.place.path == "smmc_codes/vocabulary/again.yaml"
    assert found.related[0][0].path.startswith("small_codes/vocabulary/")


def test_a_section_that_stands_in_the_codes_too_is_an_error_with_both_places(small_codes: Path, town: Path) -> None:
    (town / "cvc").mkdir()
    shutil.copy(small_codes / "cvc" / "22348.yaml", town / "cvc")
    (found,) = [item for item in build(small_codes, added=[town]).corpus.diagnostics if item.code == "R101"]
    assert {found.place.path, found.related[0][0].path} == {"smmc_codes/cvc/22348.yaml", "small_codes/cvc/22348.yaml"}


def test_the_state_machine_is_not_for_others_to_change(small_codes: Path, town: Path) -> None:
    shutil.copy(small_codes / "states.yaml", town)
    assert [item.code for item in build(small_codes, added=[town]).corpus.diagnostics] == ["R420"]


def test_two_folders_of_one_name_are_refused(small_codes: Path, town: Path, tmp_path: Path) -> None:
    other = Path(shutil.copytree(town, tmp_path / "elsewhere" / town.name))
    with pytest.raises(FrontError, match="same name"):
        build(small_codes, added=[town, other])


def test_an_installed_package_is_found_without_running_it(town: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site = tmp_path / "site"
    installed(site, town, "smmc_codes")
    monkeypatch.syspath_prepend(site)
    assert added_codes() == (site / "smmc_codes",)


@pytest.mark.parametrize("value", ["no_such_package", "no_such.package", "json.decoder"])
def test_an_entry_point_that_is_no_package_is_told(town: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    installed(tmp_path / "site", town, value)
    monkeypatch.syspath_prepend(tmp_path / "site")
    with pytest.raises(FrontError, match="santa_monica"):
        added_codes()


def test_the_environment_names_folders(
    small_codes: Path, town: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, own_cache: Path
) -> None:
    before = input_hash(small_codes)
    monkeypatch.setenv(ADDED_CODES, str(town))
    assert added_codes() == (town,)
    assert input_hash(small_codes) != before
    local = town / "smmc" / "3.12.yaml"
    local.write_text(local.read_text().replace("        authority: CVC 22358\n", ""))
    with pytest.raises(FrontError, match=r"smmc_codes/smmc/3\.12\.yaml"):
        database(small_codes)
    local.unlink()
    path = database(small_codes)
    assert path.parent == own_cache
    assert "santa_monica" in RegulationDatabase.open(path).tree
    monkeypatch.setenv(ADDED_CODES, str(tmp_path / "nowhere"))
    with pytest.raises(FrontError, match="nowhere, which is no folder"):
        added_codes()
