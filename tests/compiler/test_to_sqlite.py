"""The database file: everything of the schema in it, the same bytes each time, whole or not there."""

import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
import sqlite_utils
from regdb_compiler.diagnostics import Diagnostic, Place, RegdbInputError
from regdb_compiler.driver import Build, build
from regdb_compiler.emit import to_sqlite
from regdb_compiler.emit.to_sqlite import write_database
from regdb_runtime.database import RegulationDatabase

from regdb.content_hash import content_hash
from regdb.schema import APPLICATION_ID, INDEXES, META_KEYS, PAPER_COLUMNS, TABLES, USER_VERSION, VIEWS
from regdb.vocabulary import read_date


@pytest.fixture(scope="module")
def database(small: Build, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("database") / "regulations.sqlite"
    write_database(small, path)
    return path


@pytest.fixture
def connection(database: Path) -> Iterator[sqlite3.Connection]:
    with closing(sqlite3.connect(database)) as found:
        yield found


def test_the_file_says_what_it_is(connection: sqlite3.Connection) -> None:
    assert connection.execute("PRAGMA application_id").fetchone() == (APPLICATION_ID,)
    assert connection.execute("PRAGMA user_version").fetchone() == (USER_VERSION,)
    assert connection.execute("PRAGMA page_size").fetchone() == (4096,)
    assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert connection.execute("PRAGMA foreign_key_check").fetchall() == []


def test_everything_of_the_schema_is_there(database: Path) -> None:
    with closing(sqlite_utils.Database(database)) as found:
        assert set(TABLES) <= set(found.table_names())
        assert set(found.view_names()) == set(VIEWS)
        assert {index.name for table in TABLES for index in found[table].indexes} >= set(INDEXES)
        assert [name for name in TABLES if not found[name].count] == []
        assert found["regulation"].foreign_keys == sorted(found["regulation"].foreign_keys)


def test_the_summary_counts_what_was_written(small: Build, database: Path, tmp_path: Path, connection: sqlite3.Connection) -> None:
    summary = write_database(small, tmp_path / "again.sqlite")
    assert summary.size == database.stat().st_size
    for table in TABLES:
        extra = 1 if table == "regdb_meta" else 0
        assert connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0] == summary.rows[table] + extra


def test_meta_says_sources_counts_licence_and_hash(connection: sqlite3.Connection) -> None:
    meta = dict(connection.execute("SELECT key, value FROM regdb_meta"))
    assert set(meta) == set(META_KEYS)
    assert meta["content_hash"] == content_hash(connection)
    assert meta["notice"].startswith("Not legal advice")
    assert meta["schema_version"] == "1.2"
    assert meta["regulations"] == "5"
    sources = json.loads(meta["sources"])
    assert sources["cvc"] == {"jurisdiction": "State of California", "source": "https://leginfo.legislature.ca.gov", "checked": "2026-11-21"}
    assert json.loads(meta["codes"]) == {
        "cvc": {"sections": 2, "regulations": 4},
        "la_city": {"sections": 1, "regulations": 1},
        "uvc": {"sections": 1, "regulations": 0},
    }


def test_the_runtime_reads_back_what_was_compiled(small: Build, database: Path) -> None:
    found = RegulationDatabase.open(database)
    assert found.regulations == small.regulations
    assert found.vocabulary.facts == small.corpus.vocabulary.facts
    assert found.vocabulary.attributes == small.corpus.vocabulary.attributes
    assert {item.id: item for item in found.tree} == {item.id: item for item in small.corpus.tree}
    assert found.machine.super_states == small.corpus.machine.super_states
    assert found.machine.initial == small.corpus.machine.initial
    ours = {state.id: replace(state, next=tuple(sorted(state.next))) for state in small.corpus.machine.states.values()}
    assert {state.id: replace(state, next=tuple(sorted(state.next))) for state in found.machine.states.values()} == ours


