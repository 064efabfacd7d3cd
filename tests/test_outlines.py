"""The ledger of the shipped codes: everything is listed, and nothing is silent."""

from pathlib import Path

import pytest
from regdb_compiler.driver import build
from regdb_compiler.ledger import Account, CodeLedger, ledgers


@pytest.fixture(scope="module")
def found(codes: Path) -> tuple[CodeLedger, ...]:
    return ledgers(build(codes, added=()).corpus)


@pytest.fixture(scope="module")
def accounts(found: tuple[CodeLedger, ...]) -> tuple[Account, ...]:
    return tuple(item for code in found for item in code.accounts)


def test_every_code_has_an_outline(found: tuple[CodeLedger, ...]) -> None:
    assert [item.jurisdiction.code for item in found if item.outline is None] == []
    assert len(found) == 4


def test_every_section_is_listed_once_and_accounted_for(accounts: tuple[Account, ...]) -> None:
    assert [f"{item.jurisdiction.short} {item.section}" for item in accounts if not item.listed] == []
    assert [f"{item.jurisdiction.short} {item.section}" for item in accounts if item.status == "unaccounted"] == []
    names = [(item.jurisdiction.id, item.section) for item in accounts]
    assert len(names) == len(set(names))


def test_whatever_is_not_encoded_says_why(accounts: tuple[Account, ...]) -> None:
    assert [item.section for item in accounts if item.status != "encoded" and not item.why] == []


def test_headings_are_short_and_our_own(accounts: tuple[Account, ...]) -> None:
    assert [item.heading for item in accounts if len(item.heading.split()) > 10] == []


def test_no_subdivision_is_silent(accounts: tuple[Account, ...]) -> None:
    assert [f"{item.jurisdiction.short} {item.section}: {item.why}" for item in accounts if "neither cited nor omitted" in item.why] == []
