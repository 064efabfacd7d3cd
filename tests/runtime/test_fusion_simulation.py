"""Hours at a red light with a model that errs: the default policy lets nothing go by mistake where the map corroborates."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from regdb_runtime.database import RegulationDatabase

from regdb.front import database

ROOT = Path(__file__).resolve().parents[2]
VOCABULARY = RegulationDatabase.open(database()).vocabulary


@pytest.fixture(scope="module")
def bench() -> ModuleType:
    """bench/fusion.py, which is no package's."""
    spec = importlib.util.spec_from_file_location("bench_fusion", ROOT / "bench" / "fusion.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(("rate", "run"), [(0.01, 1.0), (0.1, 1.0), (0.01, 8.0), (0.1, 8.0)])
def test_with_the_map_beside_it_no_false_green_lets_go(bench: ModuleType, rate: float, run: float) -> None:
    found = bench.simulate(VOCABULARY, rate, run, "map", 5.0, seed=1)
    assert found.raw > 0, "the model did say green at red"
    assert found.fused == 0


def test_confirmation_alone_stops_independent_errors_and_not_those_in_runs(bench: ModuleType) -> None:
    """Why corroboration is declared: a mistake that lasts is confirmed by itself."""
    loose = bench.without_corroboration(VOCABULARY)
    single = bench.simulate(VOCABULARY, 0.05, 1.0, "nothing", 5.0, 1, loose)
    lasting = bench.simulate(VOCABULARY, 0.05, 8.0, "nothing", 5.0, 1, loose)
    assert single.fused < single.raw / 20
    assert lasting.fused > lasting.raw / 4
    assert bench.simulate(VOCABULARY, 0.05, 8.0, "nothing", 5.0, 1).fused == 0, "the policy as declared believes nobody alone"


@pytest.mark.parametrize("run", [1.0, 8.0])
def test_errors_come_at_the_stated_rate(bench: ModuleType, run: float) -> None:
    times = np.arange(200_000) / 2
    said = bench.erring(np.random.default_rng(3), times, 0.05, run)
    wrong = said != bench.truth(times)
    assert wrong.mean() == pytest.approx(0.05, abs=0.006)
    lengths = np.diff(np.flatnonzero(np.diff(np.concatenate(([0], wrong.astype(int), [0])))))[::2]
    assert lengths.mean() == pytest.approx(run, rel=0.2)


def test_what_is_left_out_of_the_run_could_not_have_let_go(bench: ModuleType) -> None:
    """The stretches that are run and the whole hour give the same count."""
    loose = bench.without_corroboration(VOCABULARY)
    fact = VOCABULARY.fact("signal.color")
    model = bench.looks(np.random.default_rng(4), "model", 2.0, 3600.0, 0.1, 8.0)
    whole = bench.episodes(fact, loose, (model,), (0.0, 3600.0))
    assert whole == sum(bench.episodes(fact, loose, (model,), span) for span in bench.stretches(model)) > 0
