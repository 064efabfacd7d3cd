"""The four errors in the paper's own examples, encoded as the paper words them, are findings; encoded as the law says, they are not."""

from pathlib import Path
from typing import Any

from regdb_compiler.lint.example import build_example, read_example
from regdb_compiler.lint.run import lint

TABLE_ONE = """
section: "22348"
title: Excessive speed and designated lane use
text: |
  (a) No speed above the limits of the other sections.
  (b) Whoever drives faster than 100 miles per hour is guilty of an infraction.
id: b
condition: {text: A person drives a vehicle upon a highway at a speed greater than 100 miles per hour., when: null}
result: is guilty of an infraction punishable
legality: false
attributes: {road_type: highway, max_speed: 100 mph}
states: {current: [car_following, lane_following.go_straight], next: [lane_change]}
"""
SCHOOL_BAND = """
section: "22358.4"
title: Decrease of local limits near schools
text: |
  (a) When a local authority finds by survey that 25 miles per hour is more than is reasonable near schools, the local authority may, by
  ordinance or resolution, declare 25 miles per hour when approaching, at a distance of 500 to 1,000 feet from, a school building.
id: a
condition:
  text: Approaching, at a distance of 500 to 1,000 feet from, a school building.
  when: school.distance >= 500 ft and school.distance <= 1000 ft
result: must not drive faster than 25 mph
attributes: {max_speed: 25 mph}
force: prima_facie
"""
PRIMA_FACIE = """
section: "22352"
title: Prima facie speed limits
text: (a) The prima facie limit is 25 miles per hour in the zone of a school.
id: a
condition: {text: A school zone with its sign., when: sign.school}
result: must not drive faster than 25 mph
attributes: {max_speed: 25 mph}
"""
RIGHT_ON_RED = """
section: "21453"
title: Circular red
text: |
  (a) A driver stops on red.
  (b) After stopping a driver may turn right.
id: b
condition: {text: "After stopping as required, facing a red signal.", when: signal.color == red and ego.stopped_at_line}
result: may turn right
legality: true
states: {current: [intersection_handling], next: [turn_right]}
"""


def errors(example: str, folder: Path, **changes: Any) -> set[str]:
    build = build_example({**read_example(example), **changes}, folder)
    return {item.name for item in lint(build) if item.level == "error"}


def test_the_row_of_table_one_read_as_a_limit(tmp_path: Path) -> None:
    for force in ("absolute", None):
        assert errors(TABLE_ONE, tmp_path / str(force), force=force) == {"penalty-tier-as-limit"}
    assert errors(TABLE_ONE, tmp_path / "right", force="penalty_tier") == set()


def test_the_school_band_as_if_it_applied_by_itself(tmp_path: Path) -> None:
    assert errors(SCHOOL_BAND, tmp_path / "wrong") == {"delegation-as-rule"}
    assert errors(SCHOOL_BAND, tmp_path / "sign", requires_sign="sign.speed_limit") == set()
    by_act = {"text": "A school with a local act.", "when": "road.local_act and school.distance <= 1000 ft"}
    assert errors(SCHOOL_BAND, tmp_path / "act", condition=by_act) == set()


def test_a_prima_facie_limit_called_absolute(tmp_path: Path) -> None:
    assert errors(PRIMA_FACIE, tmp_path / "wrong", force="absolute") == {"prima-facie-called-absolute"}
    assert errors(PRIMA_FACIE, tmp_path / "by default") == {"prima-facie-called-absolute"}
    assert errors(PRIMA_FACIE, tmp_path / "right", force="prima_facie") == set()


def test_right_on_red_as_an_exception_to_nothing(tmp_path: Path) -> None:
    assert errors(RIGHT_ON_RED, tmp_path / "wrong") == {"permission-without-target"}
    assert errors(RIGHT_ON_RED, tmp_path / "right", exception_to=["st-10-a"]) == set()
