"""`regdb lint` and `regdb rule` as typed: what they print, what they change, how they end."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from regdb_compiler.lint.example import read_example, write_example

from regdb.cli import main

Run = Callable[..., tuple[int, str, str]]
WRONG = "attributes: {max_speed: 25 mph}\ncondition: {when: children.present == true and sign.school}\nappend: \"# end \\n\""
LEGAL = "attributes: {max_speed: 120 mph}\nforce: absolute"


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def told(*arguments: str | Path) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return int(ended.value.code or 0), out, err

    return told


@pytest.fixture
def codes(tmp_path: Path) -> Path:
    write_example(read_example(WRONG), tmp_path)
    return tmp_path / "codes"


def test_findings_are_shown_and_warnings_do_not_fail(run: Run, codes: Path) -> None:
    code, out, err = run("lint", "--codes", codes)
    assert code == 0
    assert "warning[R310] limit-without-force" in out
    assert out.isascii()
    assert "(today)" in err
    assert all(len(line) <= 80 for line in out.splitlines() if "|" in line)


def test_strict_counts_warnings(run: Run, codes: Path) -> None:
    assert run("lint", "--codes", codes, "--strict")[0] == 1
    assert run("lint", "--codes", codes, "--strict", "--select", "R6")[0] == 0


def test_errors_fail(run: Run, tmp_path: Path) -> None:
    write_example(read_example("legality: true"), tmp_path)
    assert run("lint", "--codes", tmp_path / "codes")[0] == 1


def test_the_day_is_printed_only_where_it_was_the_default(run: Run, codes: Path) -> None:
    assert "today" not in run("lint", "--codes", codes, "--on", "2026-03-02")[2]


@pytest.mark.parametrize("format_", ["concise", "json", "sarif", "junit", "github"])
def test_every_format_names_the_finding(run: Run, codes: Path, format_: str) -> None:
    assert "R310" in run("lint", "--codes", codes, "--format", format_)[1]


def test_paths_narrow_the_report(run: Run, codes: Path) -> None:
    assert "R310" in run("lint", codes / "st" / "100.yaml", "--codes", codes, "--format", "concise")[1]
    assert run("lint", codes / "ci", "--codes", codes, "--format", "concise")[1] == ""
    code, _, err = run("lint", codes.parent, "--codes", codes)
    assert (code, "not in" in err) == (2, True)
    assert run("lint", codes / "none.yaml", "--codes", codes)[0] == 2


def test_diff_shows_the_fixes_and_changes_nothing(run: Run, codes: Path) -> None:
    path = codes / "st" / "100.yaml"
    before = path.read_bytes()
    code, out, _ = run("lint", "--codes", codes, "--diff")
    assert code == 1
    assert "--- a/codes/st/100.yaml" in out
    assert "+    force: absolute" in out
    assert "+      when: children.present and sign.school" in out
    assert path.read_bytes() == before


def test_fix_makes_them_once_and_for_all(run: Run, codes: Path) -> None:
    code, out, err = run("lint", "--codes", codes, "--fix")
    assert code == 0
    assert "fixed in 1 file" in err
    assert "R310" not in out
    text = (codes / "st" / "100.yaml").read_text("utf-8")
    assert "force: absolute" in text
    assert "when: children.present and sign.school" in text
    assert text.endswith("# end\n")
    assert run("lint", "--codes", codes, "--diff")[:2] == (0, "")


def test_legal_fixes_are_never_made(run: Run, tmp_path: Path) -> None:
    write_example(read_example(LEGAL), tmp_path)
    run("lint", "--codes", tmp_path / "codes", "--fix", "--unsafe-fixes")
    assert "penalty_tier" not in (tmp_path / "codes" / "st" / "100.yaml").read_text("utf-8")


def test_unsafe_fixes_only_when_asked_for(run: Run, tmp_path: Path) -> None:
    write_example(read_example("authority: ST 40"), tmp_path)
    path = tmp_path / "codes" / "st" / "100.yaml"
    run("lint", "--codes", tmp_path / "codes", "--fix")
    assert "authority" in path.read_text("utf-8")
    run("lint", "--codes", tmp_path / "codes", "--unsafe-fixes", "--diff")
    assert "authority" in path.read_text("utf-8")
    run("lint", "--codes", tmp_path / "codes", "--fix", "--unsafe-fixes")
    assert "authority" not in path.read_text("utf-8")


def test_a_baseline_is_written_and_kept(run: Run, codes: Path, tmp_path: Path) -> None:
    known = tmp_path / "known.json"
    assert run("lint", "--codes", codes, "--write-baseline", known)[0] == 0
    assert run("lint", "--codes", codes, "--baseline", known, "--format", "concise")[1] == ""
    code, _, err = run("lint", "--codes", codes, "--baseline", tmp_path / "none.json")
    assert (code, err.count("error:")) == (2, 1)


def test_statistics_count(run: Run, codes: Path) -> None:
    out = run("lint", "--codes", codes, "--statistics")[1]
    assert "     1  R310  limit-without-force            warning  [*]" in out


def test_mistakes_are_told_in_one_line(run: Run, codes: Path) -> None:
    code, _, err = run("lint", "--codes", codes, "--select", "limit-without-forse")
    assert code == 2
    assert "did you mean limit-without-force" in " ".join(err.split())
    assert run("lint", "--codes", codes, "--format", "xml")[0] == 2
    assert run("lint", "--codes", codes / "none")[0] == 2


def test_a_rules_page(run: Run) -> None:
    by_code, by_name = run("rule", "r313"), run("rule", "penalty-tier-as-limit")
    assert by_code == by_name
    assert by_code[0] == 0
    assert all(heading in by_code[1].splitlines() for heading in ("Why", "Fails", "Passes", "Fix (legal)"))


def test_pages_of_what_reading_reports(run: Run) -> None:
    out = run("rule", "R608")[1]
    assert "permission-without-target" in out
    assert "Fails" in out


def test_the_list_of_rules(run: Run) -> None:
    code, out, _ = run("rule")
    assert code == 0
    assert "  R310  limit-without-force            warning  fix: safe" in out
    assert all(len(line) <= 80 for line in out.splitlines())
    assert "R310" not in run("rule", "R6")[1]


def test_rules_as_json(run: Run) -> None:
    told = json.loads(run("rule", "--format", "json")[1])
    assert {item["code"] for item in told["rules"]} >= {"R001", "R310", "R608", "R903"}
    assert json.loads(run("rule", "R310", "--format", "json")[1])["fix_kind"] == "safe"


def test_a_rule_that_is_not_there(run: Run) -> None:
    code, out, err = run("rule", "polarity-missmatch")
    assert (code, out) == (2, "")
    assert "did you mean polarity-mismatch" in " ".join(err.split())