def test_columns_hold_the_law_s_own_words_and_numbers(connection: sqlite3.Connection) -> None:
    row = connection.execute(
        "SELECT when_text, unless_text, attributes, current_states, applies_to, effective, until FROM regulation WHERE id = 'cvc-22348-b' "
        "ORDER BY key DESC LIMIT 1"
    ).fetchone()
    assert row == (
        "", "", '{"max_speed":"100 mph","road_type":"highway"}', "Car Following; Go Straight; Overtaking", '["passenger","bus"]',
        "2005-01-01", None,
    )  # fmt: skip
    limits = connection.execute("SELECT bound, value, unit, si, law_text FROM regulation_limit ORDER BY regulation, position").fetchall()
    assert limits[0] == ("[44.704,[]]", 100.0, "mph", 44.704, "100 mph")
    assert limits[2] == ('[-2.2352,[[1.0,"posted.speed"]]]', None, "mph", None, "posted.speed - 5 mph")
    when, unless = connection.execute("SELECT when_text, unless_tree FROM regulation WHERE id = 'cvc-22350-a'").fetchone()
    assert when == "known(posted.speed) and lane.count >= 1 and clock.time within 22:00..23:00 and clock.date >= 2000-01-01"
    assert json.loads(unless)[1] == ["in", "weather.kind", ["fog", "rain"]] or json.loads(unless)[1] == ["in", "weather.kind", ["rain", "fog"]]


def test_facts_keep_assumed_and_quiet_values_in_si(connection: sqlite3.Connection) -> None:
    facts = {row[0]: row[1:] for row in connection.execute("SELECT name, assumed, assumed_within, quiet, dimension FROM fact")}
    assert facts["emergency.siren"] == ("false", "100 m", "false", "")
    assert facts["weather.kind"] == ('"none"', "", '"none"', "")
    assert facts["road.types"] == (None, "", '["highway"]', "")
    assert facts["clock.time"] == (None, "", "43200", "time")
    assert facts["posted.speed"] == (None, "", None, "speed")


def test_local_law_carries_its_delegation_and_what_it_overrides(connection: sqlite3.Connection) -> None:
    assert connection.execute("SELECT * FROM overrides_of WHERE kind = 'overrides'").fetchall() == [
        ("cvc-22350-a", "la_city-80.14-a", "overrides", "LAMC 80.14", "los_angeles", "CVC 22350", "2010-07-01", None)
    ]
    tree = connection.execute("SELECT when_tree FROM regulation WHERE id = 'la_city-80.14-a'").fetchone()[0]
    assert '["not",["in","road.owner",["state"]]]' in tree
    row = connection.execute("SELECT citation, kinds, least, most, targets, sign, not_on FROM delegation").fetchone()
    assert row == ("CVC 22350", '["city","county"]', "15 mph", "25 mph", '["cvc-22350-a"]', 1, '["state"]')


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_answers(connection: sqlite3.Connection, view: str) -> None:
    assert connection.execute(f"SELECT * FROM {view}").fetchall()


def test_the_paper_s_table_has_its_row(connection: sqlite3.Connection) -> None:
    cursor = connection.execute("SELECT * FROM paper_table")
    assert tuple(item[0] for item in cursor.description) == PAPER_COLUMNS
    row = cursor.fetchall()[1]
    assert row[1] == "Vehicle driven upon a highway at a speed greater than 100 miles per hour."
    assert row[3:] == ("FALSE", "highway", "100 mph", "Car Following; Go Straight; Overtaking", "Car Following; Go Straight; Overtaking")


@pytest.mark.parametrize(
    ("words", "found"),
    [("bicycle truck", {"cvc-22348-b"}), ("schools", {"la_city-80.14-a"}), ("title:posted", {"cvc-22350-a", "cvc-22350-b"}),
     ("citation:80", {"la_city-80.14-a"}), ("zebra", set())],
)  # fmt: skip
def test_full_text_search_finds_words_in_any_form(connection: sqlite3.Connection, words: str, found: set[str]) -> None:
    rows = connection.execute("SELECT id, snippet(regulation_search, 5, '<', '>', '...', 5) FROM regulation_search(?)", (words,)).fetchall()
    assert {row[0] for row in rows} == found


