"""`regdb test`: what it prints, in three formats, and how it exits."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from regdb import cli

Town = Callable[..., Path]
WRONG = ("sc/10.yaml", "expect: legal}", "expect: illegal}")
UNREAD = ("sc/11.yaml", "plan: {speed: 40 mph}", "plan: {sped: 40 mph}")


def run(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        cli.main(["test", *map(str, arguments)])
    told = capsys.readouterr()
    return int(stop.value.code or 0), told.out, told.err


def test_all_passing_is_one_line(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, "--codes", town())
    assert (code, err) == (0, "")
    assert re.fullmatch(r"13 law tests passed \(6 regulations, 1 case\) in \d+\.\d s\n", out)


def test_a_failure_shows_what_decided_and_what_would_turn_it(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--codes", town(("sc/10.yaml", "deciding: [b], assumed: [officer]", "assumed: []"), WRONG))
    assert code == 1
    assert all(len(line) <= 80 for line in out.splitlines())
    for part in ("FAILED codes/sc/10.yaml:19\n", "sc-10-a: at green", "verdict: illegal", "verdict: legal",
                 "not deciding  sc-10-a (SC 10(a)) does not hold",
                 "- signal.color == red is false (signal.color is green)", "would hold if signal.color == red (now green)",
                 "assumed: officer", "11 law tests passed, 2 failed"):  # fmt: skip
        assert part in out, part


def test_an_illegal_verdict_shows_the_way_out(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    change = ("sc/11.yaml", "expect: {verdict: illegal, deciding: [a], limits", "expect: {verdict: legal, limits")
    _, out, _ = run(capsys, "--codes", town(change))
    assert "decided by    sc-11-a (SC 11(a)) holds" in out
    assert "- plan.speed <= 40 mph is false (plan.speed is 45 mph)" in out
    assert "would turn    plan.speed <= 40 mph (now 45 mph)" in out


def test_a_broken_test_shows_its_place(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--codes", town(UNREAD))
    assert code == 1
    assert "BROKEN codes/sc/11.yaml:30" in out
    assert "1 broken (6 regulations, 1 case)" in out


@pytest.mark.parametrize(
    ("arguments", "passed"),
    [(["-k", "RED"], 3), (["-k", "tc-1"], 1), (["-k", "nothing of the sort"], 0), (["codes/sc/11.yaml"], 5), (["codes/tc"], 1),
      (["codes/sc/cases"], 1), (["codes"], 13),
     (["codes/sc", "-k", "limit"], 3)],
)  # fmt: skip
def test_tests_are_chosen_by_word_and_path(
    town: Town, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, arguments: list[str], passed: int
) -> None:
    monkeypatch.chdir(town().parent)
    code, out, _ = run(capsys, *arguments)
    assert code == 0
    assert out.startswith(f"{passed} law tests passed")


def test_a_path_outside_the_codes_is_a_mistake_told_in_one_line(town: Town, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    code, out, err = run(capsys, "--codes", town(), tmp_path / "elsewhere.yaml")
    assert (code, out) == (2, "")
    assert "is no file or folder of the codes" in err


def test_x_stops_at_the_first_and_q_is_one_line_each(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    folder = town(WRONG, UNREAD)
    _, out, _ = run(capsys, "--codes", folder, "-q")
    assert out.splitlines()[:2] == ["FAILED codes/sc/10.yaml:19 at green", "BROKEN codes/sc/11.yaml:30 at the limit"]
    _, out, _ = run(capsys, "--codes", folder, "-q", "-x")
    assert out.splitlines()[0] == "FAILED codes/sc/10.yaml:19 at green"
    assert out.splitlines()[1].startswith("1 law tests passed, 1 failed (1 regulation, 0 cases)")


def test_json_holds_every_test_and_the_coverage(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--codes", town(WRONG, UNREAD), "--format", "json", "--coverage")
    data = json.loads(out)
    assert code == 1
    assert data["summary"] == {"passed": 11, "failed": 1, "broken": 1, "regulations": 6, "cases": 1}
    assert len(data["tests"]) == 13
    failed = next(item for item in data["tests"] if item["status"] == "failed")
    assert failed["differences"] == [{"key": "verdict", "expected": "illegal", "got": "legal"}]
    assert failed["decision"]["verdict"] == "legal"
    assert data["coverage"]["uncovered"]


def test_junit_counts_failures_and_errors(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "--codes", town(WRONG, UNREAD), "--format", "junit")
    root = ET.fromstring(out.encode())
    assert (root.get("tests"), root.get("failures"), root.get("errors")) == ("13", "1", "1")
    assert [suite.get("name") for suite in root] == [f"codes/{name}.yaml" for name in ("sc/10", "sc/11", "sc/12", "sc/cases/red", "tc/1")]
    failure = root.find(".//failure")
    assert failure is not None
    assert "expected illegal, got legal" in (failure.get("message") or "")


def test_coverage_is_shown_and_may_be_too_little(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    folder = town()
    code, out, _ = run(capsys, "--codes", folder, "--coverage", "--cov-fail-under", "10")
    assert code == 0
    assert out.startswith("code ")
    assert "not covered:" in out
    code, _, err = run(capsys, "--codes", folder, "--cov-fail-under", "100")
    assert code == 1
    assert "less than 100 %" in err


def test_errors_in_the_codes_are_told(town: Town, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, "--codes", town(("sc/12.yaml", "when: officer", "when: offcer")))
    assert code == 1
    assert "`regdb lint`" in err
    assert "broken" in out


def test_the_shipped_codes_run_at_thousands_of_tests_a_second(codes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "--codes", codes, "-q")
    closing = out.splitlines()[-1]
    number = int(closing.split()[0])
    seconds = float(closing.split(" in ")[1].split()[0])
    assert number > 500
    assert seconds < 20
