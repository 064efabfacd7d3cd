"""`regdb show` as typed: any name people use, the version of the day, near matches."""

import json
from pathlib import Path
from typing import Any

import pytest

from regdb.cli import main


@pytest.fixture
def show(small_codes: Path, own_cache: Path, capsys: pytest.CaptureFixture[str]) -> Any:  # noqa: ARG001
    def run(*arguments: str, code: int = 0) -> str:
        with pytest.raises(SystemExit) as caught:
            main(["show", "--codes", str(small_codes), *arguments])
        assert caught.value.code == code
        captured = capsys.readouterr()
        return captured.out if code == 0 else captured.err

    return run


def test_a_regulation_with_everything_that_hangs_on_it(show: Any) -> None:
    out = show("cvc-22350-a", "--on", "2026-03-02")
    for part in (
        "CVC 22350(a)  Posted speed", "since 1959-09-18", "Driving faster than the sign says.", "known(posted.speed) and lane.count >= 1",
        "bad_weather and lane.count > 3", "false: a prohibition", "max_speed posted.speed - 5 mph (prima_facie, max of plan.speed)",
        "cvc-22350-b (exception)", "la_city-80.14-a (override)", "https://example.org/22350", "checked 2026-11-20, seen",
        "(a) No faster than posted.", "law as of 2026-03-02\n",
    ):  # fmt: skip
        assert part in out
    assert max(map(len, out.splitlines())) <= 80


def test_today_is_named_where_it_was_the_default(show: Any) -> None:
    assert show("cvc-22350-a").endswith(" (today)\n")


@pytest.mark.parametrize("name", ["CVC 22350(b)", "cvc 22350(B)".replace("B", "b"), "Cal. Veh. Code § 22350(b)", "22350(b)", "CVC-22350-B"])
def test_one_place_under_many_names(show: Any, name: str) -> None:
    data = json.loads(show(name, "--format", "json"))
    assert [rule["id"] for rule in data["regulations"]] == ["cvc-22350-b"]


def test_several_words_are_one_name(show: Any) -> None:
    data = json.loads(show("CVC", "22350", "--format", "json"))
    assert data["shows"] == "section"
    assert [rule["id"] for rule in data["regulations"]] == ["cvc-22350-a", "cvc-22350-b"]
    assert data["sections"][0]["delegations"][0]["sign"] is True
    assert data["sections"][0]["definitions"][0]["name"] == "bad_weather"


def test_the_version_of_the_day(show: Any) -> None:
    old = json.loads(show("cvc-22348-b", "--on", "1990-01-01", "--format", "json"))["regulations"][0]
    new = json.loads(show("cvc-22348-b", "--on", "2010-01-01", "--format", "json"))["regulations"][0]
    assert (old["force"], new["force"]) == ("penalty_tier", "absolute")
    assert [item["effective"] for item in new["versions"]] == ["1984-01-01", "2005-01-01"]
    before = show("cvc-22348-b", "--on", "1970-01-01")
    assert "NOT IN FORCE ON THE DAY" in before
    assert "1984-01-01 to 2005-01-01" in before


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("emergency.siren", ["(boolean)", "A siren is heard.", "taken as false within 100 m", "siren, blue lights", "cvc-22350-b"]),
        ("posted.speed", ["(quantity, mph)", "strict: unknown stays unknown", "cvc-22350-a"]),
        ("clock.time", ["12:00"]),
        ("weather.kind", ["none, rain, fog", "rain: rain, wet", "cvc-22350-a"]),
        ("plan.speed", ["cvc-22348-b, cvc-22350-a, la_city-80.14-a"]),
        ("follow", ["lane_following.car_following  (state)", "Look ahead.", "Law to it"]),
        ("Go Straight", ["lane_following.go_straight  (state)", "overtaking.go_straight  (state)"]),
        ("passing", ["overtaking  (super-state)", "overtaking, lane_following"]),
        ("max_speed", ["(limit attribute)", "plan.speed", "cvc-22348-b, cvc-22350-a, la_city-80.14-a"]),
        ("bad_weather", ["CVC 22350", "weather.kind in {rain, fog}"]),
        ("los_angeles", ["City of Los Angeles", "model > california", "1 sections, 1 regulations"]),
        ("speed-posted", ["cvc-22350, uvc-11-801"]),
    ],
)
def test_words_of_the_language(show: Any, name: str, parts: list[str]) -> None:
    out = show(name)
    for part in parts:
        assert part in out
    assert json.loads(show(name, "--format", "json"))["shows"]


def test_a_place_hides_law_that_does_not_govern_there(show: Any) -> None:
    assert "there is no 'LAMC 80.14' in california" in show("LAMC 80.14", "--in", "california", code=2)
    assert "Near a school." in show("LAMC 80.14", "--in", "los_angeles")
    assert "unknown jurisdiction 'nowhere'; known: california" in show("cvc-22350-a", "--in", "nowhere", code=2)


@pytest.mark.parametrize(("name", "near"), [("cvc-22384-b", "cvc-22348-b"), ("posted.sped", "posted.speed"), ("overtakin", "overtaking")])
def test_near_matches_are_suggested(show: Any, name: str, near: str) -> None:
    err = show(name, code=2)
    assert f"there is no {name!r}; did you mean" in err
    assert near in err


def test_nothing_near_points_to_search(show: Any) -> None:
    assert "try `regdb search`" in show("qqqq", code=2)


def test_codes_with_errors_say_so(tmp_path: Path, own_cache: Path, capsys: pytest.CaptureFixture[str]) -> None:  # noqa: ARG001
    (tmp_path / "codes").mkdir()
    with pytest.raises(SystemExit) as caught:
        main(["show", "--codes", str(tmp_path / "codes"), "x"])
    assert caught.value.code == 2
    assert "run `regdb lint`" in capsys.readouterr().err


def test_the_machine_whole(show: Any) -> None:
    out = show("states")
    assert "State machine, starting in lane_following" in out
    assert "entered by go_straight, left by go_straight" in out
    assert max(map(len, out.splitlines())) <= 80
    data = json.loads(show("states", "--format", "json"))
    assert data["shows"] == "machine"
    assert data["super_states"][0]["name"] == data["initial"]


def test_the_machine_as_a_diagram_and_nothing_else_as_one(show: Any) -> None:
    assert show("states", "--format", "mermaid").startswith("stateDiagram-v2\n")
    assert show("states", "--format", "dot").startswith("digraph states {\n")
    assert "draws the state machine alone" in show("22350", "--format", "dot", code=2)
