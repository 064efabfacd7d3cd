"""`regdb text` as typed: attach from files, folders and a local server; list, show, check, accept, forget."""

import http.server
import json
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from regdb_compiler.official.fetching import fetch
from regdb_compiler.official.passage import UnreadableTextError

from regdb.cli import main

PAGES = Path(__file__).parent / "official_pages"
PAGE = '<div id="codeLawSectionNoHead"><h6>22350.</h6><p>{}</p><i>(Enacted by Stats. 1959, Ch. 3.)</i></div>'


@pytest.fixture
def codes(tmp_path: Path, small_codes: Path) -> Path:
    return Path(shutil.copytree(small_codes, tmp_path / "codes"))


@pytest.fixture
def text(codes: Path, capsys: pytest.CaptureFixture[str]) -> Any:
    def run(*arguments: str, code: int = 0) -> str:
        with pytest.raises(SystemExit) as caught:
            main(["text", *arguments, "--codes", str(codes)])
        captured = capsys.readouterr()
        assert caught.value.code == code, captured
        return captured.out if code < 2 else captured.err

    return run


@pytest.fixture
def page(tmp_path: Path) -> Any:
    def write(words: str, name: str = "page.html") -> str:
        (tmp_path / name).write_text(PAGE.format(words))
        return str(tmp_path / name)

    return write