def test_a_database_may_hold_the_law_of_one_day_only(small: Build, tmp_path: Path) -> None:
    path = tmp_path / "1990.sqlite"
    write_database(small, path, read_date("1990-01-01"))
    with closing(sqlite3.connect(path)) as connection:
        assert connection.execute("SELECT id, until FROM regulation ORDER BY key").fetchall() == [
            ("cvc-22348-b", "2005-01-01"), ("cvc-22350-a", None), ("cvc-22350-b", None),
        ]  # fmt: skip
        assert connection.execute("SELECT id FROM section").fetchall() == [("cvc-22348",), ("cvc-22350",)]
        assert connection.execute("SELECT value FROM regdb_meta WHERE key = 'in_force_on'").fetchone() == ("1990-01-01",)
        assert content_hash(connection) == connection.execute("SELECT value FROM regdb_meta WHERE key = 'content_hash'").fetchone()[0]


_WRITE = """
import sys
from pathlib import Path
from regdb_compiler.driver import build
from regdb_compiler.emit.outputs import write_outputs
write_outputs(build(Path(sys.argv[1])), Path(sys.argv[2]), parquet=True)
"""


def test_another_process_with_another_hash_seed_writes_the_same_bytes(small_codes: Path, tmp_path: Path) -> None:
    for seed in ("1", "4242"):
        run = [sys.executable, "-W", "error", "-c", _WRITE, str(small_codes), str(tmp_path / seed)]
        subprocess.run(run, check=True, env={**os.environ, "PYTHONHASHSEED": seed})
    files = sorted(path.name for path in (tmp_path / "1").iterdir())
    assert files == sorted(path.name for path in (tmp_path / "4242").iterdir())
    assert len(files) == 7
    for name in files:
        assert (tmp_path / "1" / name).read_bytes() == (tmp_path / "4242" / name).read_bytes(), name


def test_the_order_in_which_files_are_read_changes_nothing(small: Build, database: Path, tmp_path: Path) -> None:
    corpus = small.corpus
    mixed = random.Random(7)
    facts, sections = list(corpus.vocabulary.facts.values()), list(corpus.sections)
    places, attributes = list(corpus.tree), list(corpus.vocabulary.attributes.values())
    for items in (facts, sections, places, attributes):
        mixed.shuffle(items)
    shuffled = replace(
        corpus, sections=tuple(sections), tree=type(corpus.tree)(places),
        vocabulary=type(corpus.vocabulary)(facts, attributes, corpus.vocabulary.words)
    )
    from regdb_compiler.authority import Authority
    from regdb_compiler.precedence import find_targets
    from regdb_compiler.resolve import resolve

    resolution, targets = resolve(shuffled), find_targets(shuffled)
    again = replace(small, corpus=shuffled, resolution=resolution, targets=targets, authority=Authority(resolution, targets))
    write_database(again, tmp_path / "shuffled.sqlite")
    assert (tmp_path / "shuffled.sqlite").read_bytes() == database.read_bytes()


def test_codes_with_errors_write_nothing_and_hand_back_the_errors(small: Build, tmp_path: Path) -> None:
    wrong = Diagnostic("R401", "unknown-fact", "error", "unknown fact", Place("codes/cvc/1.yaml", 1, 1, 1, 2))
    warning = replace(wrong, level="warning")
    with pytest.raises(RegdbInputError) as caught:
        write_database(replace(small, diagnostics=(warning, wrong)), tmp_path / "out" / "r.sqlite")
    assert caught.value.diagnostics == (wrong,)
    assert not (tmp_path / "out").exists()
    write_database(replace(small, diagnostics=(warning,)), tmp_path / "out" / "r.sqlite")
    assert RegulationDatabase.open(tmp_path / "out" / "r.sqlite").regulations == small.regulations


