"""Official text from every form it comes in: pages of three sites, plain text, two XML dialects; and what is refused."""

from pathlib import Path

import pytest
from regdb_compiler.official.from_xml import read_xml
from regdb_compiler.official.passage import Passage, UnreadableTextError, version_said
from regdb_compiler.official.reading import read_bytes, read_source_text, sources_in

PAGES = Path(__file__).parent / "official_pages"


def read(name: str) -> tuple[str, dict[str, Passage]]:
    form, found = read_bytes((PAGES / name).read_bytes(), Path(name).stem)
    return form, {item.section: item for item in found}


def test_a_section_page_of_the_states_site() -> None:
    form, found = read("leginfo_section.html")
    assert (form, list(found)) == ("leginfo", ["90210"])
    item = found["90210"]
    assert item.text == "(a) A driver shall lorem the “ipsum” at once.\n(b) (1) Except as provided in Section 90211, dolor."
    assert item.version == "2023-01-01"
    assert item.note.startswith("(Amended by Stats. 2022, Ch. 957")


def test_a_page_with_many_sections_has_both_texts_of_one_number() -> None:
    form, found = read_bytes((PAGES / "leginfo_text.html").read_bytes())
    assert form == "leginfo"
    assert [(item.section, item.version, item.text) for item in found] == [
        ("90210", "", "(a) First lorem."), ("90210", "2031-01-01", "(a) Second lorem."), ("90210.5", "", "Third lorem."),
        ("90211", "", "Fourth lorem."),
    ]  # fmt: skip


def test_a_page_of_american_legal() -> None:
    form, found = read("amlegal.html")
    assert (form, list(found)) == ("amlegal", ["80.99", "81.01"])
    assert found["80.99"].heading == "LOREM \u2013 IPSUM."
    assert found["80.99"].text == "(a) No person shall lorem.\n(b) Ipsum within 15 feet."
    assert found["80.99"].version == "2001-03-05"


def test_a_page_of_municode() -> None:
    form, found = read("municode.html")
    assert (form, list(found)) == ("municode", ["15.99.010", "15.99.020"])
    assert found["15.99.010"].heading == "Lorem."
    assert found["15.99.010"].text == "A person shall not lorem:\nA. Ipsum of fifteen feet;\n1. Dolor."
    assert found["15.99.010"].note.startswith("(Ord. 9999")


def test_any_other_page_by_its_numbers() -> None:
    form, found = read_bytes(b"<div><p>90210. (a) Lorem.</p><p>(b) Ipsum.</p></div>")
    assert form == "html"
    assert [(item.section, item.heading, item.text) for item in found] == [("90210", "(a) Lorem.", "(b) Ipsum.")]


def test_plain_text_with_many_sections() -> None:
    form, found = read("many.txt")
    assert (form, list(found)) == ("plain", ["90210", "90210.5", "90211", "80.99"])
    assert found["90210"].text == "(a) A driver shall lorem\nwithin 100 feet.\n1. Not a section but an item."
    assert found["90210"].version == "2000-01-01"
    assert found["80.99"].text == "LOREM.\n(b) Ipsum."


def test_plain_text_named_after_its_section() -> None:
    assert read_bytes(b"A driver shall lorem.", "21453") == ("plain", (Passage("21453", "", "A driver shall lorem."),))
    assert read_bytes(b"A driver shall lorem.", "notes") == ("plain", ())


def test_uslm() -> None:
    form, found = read("uslm.xml")
    assert (form, list(found)) == ("uslm", ["901"])
    assert found["901"].heading == "Lorem ipsum"
    assert found["901"].text == "(a) In General.—A driver shall lorem at once.\n(b) Dolor—\n(1) sit; and"
    assert "113 Stat. 1" not in found["901"].text


def test_akoma_ntoso_with_the_date_of_its_expression() -> None:
    form, found = read("akn.xml")
    assert form == "akn"
    assert (found["90210"].text, found["90210"].version) == ("(a) A driver shall lorem.\n(b) Ipsum.", "2024-07-01")


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>',
        '<?xml version="1.0"?><!DOCTYPE a SYSTEM "http://127.0.0.1/x.dtd"><a/>',
        '<!DOCTYPE a [<!ENTITY l0 "ha"><!ENTITY l1 "&l0;&l0;&l0;&l0;&l0;&l0;&l0;">]><a>&l1;</a>',
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_document_type_is_refused(text: str, encoding: str) -> None:
    with pytest.raises(UnreadableTextError, match="document type"):
        read_xml(text.encode(encoding))


def test_broken_xml_is_refused() -> None:
    with pytest.raises(UnreadableTextError, match="well-formed"):
        read_xml(b"<section><num>5</num>")


@pytest.mark.parametrize(
    ("note", "said"),
    [
        ("(Added by Stats. 1999. Effective January 1, 2000.)", "2000-01-01"),
        ("Effective January 1, 2026. Section operative January 1, 2031, by its own provisions.", "2031-01-01"),
        ("(Amended by Ord. No. 1, Eff. 12/10/68; Ord. No. 2, Eff. 3/5/01.)", "2001-03-05"),
        ("(Enacted by Stats. 1959, Ch. 3.)", ""),
        ("Effective February 30, 2020.", ""),
    ],
)
def test_the_day_that_a_history_note_says(note: str, said: str) -> None:
    assert version_said(note) == said


def test_folders_are_read_in_order_without_hidden_files(tmp_path: Path) -> None:
    for name in ("b.html", "a.txt", ".hidden.txt", "c.pdf"):
        (tmp_path / name).write_text("x")
    assert sources_in(str(tmp_path)) == (str(tmp_path / "a.txt"), str(tmp_path / "b.html"))


def test_what_is_not_there_or_holds_nothing_is_said(tmp_path: Path) -> None:
    with pytest.raises(UnreadableTextError, match="no file, no folder"):
        sources_in(str(tmp_path / "none.html"))
    (tmp_path / "empty").mkdir()
    with pytest.raises(UnreadableTextError, match="holds no file"):
        sources_in(str(tmp_path / "empty"))
    (tmp_path / "x.html").write_text("<html><body><p>Nothing here.</p></body></html>")
    with pytest.raises(UnreadableTextError, match="no section begins in it"):
        read_source_text(str(tmp_path / "x.html"))


def test_pages_in_old_encodings_and_broken_html_are_read() -> None:
    _, found = read_bytes("<html><head><body><h6>90210.</h6><p>caf\xe9 <b>lorem</div></div></p><p>§ ipsum".encode("cp1252"))
    assert [item.text for item in found] == ["café lorem\n§ ipsum"]
    _, found = read_bytes(b'<div id="manylawsections"><h6>90210.</h6><p>caf\xe9 <b>lorem</i></p></div></div>')
    assert [item.text for item in found] == ["café lorem"]
