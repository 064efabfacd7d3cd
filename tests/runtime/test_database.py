"""Opening a database: what it holds, and one clear sentence for every file that is none."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.errors import DatabaseDamaged, DatabaseError, NotADatabase, RegdbRuntimeError, RequestError, VersionRefused

from regdb.condition import Is
from regdb.content_hash import content_hash
from regdb.regulation import Regulation


@pytest.fixture
def law(random_law: Callable[[int], Any]) -> Any:
    return random_law(7)


@pytest.fixture
def file(tmp_path: Path, law: Any, write_law: Callable[..., Path]) -> Path:
    return write_law(tmp_path / "odd name #1?%20.sqlite", law, law.rules(40))


def altered(file: Path, *statements: str) -> Path:
    connection = sqlite3.connect(file)
    for statement in statements:
        connection.execute(statement)
    connection.commit()
    connection.close()
    return file


def sealed(file: Path, *statements: str) -> Path:
    """Altered, and the hash made to fit, as a faulty compiler would leave it."""
    altered(file, *statements)
    connection = sqlite3.connect(file)
    digest = content_hash(connection)
    connection.close()
    return altered(file, f"UPDATE regdb_meta SET value = '{digest}' WHERE key = 'content_hash'")


def test_everything_written_is_read_back(tmp_path: Path, law: Any, write_law: Callable[..., Path]) -> None:
    rules = law.rules(60)
    database = RegulationDatabase.open(write_law(tmp_path / "law.sqlite", law, rules))
    assert list(database.regulations) == rules
    assert [fact.name for fact in database.vocabulary] == sorted(law.vocabulary.facts)
    assert database.vocabulary.facts["b3"].assumption == law.vocabulary.facts["b3"].assumption or database.vocabulary.facts["b3"].assumption
    assert database.machine.states == law.machine.states
    assert [item.id for item in database.tree.path("city")] == ["model", "state", "city"]
    assert database.vocabulary.attributes == law.vocabulary.attributes
    assert len(database) == 60
    assert len(database.hash) == 64


def test_the_section_behind_a_regulation_is_read_on_demand(file: Path) -> None:
    database = RegulationDatabase.open(file)
    found = database.section_text(database.regulations[0])
    assert (found.citation, found.text) == ("SC 1", "The words of the law.")
    with pytest.raises(DatabaseError, match="has no text for nothing"):
        database.section_text(Regulation("nothing", "", "state", legality=False))


def test_the_hash_does_not_depend_on_the_layout_of_the_file(file: Path) -> None:
    before = RegulationDatabase.open(file).hash
    altered(file, "CREATE INDEX extra ON regulation (title)")
    vacuumed = altered(file, "DROP INDEX extra")
    connection = sqlite3.connect(vacuumed)
    connection.execute("VACUUM")
    connection.close()
    assert RegulationDatabase.open(file).hash == before


def test_opening_leaves_no_trace(file: Path) -> None:
    before = file.read_bytes()
    RegulationDatabase.open(file)
    assert file.read_bytes() == before
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"", "is empty"), (b"Code Text,Condition\n", "is not a SQLite file"), (b"SQLite format 3\x00", "is damaged")],
)
def test_what_is_no_database(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "x.sqlite"
    path.write_bytes(content)
    with pytest.raises(DatabaseError, match=said):
        RegulationDatabase.open(path)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(NotADatabase, match="cannot be read: No such file"):
        RegulationDatabase.open(tmp_path / "none.sqlite")
    with pytest.raises(NotADatabase, match="cannot be read: Is a directory"):
        RegulationDatabase.open(tmp_path)


def test_somebody_elses_sqlite(file: Path) -> None:
    with pytest.raises(NotADatabase, match="not a regulation database"):
        RegulationDatabase.open(altered(file, "PRAGMA application_id = 1"))


@pytest.mark.parametrize(("version", "remedy"), [(2000, "update regdb"), (7, "compile it again")])
def test_another_major_version_is_refused_with_one_sentence(file: Path, version: int, remedy: str) -> None:
    with pytest.raises(VersionRefused, match=remedy) as caught:
        RegulationDatabase.open(altered(file, f"PRAGMA user_version = {version}"))
    assert "\n" not in str(caught.value)


def test_another_minor_version_is_read(file: Path) -> None:
    assert len(RegulationDatabase.open(altered(file, "PRAGMA user_version = 1007"))) == 40


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE regulation SET legality = 1 - legality WHERE key = 3",
        "UPDATE regulation SET quote = 'x' WHERE key = 1",
        "UPDATE section_version SET text = 'Other words.'",
        "DELETE FROM regulation_state WHERE rowid = 1",
        "UPDATE regdb_meta SET value = 'abc' WHERE key = 'content_hash'",
        "INSERT INTO regdb_meta VALUES ('notice', 'legal advice')",
        "DELETE FROM regdb_meta",
        "UPDATE regulation SET title = 'a' || char(0) || 'b' WHERE key = 1",
    ],
)
def test_altered_content_is_found(file: Path, statement: str) -> None:
    with pytest.raises(DatabaseDamaged, match="altered since it was compiled"):
        RegulationDatabase.open(altered(file, statement))


@pytest.mark.parametrize("keep", [100, 5000, 20000])
def test_a_truncated_file_is_found(file: Path, keep: int) -> None:
    file.write_bytes(file.read_bytes()[:keep])
    with pytest.raises(DatabaseDamaged):
        RegulationDatabase.open(file)


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("UPDATE regulation SET when_tree = '[\"is\", \"no.such\"]' WHERE key = 2", "the fact 'no.such', which the vocabulary"),
        ("UPDATE regulation SET when_tree = '[\"and\", [\"frobs\", 1]]' WHERE key = 2", "no condition tree"),
        ("UPDATE regulation SET when_tree = '7' WHERE key = 2", "no condition tree"),
        ("UPDATE regulation SET when_tree = '[\"is\"' WHERE key = 2", "is not JSON"),
        ("UPDATE regulation SET when_tree = '[\"cmp\", \"~\", [0, []], [0, []], \"quantity\", \"\"]' WHERE key = 2", "no condition tree"),
        ("UPDATE regulation_limit SET bound = '[]'", "no linear expression"),
        ("UPDATE regulation SET effective = 'soon' WHERE key = 2", "'soon' is no date"),
        ("UPDATE fact SET kind = 'mood' WHERE name = 'b0'", "of a kind 'mood'"),
        ("UPDATE fact SET assumed = '3' WHERE name = 'b3'", "cannot stand for the fact 'b3'"),
        ("UPDATE jurisdiction SET parent = 'nowhere' WHERE id = 'city'", "names a parent 'nowhere'"),
        ("DELETE FROM state", "has no states"),
        ("UPDATE state SET aliases = 'x' WHERE position = 0", "is damaged"),
    ],
)
def test_rows_that_mean_nothing_fail_at_the_depot(file: Path, statement: str, said: str) -> None:
    with pytest.raises(DatabaseDamaged, match=said):
        RegulationDatabase.open(sealed(file, "PRAGMA foreign_keys = OFF", statement))


def test_a_missing_table_is_found(file: Path) -> None:
    with pytest.raises(DatabaseDamaged, match="no such table: delegation"):
        RegulationDatabase.open(altered(file, "DROP TABLE delegation"))


def rule(name: str, *targets: str, **more: Any) -> Regulation:
    return Regulation(name, name, "state", legality=bool(targets), when=Is("b0"), targets=targets, **more)


def test_a_circle_of_defeat_is_refused(law: Any) -> None:
    rules = [rule("a", "c"), rule("b", "a"), rule("c", "b")]
    with pytest.raises(DatabaseDamaged, match="in a circle"):
        RegulationDatabase(law.vocabulary, law.machine, law.tree, rules)
    with pytest.raises(DatabaseDamaged, match="in a circle"):
        RegulationDatabase(law.vocabulary, law.machine, law.tree, [rule("a", "a")])


def test_versions_of_different_times_make_no_circle(law: Any) -> None:
    rules = [rule("a", "b", until=10), rule("b", until=10), rule("a", effective=10), rule("b", "a", effective=10)]
    assert len(RegulationDatabase(law.vocabulary, law.machine, law.tree, rules)) == 4


def test_a_very_long_chain_is_no_error(law: Any) -> None:
    rules = [rule("r0"), *(rule(f"r{i}", f"r{i - 1}") for i in range(1, 3000))]
    assert len(RegulationDatabase(law.vocabulary, law.machine, law.tree, rules)) == 3000


def test_a_replaced_file_is_reopened_and_the_old_one_stays_whole(file: Path, law: Any, write_law: Callable[..., Path]) -> None:
    database = RegulationDatabase.open(file)
    assert database.reopen_if_changed() is database
    fresh = write_law(file.with_suffix(".new"), law, law.rules(5))
    shutil.move(fresh, file)
    again = database.reopen_if_changed()
    assert (len(database), len(again)) == (40, 5)
    with pytest.raises(DatabaseError, match="has been replaced"):
        database.section_text(database.regulations[0])


def test_every_error_is_one_of_ours(file: Path) -> None:
    database = RegulationDatabase.open(file)
    with pytest.raises(RequestError, match="unknown jurisdiction 'atlantis'; known: "):
        database.at("atlantis", "2026-03-02")
    with pytest.raises(RegdbRuntimeError, match="'2026-3-2' is no date"):
        database.at("state", "2026-3-2")