@pytest.fixture
def server(tmp_path: Path) -> Iterator[str]:
    """A site on this machine: its pages, one that is too large, one that moves elsewhere."""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "displaySection.xhtml").write_text(PAGE.format("(a) Lorem from afar."))
    (tmp_path / "site" / "large.html").write_bytes(b"x" * 5000)

    class Handler(http.server.SimpleHTTPRequestHandler):
        def __init__(self, *arguments: Any, **named: Any) -> None:
            super().__init__(*arguments, directory=str(tmp_path / "site"), **named)

        def do_GET(self) -> None:
            if self.path == "/moved":
                self.send_response(302)
                self.send_header("Location", "file:///etc/hostname")
                self.end_headers()
            else:
                super().do_GET()

        def log_message(self, *_: Any) -> None:
            return

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as found:
        thread = threading.Thread(target=found.serve_forever, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{found.server_port}"
        found.shutdown()
        thread.join()


def test_a_file_is_attached_listed_and_shown(text: Any, page: Any, codes: Path) -> None:
    out = text("attach", page("(a) Lorem ipsum."))
    assert "cvc-22350            undated        leginfo   new" in out
    assert "1 text in " in out
    assert "(today)" in out
    assert (codes.parent / "texts" / "cvc" / "22350.txt").read_text() == "(a) Lorem ipsum.\n"
    assert "cvc-22350            undated     attached " in text("list")
    shown = text("show", "CVC", "22350")
    assert "    (a) Lorem ipsum.\n" in shown
    assert "(Enacted by Stats. 1959, Ch. 3.)" in shown
    assert text("show", "cvc-22350") == text("show", "CVC 22350(a)") == text("show", "22350") == shown


def test_the_index_says_where_when_and_what(text: Any, page: Any) -> None:
    source = page("(a) Lorem ipsum.")
    told = json.loads(text("attach", source, "--on", "2026-03-02", "--format", "json"))
    assert told["attached"] == [{"id": "cvc-22350", "version": "", "format": "leginfo", "source": source, "news": "new"}]
    item = json.loads((Path(told["folder"]) / "index.json").read_text())["texts"][0]
    assert (item["attached"], item["source"], item["format"], item["section"]) == ("2026-03-02", source, "leginfo", "22350")
    assert len(item["sha256"]) == len(item["source_sha256"]) == 64
    listed = json.loads(text("list", "--format", "json"))["texts"]
    assert [(entry["state"], entry["annotated"]) for entry in listed] == [("attached", True)]


def test_attaching_again_says_what_is_new(text: Any, page: Any) -> None:
    text("attach", page("(a) Lorem ipsum."))
    assert "1 same" in text("attach", page("(a)  Lorem  ipsum."))
    assert "1 changed" in text("attach", page("(a) Lorem dolor."))


def test_a_page_from_a_server(text: Any, server: str) -> None:
    text("attach", f"{server}/displaySection.xhtml?lawCode=VEH&sectionNum=22350")
    item = json.loads(text("show", "22350", "--format", "json"))["texts"][0]
    assert item["text"] == "(a) Lorem from afar.\n"
    assert item["source"] == f"{server}/displaySection.xhtml?lawCode=VEH&sectionNum=22350"


def test_what_a_server_refuses_is_said(text: Any, server: str) -> None:
    assert "answers 404" in text("attach", f"{server}/none.html", code=2)
    with pytest.raises(UnreadableTextError, match="larger than"):
        fetch(f"{server}/large.html", most=1000)
    with pytest.raises(UnreadableTextError, match="answers 302"):
        fetch(f"{server}/moved")
    with pytest.raises(UnreadableTextError, match="cannot be reached"):
        fetch("http://127.0.0.1:9/x", seconds=2)
    with pytest.raises(UnreadableTextError, match="no http address"):
        fetch("file:///etc/hostname")


def test_a_folder_of_pages(text: Any, page: Any, tmp_path: Path) -> None:
    (tmp_path / "pages").mkdir()
    page("(a) Lorem.", "pages/one.html")
    (tmp_path / "pages" / "22348.txt").write_text("(b) Ipsum.\n")
    assert "2 texts in " in text("attach", str(tmp_path / "pages"), "--code", "CVC")


def test_the_code_is_asked_for_when_it_cannot_be_told(text: Any, codes: Path) -> None:
    assert "name the code with `--code`" in " ".join(text("attach", str(PAGES / "leginfo_section.html"), code=2).split())
    assert "there is no code 'xyz'" in text("attach", str(PAGES / "leginfo_section.html"), "--code", "xyz", code=2)
    assert "new" in text("attach", str(PAGES / "leginfo_text.html"), "--code", "cvc")
    assert (codes.parent / "texts" / "cvc" / "90210@2031-01-01.txt").exists()


def test_quotes_are_checked_against_the_text(text: Any, page: Any, codes: Path) -> None:
    quotes = [line.partition("quote:")[2].strip(" '\"}") for line in (codes / "cvc" / "22350.yaml").read_text().splitlines() if " quote:" in line]
    text("attach", page(" and ".join(quotes) or "x"))
    assert "1 attached texts" in text("check")
    text("attach", page("No such words."))
    assert "R204" in text("check", "CVC 22350", code=1) or not quotes
    report = json.loads(text("check", "--format", "json", code=1 if quotes else 0))
    assert [item["section"] for item in report["texts"]] == ["22350"]


def test_a_text_that_changed_after_it_was_accepted_is_reported(text: Any, page: Any, codes: Path) -> None:
    quoted = (codes / "cvc" / "22350.yaml").read_text()
    words = " ".join(line.partition("quote:")[2].strip(" '\"}") for line in quoted.splitlines() if " quote:" in line)
    text("attach", page(f"(a) {words} Lorem ipsum."))
    assert "accepted on 2026-03-02: cvc-22350" in text("accept", "22350", "--on", "2026-03-02")
    assert "accepted" in text("list")
    text("check")
    text("attach", page(f"(a) {words} Lorem dolor."))
    out = text("check", code=1)
    assert "R210" in out
    assert "Lorem ipsum." in out
    text("accept", "--all")
    assert "R210" not in text("check")


def test_forgetting_removes_the_files(text: Any, page: Any, codes: Path) -> None:
    text("attach", page("(a) Lorem."))
    text("accept", "22350")
    assert "forgotten: cvc-22350" in text("forget", "CVC", "22350")
    assert sorted(item.name for item in (codes.parent / "texts").rglob("*") if item.is_file()) == ["index.json"]
    assert "no text of 22350 is attached" in " ".join(text("show", "22350", code=2).split())


def test_an_altered_or_lost_copy_is_found(text: Any, page: Any, codes: Path) -> None:
    text("attach", page("(a) Lorem."))
    file = codes.parent / "texts" / "cvc" / "22350.txt"
    file.write_text("(a) Ipsum.")
    assert "was altered" in text("check", code=1)
    file.unlink()
    assert "cannot be read" in " ".join(text("check", code=2).split())


def test_a_broken_index_is_said_in_one_sentence(text: Any, page: Any, codes: Path) -> None:
    text("attach", page("(a) Lorem."))
    (codes.parent / "texts" / "index.json").write_text("[]")
    assert "cannot be read" in text("list", code=2)
    with pytest.raises(SystemExit) as caught:
        main(["lint", "--codes", str(codes), "--select", "R204"])
    assert caught.value.code == 2


def test_an_index_that_names_files_elsewhere_is_refused(text: Any, page: Any, codes: Path) -> None:
    text("attach", page("(a) Lorem."))
    index = codes.parent / "texts" / "index.json"
    index.write_text(index.read_text().replace("cvc/22350.txt", "../codes/states.yaml"))
    assert "lies outside" in " ".join(text("forget", "22350", code=2).split())
    assert (codes / "states.yaml").exists()


@pytest.mark.parametrize("arguments", [["attach"], ["show"], ["accept"], ["attach", "none.html"], ["sing"], ["show", "nothing"]])
def test_usage_errors(text: Any, arguments: list[str]) -> None:
    assert text(*arguments, code=2)


def test_another_folder(text: Any, page: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text("attach", page("(a) Lorem."), "--texts", str(tmp_path / "mine"))
    assert "0 texts" in text("list")
    monkeypatch.setenv("REGDB_TEXTS", str(tmp_path / "mine"))
    assert "1 text in" in text("list")