def test_rows_that_name_what_is_not_there_are_refused(small: Build, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = to_sqlite.collect(small)
    tables["regulation_limit"] = [(99, *line[1:]) for line in tables["regulation_limit"][:1]]
    with pytest.raises(sqlite3.IntegrityError):
        to_sqlite.write_tables(tables, tmp_path / "r.sqlite")
    assert not (tmp_path / "r.sqlite").exists()
    monkeypatch.setattr(to_sqlite, "_open", lambda _: None)  # foreign keys off: the check before the move still sees it
    with pytest.raises(sqlite3.IntegrityError, match="1 rows name what is not there"):
        to_sqlite.write_tables(tables, tmp_path / "r.sqlite")


@pytest.mark.parametrize("broken", ["fsync", "replace", "write"])
def test_a_failure_at_any_step_leaves_the_old_file_and_nothing_beside(
    small: Build, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    path = tmp_path / "r.sqlite"
    write_database(small, path)
    before = path.read_bytes()

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    target = {"fsync": (os, "fsync"), "replace": (Path, "replace"), "write": (to_sqlite, "content_hash")}[broken]
    monkeypatch.setattr(*target, fail)
    with pytest.raises(OSError, match="No space left"):
        write_database(small, path, read_date("1990-01-01"))
    assert path.read_bytes() == before
    assert [item.name for item in tmp_path.iterdir()] == ["r.sqlite"]


_REWRITE = """
import sys
from pathlib import Path
from regdb_compiler.driver import build
from regdb_compiler.emit.to_sqlite import write_database
found, path = build(Path(sys.argv[1])), Path(sys.argv[2])
print("ready", flush=True)
while True:
    write_database(found, path)
    write_database(found, path, 726468)
"""


def test_a_process_killed_while_writing_leaves_a_whole_file(small: Build, small_codes: Path, tmp_path: Path) -> None:
    path = tmp_path / "r.sqlite"
    write_database(small, path)
    chance = random.Random(3)
    for _ in range(4):
        process = subprocess.Popen([sys.executable, "-c", _REWRITE, str(small_codes), str(path)], stdout=subprocess.PIPE)
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        time.sleep(chance.uniform(0.0, 0.15))
        process.send_signal(signal.SIGKILL)
        process.wait()
        process.stdout.close()
        assert len(RegulationDatabase.open(path)) in {3, 5}
    for left in tmp_path.glob(".regdb-*"):
        os.utime(left, (0, 0))
    write_database(small, path)
    assert [item.name for item in tmp_path.iterdir()] == ["r.sqlite"]


def test_ten_thousand_regulations_are_written_in_about_a_second(small: Build, tmp_path: Path) -> None:
    tables = to_sqlite.collect(small)
    model, targets = tables["regulation"][2], tables["regulation_target"]
    states = [line[2] for line in tables["regulation_state"] if line[:2] == (2, "next")]
    tables["regulation"] = [(key, f"cvc-22350-{key}", *model[2:]) for key in range(1, 10_001)]
    tables["regulation_limit"] = [(key, *tables["regulation_limit"][2][1:]) for key in range(1, 10_001)]
    tables["regulation_state"] = [(key, "next", state) for key in range(1, 10_001) for state in states]
    tables["regulation_target"] = [(key, *targets[0][1:]) for key in range(1, 10_001)]
    started = time.process_time()
    to_sqlite.write_tables(tables, tmp_path / "many.sqlite")
    assert time.process_time() - started < 3.0  # 0.6 s on an idle machine; bench/ holds the mark


def test_the_shipped_codes_round_trip(codes: Path, tmp_path: Path) -> None:
    found = build(codes)
    sound = replace(found, diagnostics=())  # errors in one section are another test's matter; the rows of the rest are whole
    write_database(sound, tmp_path / "r.sqlite")
    assert RegulationDatabase.open(tmp_path / "r.sqlite").regulations == found.regulations
