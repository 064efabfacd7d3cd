"""`regdb drive`: what it writes, what it says, how it labels perception, and what it refuses."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from regdb_runtime.drive.log import read_log
from regdb_runtime.drive.variants import VARIANTS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "drive-log.md"


def regdb(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "regdb", "drive", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, timeout=300)


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shortest variant with a figure, driven and drawn."""
    folder = tmp_path_factory.mktemp("drive")
    told = regdb("paper", "--variant", "school", "-o", "here", "--format", "json", folder=folder)
    assert told.returncode == 0, told.stdout + told.stderr
    (folder / "told.json").write_text(told.stdout)
    return folder


def test_a_drive_leaves_log_scene_figure_pictures_and_table(driven: Path) -> None:
    pytest.importorskip("matplotlib")
    assert sorted(path.name for path in (driven / "here" / "school").iterdir()) == [
        "drive.jsonl", "scene-reduced-speed.png", "scene-zone-detected.png", "scene.json", "speed.png",
    ]  # fmt: skip
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in (driven / "here" / "school").glob("*.png"))
    assert "| school | scripted |" in (driven / "here" / "summary.md").read_text()


def test_its_json_says_what_happened(driven: Path) -> None:
    told = json.loads((driven / "told.json").read_text())
    assert told["schema"] == "regdb-drive-summary/1"
    (found,) = told["drives"]
    assert (found["variant"], found["provenance"], found["as_expected"]) == ("school", "scripted", True)
    assert [event["name"] for event in found["events"]] == ["zone_detected", "reduced_speed"]
    assert "CVC 22352(b)(2)" in found["sections"]


def test_every_key_of_the_log_is_on_its_page(driven: Path) -> None:
    log, page = read_log(driven / "here" / "school" / "drive.jsonl"), PAGE.read_text("utf-8")
    for heading, record in (("The run", log.run), ("A tick", log.ticks[0]), ("The end", log.end)):
        part = page.partition(f"## {heading}\n")[2].partition("\n## ")[0]
        assert re.findall(r"^\| `(\w+)` \|", part, re.MULTILINE) == list(record)


def test_a_log_is_driven_again_to_the_last_byte(driven: Path) -> None:
    told = regdb("replay", "here/school/drive.jsonl", folder=driven)
    assert told.returncode == 0, told.stdout + told.stderr
    assert "the same to the last byte" in told.stdout


def test_a_log_that_was_altered_is_told_where(driven: Path) -> None:
    lines = (driven / "here" / "school" / "drive.jsonl").read_text().splitlines()
    tick = json.loads(lines[100])
    tick["ego"]["speed"] += 1.0
    lines[100] = json.dumps(tick)
    (driven / "altered.jsonl").write_text("\n".join(lines) + "\n")
    told = regdb("replay", "altered.jsonl", folder=driven)
    assert told.returncode == 1
    assert f"tick 99 at {tick['time']:.1f} s differs in ego" in told.stdout


def test_a_scene_of_ones_own_is_driven(driven: Path) -> None:
    """The same scene without eyes, on a road cut short."""
    scene = json.loads((driven / "here" / "school" / "scene.json").read_text())
    scene["name"] = "mine"
    scene["eye"] = {"kind": "none"}
    scene["ego"]["station"] = 300.0
    (driven / "mine.json").write_text(json.dumps(scene))
    told = regdb("replay", "mine.json", "-o", "own", "--no-figures", folder=driven)
    assert told.returncode == 0, told.stdout + told.stderr
    assert "(perception: none)" in told.stdout
    assert read_log(driven / "own" / "mine" / "drive.jsonl").run["provenance"] == "none"


def test_a_recorded_eye_is_labelled_so_and_sees_what_was_recorded(tmp_path: Path) -> None:
    told = regdb("paper", "--variant", "school-no-sign", "--eye", "recorded", "--no-figures", "-o", ".", folder=tmp_path)
    assert told.returncode == 0, told.stdout + told.stderr
    assert "(perception: recorded)" in told.stdout
    log = read_log(tmp_path / "school-no-sign" / "drive.jsonl")
    assert log.run["provenance"] == "recorded"
    assert log.ticks[0]["facts"]["sign.school"] is False
    assert (tmp_path / "school-no-sign" / "eye.jsonl").is_file()


def test_the_list_names_every_variant(tmp_path: Path) -> None:
    told = regdb("list", folder=tmp_path)
    assert [line.split()[0] for line in told.stdout.splitlines() if not line.startswith(" ")] == [item.name for item in VARIANTS]
    assert max(map(len, told.stdout.splitlines())) <= 80
    data = json.loads(regdb("list", "--format", "json", folder=tmp_path).stdout)
    assert [item["variant"] for item in data] == [item.name for item in VARIANTS]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("papr",), "did you mean paper?"),
        (("paper", "--variant", "red-arow"), "did you mean red-arrow?"),
        (("paper", "--world", "carla", "--variant", "green"), "there are: built-in, sumo"),
        (("paper", "--profile", "cheap", "--variant", "green"), "there are: paper, default"),
        (("paper", "--eye", "glass"), "--eye is scripted, recorded"),
        (("paper", "file.json"), "takes no file"),
        (("replay",), "which scene or log?"),
        (("replay", "none.json"), "none.json cannot be read"),
        (("replay", "none.jsonl"), "none.jsonl cannot be read"),
        (("paper", "--format", "xml"), "--format is text or json"),
    ],
)
def test_what_cannot_be_driven_is_told(tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    told = regdb(*arguments, folder=tmp_path)
    assert told.returncode == 2
    assert message in " ".join(told.stderr.split())
    assert "Traceback" not in told.stderr


def test_a_scene_that_is_none_is_told(tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text('{"name": "x", "streets": {"roads": []}, "ego": {"lane": "a", "colour": "red"}}')
    told = regdb("replay", "scene.json", folder=tmp_path)
    assert told.returncode == 2
    assert "scene.ego has no field 'colour'" in " ".join(told.stderr.split())
    (tmp_path / "scene.json").write_text("{")
    told = regdb("replay", "scene.json", folder=tmp_path)
    assert told.returncode == 2
    assert "this is no JSON" in told.stderr
