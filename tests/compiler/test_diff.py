"""diff: by field, with impact, between dates, jurisdictions, folders and databases."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from regdb_compiler.diff.compare import Change, compare, compare_by_topic, likeness
from regdb_compiler.diff.report import summary, to_json, to_text
from regdb_compiler.diff.sides import Item

Limits = dict[str, tuple[str, float]]


def item(name: str = "cvc-1-a", *, permission: bool = False, topic: str = "t", limits: Limits | None = None, **fields: str) -> Item:
    told = {"legality": "permitted" if permission else "forbidden", **fields}
    return Item(name, "CVC 1(a)", topic, "california", permission, told, limits or {})


FAST = item(max_speed="30 mph", limits={"max_speed": ("max", 13.4)})
SLOW = item(max_speed="25 mph", limits={"max_speed": ("max", 11.2)})
NARROW = item(min_clearance="3 ft", limits={"min_clearance": ("min", 0.9)})
WIDE = item(min_clearance="4 ft", limits={"min_clearance": ("min", 1.2)})


def test_equal_sides_have_no_difference() -> None:
    assert compare([item(when="a")], [item(when="a")]) == ()
    assert summary(()) == "no difference"


@pytest.mark.parametrize(
    ("old", "new", "impact"),
    [
        (FAST, SLOW, "TIGHTER"),
        (SLOW, FAST, "LOOSER"),
        (NARROW, WIDE, "TIGHTER"),
        (item(when="a"), item(when="b"), "DIFFERENT"),
        (item(result="x"), item(result="y"), "TEXT-ONLY"),
        (item(until="2030-01-01"), item(), "DATES-ONLY"),
    ],
)
def test_impact_of_a_changed_field(old: Item, new: Item, impact: str) -> None:
    (change,) = compare([old], [new])
    assert change.kind == "changed"
    assert change.impact == impact


@pytest.mark.parametrize(
    ("permission", "added", "impact"),
    [(False, True, "TIGHTER"), (False, False, "LOOSER"), (True, True, "LOOSER"), (True, False, "TIGHTER")],
)
def test_impact_of_what_comes_and_goes(permission: bool, added: bool, impact: str) -> None:
    one = item(permission=permission)
    (change,) = compare([] if added else [one], [one] if added else [])
    assert change.impact == impact


def test_versions_of_one_id_are_paired_by_their_first_day() -> None:
    old = [item(effective="2020-01-01", when="a"), item(effective="2023-01-01", when="b")]
    new = [item(effective="2023-01-01", when="c"), item(effective="2020-01-01", when="a")]
    (change,) = compare(old, new)
    assert change.fields == (("when", "b", "c"),)


def test_topics_align_codes_with_other_ids() -> None:
    ours = [item("uvc-11-1", when="signal.color == red", condition="steady red"), item("uvc-11-2", when="sign.stop", condition="stop sign")]
    theirs = [item("cvc-2", when="sign.stop and x.y", condition="stop sign"), item("cvc-1", when="signal.color == red", condition="steady red")]
    (change,) = compare_by_topic(ours, theirs)
    assert change.old is not None
    assert change.new is not None
    assert (change.old.id, change.new.id) == ("uvc-11-2", "cvc-2")
    assert likeness(item(), item(permission=True)) == 0


def test_text_fits_80_columns_and_json_is_stable() -> None:
    changes = (Change(item(condition="word " * 60), None), *compare([item(when="a " * 80)], [item(when="b " * 80)]))
    assert max(map(len, to_text("old", "new", changes).splitlines())) <= 80
    data = json.loads(to_json("old", "new", changes))
    assert data["schema"] == "regdb-diff/1"
    assert [change["kind"] for change in data["changes"]] == ["removed", "changed"]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "regdb", "diff", *arguments], capture_output=True, text=True, check=False)


def test_the_bicycle_passing_law_changes_on_new_year_2023(codes: Path) -> None:
    result = run("2022-12-31", "2023-01-01", "--in", "california", "--codes", str(codes), "--format", "json")
    assert result.returncode == 1, result.stderr
    ids = {change["id"] for change in json.loads(result.stdout)["changes"]}
    assert any(name.startswith("cvc-21760") for name in ids)


def test_two_jurisdictions_are_aligned_by_topic(codes: Path) -> None:
    result = run("uvc", "cvc", "--on", "2026-03-02", "--codes", str(codes))
    assert result.returncode == 1, result.stderr
    assert "uvc-11-202" in result.stdout
    assert "2026-03-02" in result.stdout


def test_two_folders(codes: Path, tmp_path: Path) -> None:
    shutil.copytree(codes, tmp_path / "codes")
    path = tmp_path / "codes" / "cvc" / "21453.yaml"
    path.write_text(path.read_text("utf-8").replace("result: may turn right\n", "result: may turn to the right\n", 1), "utf-8")
    result = run(str(codes), str(tmp_path / "codes"))
    assert "TEXT-ONLY" in result.stdout, result.stderr
    assert "may turn to the right" in result.stdout


def test_words_that_are_nothing_exit_2(codes: Path) -> None:
    result = run("narnia", "cvc", "--codes", str(codes))
    assert result.returncode == 2
    assert "'narnia' is no date, no file and no jurisdiction" in result.stderr
    assert "Traceback" not in result.stderr
