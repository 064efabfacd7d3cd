"""`regdb chain` as typed: the tree of exceptions and overrides, both ways."""

import json
from pathlib import Path
from typing import Any

import pytest

from regdb.cli import main


@pytest.fixture
def chain(small_codes: Path, own_cache: Path, capsys: pytest.CaptureFixture[str]) -> Any:  # noqa: ARG001
    def run(*arguments: str, code: int = 0) -> str:
        with pytest.raises(SystemExit) as caught:
            main(["chain", "--codes", str(small_codes), *arguments])
        assert caught.value.code == code
        captured = capsys.readouterr()
        return captured.out if code == 0 else captured.err

    return run


def test_the_tree_upwards(chain: Any) -> None:
    assert chain("cvc-22350-a", "--on", "2026-03-02") == (
        "CVC 22350(a)  cvc-22350-a  (since 1959-09-18)\n"
        "  forbidden: must not exceed it\n"
        "  displaced by\n"
        "  |-- CVC 22350(b)  cvc-22350-b  [exception; since 1959-09-18]\n"
        "  |   may go faster\n"
        "  `-- LAMC 80.14  la_city-80.14-a  [override, by CVC 22350; since 2010-07-01]\n"
        "      must not exceed 20 mph\n"
        "  displaces: nothing\n"
        "\n"
        "law as of 2026-03-02\n"
    )


def test_the_tree_downwards(chain: Any) -> None:
    data = json.loads(chain("LAMC 80.14", "--format", "json"))["regulations"]
    assert [item["id"] for item in data] == ["la_city-80.14-a"]
    assert data[0]["displaced_by"] == []
    assert [(item["id"], item["kind"]) for item in data[0]["displaces"]] == [("cvc-22350-a", "overrides")]


def test_the_day_and_the_place_count(chain: Any) -> None:
    assert "80.14" not in chain("cvc-22350-a", "--on", "2000-01-01")
    assert "80.14" not in chain("cvc-22350-a", "--in", "california")
    assert "80.14" in chain("cvc-22350-a", "--in", "los_angeles")


def test_a_section_shows_all_its_regulations(chain: Any) -> None:
    out = chain("CVC", "22350")
    assert "  displaces\n  `-- CVC 22350(a)  cvc-22350-a  [exception; since 1959-09-18]\n" in out


def test_what_hangs_in_two_places_is_shown_once(tmp_path: Path) -> None:
    import sqlite3

    from regdb_compiler.library import Library
    from regdb_compiler.relations import displaced_by

    from regdb.schema import TABLES, VIEWS

    path = tmp_path / "r.sqlite"
    with sqlite3.connect(path) as connection:
        connection.executescript(";".join(f"CREATE TABLE {name} ({', '.join(TABLES[name])})" for name in TABLES))
        connection.execute("INSERT INTO jurisdiction VALUES ('x','','state','law',NULL,'','','','[]','[]','')")
        for key, name in enumerate("abcd", 1):
            cells = (key, name, 1, "x", name, "", "", 0, "2000-01-01", None, "", "", "", "", None, name, "", "{}", "", "", "", "", "[]", "[]")
            connection.execute(f"INSERT INTO regulation VALUES ({','.join('?' * 28)})", (*cells, "", 0, "", ""))
        pairs = [(2, 0, "a"), (3, 0, "a"), (4, 0, "b"), (4, 1, "c")]
        connection.executemany("INSERT INTO regulation_target VALUES (?, ?, ?, 'exception_to')", pairs)
    connection.close()
    assert VIEWS
    with Library(path) as library:
        root = displaced_by(library, "a", "2026-01-01")
    b, c = root.links
    assert [(link.id, link.seen) for link in (b, *b.links, c, *c.links)] == [("b", False), ("d", False), ("c", False), ("d", True)]


def test_a_fact_has_no_chain(chain: Any) -> None:
    assert "'posted.speed' is a fact without regulations" in chain("posted.speed", code=2)
    assert "did you mean" in chain("cvc-22350-x", code=2)
