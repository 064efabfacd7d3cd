"""Measure everything against its mark, in one run: `python bench/run.py [--quick]`; writes out/bench/results.json.

Absolute times drift between machines and with what else they do; the bare start of Python at the head of the table tells how fast
this one is now (18 ms where the marks were set). The parts are scripts of their own: decide.py, drive.py,
emergency.py, emit.py, lint_and_compile.py, plan.py.
"""

# ruff: noqa: T201  # a script whose result is what it prints
from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from generate import generate

HERE = Path(__file__).parent
CODES = HERE.parent / "codes"
OUT = Path("out/bench/results.json")
STARTS = 9
"""Process starts whose median counts."""


@dataclass(frozen=True, slots=True)
class Row:
    """One measurement and its mark; with `at_least` more is better."""

    what: str
    measured: float
    mark: float
    unit: str
    at_least: bool = False

    @property
    def ratio(self) -> float:
        """How many times better than the mark; below 1 the mark is missed."""
        return self.measured / self.mark if self.at_least else self.mark / self.measured

    @property
    def word(self) -> str:
        return "met" if self.ratio >= 1 else "MISSED"


def seconds(*command: str) -> float:
    """Median seconds that a process takes from start to end. Raises CalledProcessError where it fails."""
    taken = []
    for _ in range(STARTS):
        started = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        taken.append(time.perf_counter() - started)
    return statistics.median(taken)


def script(name: str, *arguments: str) -> str:
    """What one of the scripts beside this one prints. Raises RuntimeError where it fails."""
    command = [sys.executable, str(HERE / name), *arguments]
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, text=True)
    if done.returncode not in {0, 1}:  # 1 tells of a missed mark, which the table tells too
        raise RuntimeError(f"{name} ended with {done.returncode}")
    return done.stdout


def starting(bare: float) -> Iterator[Row]:
    """`regdb --help`, alone and in bare starts of Python."""
    shown = seconds(sys.executable, "-m", "regdb", "--help")
    yield Row("regdb --help", shown * 1000, 85, "ms")
    yield Row("regdb --help, in bare starts of Python", shown / bare, 5, "x")


def linting() -> Iterator[Row]:
    """Lint of the shipped codes in a fresh process, findings or not."""
    command = [sys.executable, "-m", "regdb", "lint", "--codes", str(CODES), "--format", "concise"]
    taken = []
    for _ in range(3):
        started = time.perf_counter()
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        taken.append(time.perf_counter() - started)
        if done.returncode not in {0, 1}:
            raise RuntimeError(f"`regdb lint` ended with {done.returncode}: {done.stderr.strip()}")
    yield Row("lint of the shipped codes, cold", statistics.median(taken), 1.5, "s")


