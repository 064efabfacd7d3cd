"""The CSV files: the paper's table in its order, every value back as it was, the metadata that says so."""

import csv
import io
import json
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from hashlib import sha256
from pathlib import Path

import pytest
from regdb_compiler.driver import Build
from regdb_compiler.emit.outputs import DATABASE, write_outputs
from regdb_compiler.emit.table import COLUMNS, read_lines

from regdb.schema import PAPER_COLUMNS


@pytest.fixture(scope="module")
def folder(small: Build, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_outputs(small, tmp_path_factory.mktemp("out")).folder


@pytest.fixture
def connection(folder: Path) -> Iterator[sqlite3.Connection]:
    with closing(sqlite3.connect(folder / DATABASE)) as found:
        yield found


def _rows(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file, strict=True))


def test_the_paper_s_columns_stand_in_the_paper_s_order(folder: Path, connection: sqlite3.Connection) -> None:
    head, *rows = _rows(folder / "paper.csv")
    assert tuple(head) == PAPER_COLUMNS
    assert [tuple(row) for row in rows] == connection.execute("SELECT * FROM paper_table").fetchall()
    assert rows[1][1:] == [
        "Vehicle driven upon a highway at a speed greater than 100 miles per hour.", "is guilty of an infraction", "FALSE", "highway",
        "100 mph", "Car Following; Go Straight; Overtaking", "Car Following; Go Straight; Overtaking",
    ]  # fmt: skip
    assert rows[3][3] == "TRUE"


def test_lines_end_as_rfc_4180_says_and_texts_keep_their_own_breaks(folder: Path) -> None:
    data = (folder / "paper.csv").read_bytes()
    assert data.startswith(b"Code Text,Condition,")
    assert b'=beyond, and\nbicycles, ""buses"" and trucks count too.\n",Vehicle driven' in data
    assert data.count(b"\r\n") == 6
    assert not data.startswith(b"\xef\xbb\xbf")


def test_a_cell_that_looks_like_a_formula_stays_the_exact_text(tmp_path: Path) -> None:
    from regdb_compiler.emit import to_csv

    texts = ["=1+1", "+a", "-b", "@c", "\td", 'e"\r\n,', " f ", "NULL", "None", "é§"]
    to_csv._write(tmp_path / "x.csv", ["a", "b"], [(text, text) for text in texts])
    assert _rows(tmp_path / "x.csv")[1:] == [[text, text] for text in texts]


def test_the_full_table_reads_back_the_same(folder: Path, connection: sqlite3.Connection) -> None:
    head, *rows = _rows(folder / "regulations.csv")
    assert head == [column.name for column in COLUMNS]
    written = read_lines(connection)
    assert len(rows) == len(written) == 5
    for row, line in zip(rows, written, strict=True):
        for text, value, column in zip(row, line, COLUMNS, strict=True):
            back = {"boolean": lambda t: int(t == "TRUE"), "integer": int, "date": lambda t: t or None}.get(column.kind, str)(text)
            assert back == value, column.name


def test_pandas_reads_the_same_values(folder: Path, connection: sqlite3.Connection) -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.read_csv(folder / "paper.csv", dtype=str, keep_default_na=False)
    assert tuple(frame.columns) == PAPER_COLUMNS
    assert [tuple(row) for row in frame.itertuples(index=False)] == connection.execute("SELECT * FROM paper_table").fetchall()


def test_states_of_the_paper_s_table_are_words_the_machine_reads(small: Build, folder: Path) -> None:
    for row in _rows(folder / "paper.csv")[1:]:
        for cell in row[6:]:
            for word in filter(None, cell.split("; ")):
                assert small.corpus.machine.expand(word)


def test_limits_stand_in_the_law_s_unit_and_in_si(folder: Path) -> None:
    rows = list(csv.DictReader(io.StringIO((folder / "regulations.csv").read_text("utf-8"), newline="")))
    assert json.loads(rows[0]["limits"]) == [
        {"attribute": "max_speed", "fact": "plan.speed", "direction": "max", "value": 100.0, "unit": "mph", "si": 44.704, "text": "100 mph"}
    ]
    assert json.loads(rows[2]["limits"])[0]["si"] is None
    assert json.loads(rows[4]["overrides"]) == ["cvc-22350-a"]
    assert json.loads(rows[3]["next_state_ids"]) == ["lane_following.car_following"]


def test_the_metadata_describes_both_files(folder: Path) -> None:
    package = json.loads((folder / "datapackage.json").read_text("utf-8"))
    assert package["licenses"] == [{"name": "Apache-2.0"}]
    assert "Not legal advice" in package["description"]
    for resource in package["resources"]:
        data = (folder / resource["path"]).read_bytes()
        assert resource["bytes"] == len(data)
        assert resource["hash"] == f"sha256:{sha256(data).hexdigest()}"
        assert [field["name"] for field in resource["schema"]["fields"]] == _rows(folder / resource["path"])[0]
        assert all(field["description"] for field in resource["schema"]["fields"])
    legality = package["resources"][0]["schema"]["fields"][3]
    assert (legality["type"], legality["trueValues"], legality["falseValues"]) == ("boolean", ["TRUE"], ["FALSE"])
