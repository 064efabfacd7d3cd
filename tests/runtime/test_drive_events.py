"""Events and measures of a drive, read from logs made by hand."""

from __future__ import annotations

from made_logs import MPH, driven, made_log, made_tick, made_track
from regdb_runtime.drive.events import events_of
from regdb_runtime.drive.expected import shortfalls
from regdb_runtime.drive.log import Log
from regdb_runtime.drive.measures import measure, super_states
from regdb_runtime.drive.summary import markdown, row_of, story, table
from regdb_runtime.drive.variants import Expectation


def overtaking(*, returns: bool = True, aside: float = 3.5) -> Log:
    """Passes a cyclist 60 m ahead from 3 s to 16 s; without `returns` breaks it off at 4 s."""
    until = 16.0 if returns else 4.0

    def tick(time: float, x: float, speed: float, acceleration: float) -> dict[str, object]:
        within = 3.0 < time < until
        offset = aside if 5 < time < 14 and returns else 0.0
        near = abs(60 + 4.5 * time - x) < 3
        return made_tick(
            time, x, speed, acceleration=acceleration, offset=offset, state=f"{'overtaking' if within else 'lane_following'}.go_straight",
            tracks=[made_track(60 + 4.5 * time, -1.2, abs(offset + 1.2) - 1.2 if near else 20.0)],
        )  # fmt: skip

    return made_log(driven(20 if returns else 6, lambda *_: 0.0, tick))


def stopping(gap: float = 0.5, *, goes_on: bool = True) -> Log:
    """Stops `gap` metres before a line at 180 m and goes on at 22 s."""

    def acceleration(time: float, x: float, speed: float) -> float:
        left = 180 - gap - 3.85 - x
        if time > 22:
            return 1.5 if goes_on and speed < 6 else 0.0
        return -min(speed * speed / (2 * max(left, 0.02)), speed / 0.1) if left < speed * speed / 4 + 0.5 else 0.0

    def tick(time: float, x: float, speed: float, change: float) -> dict[str, object]:
        waits = time <= 22
        state = "intersection_handling.stop" if waits and time > 5 else "lane_following.go_straight" if waits else "intersection_handling.turn_right"
        phase = ("held" if waits else "released") if speed < 0.1 else ""
        return made_tick(time, x, speed, acceleration=change, state=state, phase=phase, signals={"e": [["red", "circular", False]]})

    return made_log(driven(32, acceleration, tick), stop_lines=[180.0])


def slowing(*, limit: float = 25 * MPH, brakes_at: float = 155.0) -> Log:
    """Brakes from 35 mph for a zone from 200 m to 300 m."""

    def acceleration(_: float, x: float, speed: float) -> float:
        return -1.5 if x + 3.85 > brakes_at and speed > 25 * MPH and x < 300 else 0.0

    def tick(time: float, x: float, speed: float, change: float) -> dict[str, object]:
        return made_tick(time, x, speed, acceleration=change, limit=limit if 200 <= x + 3.85 <= 300 else 35 * MPH)

    return made_log(driven(30, acceleration, tick), zones=[(200.0, 300.0)])


def names(log: Log) -> list[str]:
    return [event.name for event in events_of(log.run, log.ticks)]


def test_an_overtaking_has_two_events() -> None:
    log = overtaking()
    assert names(log) == ["overtaking_begins", "back_in_lane"]
    found = measure(log)
    assert found.passes == "next_lane"
    assert found.clearance is not None
    assert round(found.clearance, 2) == 3.5
    assert super_states(found.states) == ("lane_following", "overtaking", "lane_following")


def test_a_pass_within_the_lane_is_told_from_one_in_the_next() -> None:
    assert measure(overtaking(aside=0.8)).passes == "same_lane"


def test_an_overtaking_broken_off_is_no_return() -> None:
    log = overtaking(returns=False)
    assert names(log) == ["overtaking_begins", "overtaking_given_up"]
    assert measure(log).passes == ""


def test_a_stop_is_one_at_the_line() -> None:
    log = stopping()
    assert names(log) == ["stopped", "released"]
    found = measure(log)
    assert found.stop_gap is not None
    assert found.waited is not None
    assert 0.4 < found.stop_gap < 0.7
    assert found.waited > 5
    assert found.crosses == "red"
    assert names(stopping(gap=3.0)) == []
    assert names(stopping(goes_on=False)) == ["stopped", "released"]


def test_braking_for_a_zone_is_found_backwards_from_its_beginning() -> None:
    log = slowing()
    first, second = events_of(log.run, log.ticks)
    assert (first.name, second.name) == ("zone_detected", "reduced_speed")
    assert 155 <= first.station < 158
    assert second.station <= 200
    assert measure(log).zone_speed == max(tick["ego"]["speed"] for tick in log.ticks if 200 <= tick["ego"]["front"] <= 300)


def test_a_zone_that_changes_nothing_has_no_events() -> None:
    assert names(slowing(brakes_at=1000.0)) == []


def test_a_zone_is_slowed_down_for_whatever_the_law_was_taken_to_say() -> None:
    """A limit that may be in force is kept too; then no limit in force says why."""
    assert names(slowing(limit=35 * MPH)) == ["zone_detected", "reduced_speed"]


def test_a_limit_reached_too_late_is_told() -> None:
    log = slowing(brakes_at=190.0)
    found = measure(log)
    assert found.excess is not None
    assert found.excess > 1.0
    wrong = shortfalls(Expectation("", zone_limit=25 * MPH), found)
    assert any("over the limit in force" in text for text in wrong)
    assert any("m/s in the zone" in text for text in wrong)


def test_what_is_not_as_expected_is_told_one_by_one() -> None:
    found = measure(stopping())
    expects = Expectation("", ("stopped",), ("CVC 21453(a)",), passes="next_lane", crosses="green")
    assert shortfalls(expects, found) == (
        "events stopped, released; expected stopped", "passed nobody; expected next_lane", "crossed the line on red; expected green",
        "not decided by CVC 21453(a)",
    )  # fmt: skip
    assert shortfalls(Expectation("", ("stopped", "released"), crosses="red"), found) == ()


def test_the_table_is_as_wide_as_a_terminal() -> None:
    rows = [row_of(log, None) for log in (overtaking(), stopping(), slowing())]
    assert max(len(line) for line in table(rows).splitlines()) <= 80
    assert "stops 0.49 m before the line" in story(rows[1].measures)
    assert len(markdown(rows).splitlines()) == 2 + len(rows)
    assert len({line.count("|") for line in markdown(rows).splitlines()}) == 1