def compiling(sizes: tuple[int, ...]) -> Iterator[Row]:
    """Lint and compile made-up regulations; between sizes time and memory grow in proportion."""
    found: dict[int, dict[str, Any]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for size in sizes:
            codes = generate(size, Path(folder) / str(size))
            found[size] = json.loads(script("lint_and_compile.py", str(codes)))
            if found[size]["regulations"] != size:
                raise RuntimeError(f"{found[size]['regulations']} of {size} regulations came through")
    for size, mark in ((10_000, 3.0), (100_000, 30.0)):
        if size in found:
            yield Row(f"lint + compile {size:,} regulations", found[size]["lint_and_compile_s"], mark, "s")
    yield Row("opening 10,000 regulations", found[10_000]["open_s"] * 1000, 300, "ms")
    for small, large in pairwise(sizes):
        times = large / small
        grown = found[large]["lint_and_compile_s"] / found[small]["lint_and_compile_s"]
        yield Row(f"growth of time, {small:,} to {large:,}", grown, times * 1.3, "x")
        memory = found[large]["peak_bytes"] / found[small]["peak_bytes"]
        yield Row(f"growth of memory, {small:,} to {large:,}", memory, times * 1.3, "x")


def deciding(*, quick: bool) -> Iterator[Row]:
    """One verdict with rules and limits, alone and against the paper's way, in decide.py's own run."""
    told = script("decide.py", *(["--quick"] if quick else []))
    print(told, file=sys.stderr)
    marks = {(1_000, "tree"): (3.0, 400.0), (100_000, "tree"): (15.0, 1000.0)}
    for item in json.loads(Path("out/bench/decide.json").read_text("utf-8"))["results"]:
        mark = marks.get((item["rules"], item["shape"]))
        if mark is not None:
            yield Row(f"one verdict, {item['rules']:,} regulations in a tree", item["microseconds"]["index"], mark[0], "us")
            yield Row("  times the paper's way", item["ratio to the paper's way"], mark[1], "x", at_least=True)


def emitting(size: int) -> Iterator[Row]:
    """From resolved regulations to the database file."""
    script("emit.py", str(size))
    data = json.loads(Path("out/bench/emit.json").read_text("utf-8"))
    yield Row(f"database from {size:,} resolved regulations", data["database_s"], size / 10_000, "s")


def planning() -> Iterator[Row]:
    """Plans sampled, checked, costed and tested for contact, and projection to the path, in plan.py's own run; its rivals are for it alone."""
    print(script("plan.py"), file=sys.stderr)
    found = json.loads(Path("out/bench/plan.json").read_text("utf-8"))
    own = found["own_s"]
    yield Row("1,000 plans: sampled, checked, costed, contact", own["whole"] / own["plans"] * 1e6, 3.0, "ms")
    yield Row("projection to the path", found["points_per_s"], 2e6, "/s", at_least=True)


def braking() -> Iterator[Row]:
    """The emergency check with 50 road users about, in emergency.py's own run."""
    print(script("emergency.py"), file=sys.stderr)
    found = json.loads(Path("out/bench/emergency.json").read_text("utf-8"))
    slowest = max(item["p99_us"] for what, item in found.items() if "check" in what)
    yield Row("emergency check among 50 road users, p99", slowest / 1000, 0.3, "ms")


def driving(*, quick: bool) -> Iterator[Row]:
    """Ticks of the planner and the paper's drive, in drive.py's own run."""
    print(script("drive.py", *(["--quick"] if quick else [])), file=sys.stderr)
    found = json.loads(Path("out/bench/drive.json").read_text("utf-8"))
    yield Row("the paper's drive, built-in world", found["paper_times_real"], 30, "x", at_least=True)
    yield Row("strategic tick of the paper's drive, p99", found["paper_strategic_p99_ms"], 10, "ms")
    yield Row("motion tick of the paper's drive, p99", found["paper_motion_p99_ms"], 6, "ms")


def table(rows: list[Row], bare: float) -> str:
    """One line for each measurement, and a closing one."""
    lines = [f"bare start of Python {bare * 1000:.0f} ms, {os.cpu_count()} cores, Python {platform.python_version()}", ""]
    lines.append(f"{'':44} {'measured':>12} {'mark':>12} {'ratio':>7}")
    for row in rows:
        sign = ">=" if row.at_least else "<="
        marked = f"{sign} {row.mark:,.4g} {row.unit}"
        lines.append(f"{row.what:44} {row.measured:>9,.4g} {row.unit:<2} {marked:>12} {row.ratio:>7.2f}  {row.word}".rstrip())
    missed = sum(1 for row in rows if row.word != "met")
    return "\n".join([*lines, "", f"{len(rows) - missed} marks met, {missed} missed"])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="smaller: 1,000 and 10,000 regulations only, few rounds")
    parser.add_argument("--strict", action="store_true", help="exit 1 when a mark is missed")
    chosen = parser.parse_args()
    bare = seconds(sys.executable, "-c", "pass")
    sizes = (1_000, 10_000) if chosen.quick else (1_000, 10_000, 100_000)
    steps = [
        ("starts", starting(bare)), ("lint", linting()), ("lint and compile", compiling(sizes)),
        ("emission", emitting(1_000 if chosen.quick else 10_000)), ("verdicts", deciding(quick=chosen.quick)),
        ("planning", planning()), ("the emergency check", braking()), ("the drive", driving(quick=chosen.quick)),
    ]  # fmt: skip
    rows: list[Row] = []
    for name, found in steps:
        print(f"measuring {name} ...", file=sys.stderr)
        rows += found
    print(table(rows, bare))
    OUT.parent.mkdir(parents=True, exist_ok=True)
    results = [asdict(row) | {"ratio": row.ratio, "word": row.word} for row in rows]
    head = {"python": platform.python_version(), "machine": platform.machine(), "cores": os.cpu_count(), "bare_start_s": bare}
    OUT.write_text(json.dumps(head | {"results": results}, indent=1) + "\n", "utf-8")
    print(f"written: {OUT}", file=sys.stderr)
    return 1 if chosen.strict and any(row.word != "met" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
