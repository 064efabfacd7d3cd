"""What the compiler's tests share: a small codes folder with one of everything, built once, and a cache of its own."""

from pathlib import Path

import pytest
from regdb_compiler.driver import Build, build


@pytest.fixture(scope="session")
def small_codes() -> Path:
    """Four sections of three codes, with definitions, a delegation, an override, two versions, every kind of fact."""
    return Path(__file__).parent / "small_codes"


@pytest.fixture(scope="session")
def small(small_codes: Path) -> Build:
    """The small codes, built."""
    found = build(small_codes)
    assert found.diagnostics == ()
    return found


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache folder that nobody else uses."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "regdb"
