"""Declared fusion: classes, what a fact changes of them, and what does not fit together."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from regdb_compiler.read_corpus import read_corpus

from regdb.fusion_policy import Permissive, Reach
from regdb.vocabulary import Vocabulary

CLASS = "ages:\n  moving: {meaning: What moves., sources: [perception], holds: 2 s, fresh: [1 s, 30 m], within: 3 s, apart: 0.1 s}\n"


def read(tmp_path: Path, facts: str, head: str = CLASS) -> tuple[Vocabulary, list[str]]:
    """The vocabulary of a folder with these facts, and what is wrong with their fusion."""
    (tmp_path / "codes" / "vocabulary").mkdir(parents=True)
    (tmp_path / "codes" / "vocabulary" / "facts.yaml").write_text(f"{head}facts:\n{facts}", "utf-8")
    corpus = read_corpus(tmp_path / "codes", added=())
    return corpus.vocabulary, [item.message for item in corpus.diagnostics if item.code == "R413"]


def fact(name: str = "light.on", kind: str = "boolean", source: str = "perception", **more: str) -> str:
    fields = "".join(f", {key}: {value}" for key, value in more.items())
    return f"  {name}: {{type: {kind}, source: {source}, meaning: A fact.{fields}}}\n"


def test_a_fact_has_what_its_class_says_and_changes_what_it_names(tmp_path: Path) -> None:
    found, wrong = read(tmp_path, fact() + fact("b.c", fusion="{holds: [5 s, 20 m], confirm: 3, permissive: 'true', corroborate: [map]}"))
    assert wrong == []
    plain, own = found.fact("light.on").fusion, found.fact("b.c").fusion
    assert plain is not None
    assert own is not None
    assert (plain.ages, plain.holds, plain.fresh) == ("moving", Reach(2.0, math.inf), Reach(1.0, 30.0))
    assert (plain.confirmations, plain.within, plain.apart, plain.permissive) == (2, 3.0, 0.1, Permissive((False,)))
    assert (own.holds, own.confirmations, own.permissive, own.corroboration) == (Reach(5.0, 20.0), 3, Permissive((True,)), ("map",))
    assert own.fresh == plain.fresh


def test_numbers_permit_beyond_a_bound_and_words_by_name(tmp_path: Path) -> None:
    text = fact("p.speed", "quantity", unit="mph", fusion="{permissive: '> 25 mph', plausible: {min: 5 mph, max: 85 mph, step: 5 mph}}")
    text += fact("s.color", "enumeration", values="[none, red, green]", fusion="{permissive: [none, green]}")
    found, wrong = read(tmp_path, text)
    assert wrong == []
    speed, color = found.fact("p.speed").fusion, found.fact("s.color").fusion
    assert speed is not None
    assert color is not None
    assert (26 * 0.44704 in speed.permissive, 25 * 0.44704 in speed.permissive) == (True, False)
    assert (speed.least, speed.step) == (5 * 0.44704, 5 * 0.44704)
    assert ("green" in color.permissive, "red" in color.permissive) == (True, False)


def test_who_has_one_teller_or_no_class_is_not_fused(tmp_path: Path) -> None:
    found, wrong = read(tmp_path, fact("ego.x", source="ego") + fact("map.x", source="map"))
    assert wrong == []
    assert (found.fact("ego.x").fusion, found.fact("map.x").fusion) == (None, None)


def test_a_file_names_the_class_of_its_facts_of_perception(tmp_path: Path) -> None:
    head = CLASS + "  still: {meaning: What stands., holds: 80 m}\nfusion: still\n"
    found, wrong = read(tmp_path, fact("a.b") + fact("a.c", fusion="moving") + fact("a.d", source="map"), head)
    assert wrong == []
    assert [found.fact(name).fusion and found.fact(name).fusion.ages for name in ("a.b", "a.c", "a.d")] == ["still", "moving", None]  # type: ignore[union-attr]


@pytest.mark.parametrize(("declared", "reason"), [
    ("{fusion: quick}", "no class 'quick'"), ("{fusion: {holds: 3 lb}}", "neither a time nor a distance"), ("{fusion: {within: 3 m}}", "no time"),
    ("{fusion: {holds: soon}}", "not a number"), ("{fusion: {corroborate: [model]}}", "cannot corroborate"),
    ("{fusion: {asks: [light.off]}}", "no fact"),
    ("{fusion: {ends: [sky.color]}}", "needs a boolean fact"), ("{fusion: {places: [sky.color=red]}}", "no value"),
    ("{fusion: {permissive: maybe}}", "true, false or unknown"), ("{fusion: {plausible: {min: 3 mph}}}", "only numbers"),
    ("{source: ego, fusion: moving}", "one teller"), ("{type: quantity, unit: ft, fusion: {permissive: '25 ft'}}", "> 25 ft"),
])  # fmt: skip
def test_what_does_not_fit_is_reported_where_it_stands(tmp_path: Path, declared: str, reason: str) -> None:
    import yaml

    more = {key: yaml.safe_dump(value, default_flow_style=True).strip().removesuffix("\n...") for key, value in yaml.safe_load(declared).items()}
    fields = {"kind": more.pop("type", "boolean"), "source": more.pop("source", "perception"), **more}
    sky = fact("sky.color", "enumeration", values="[none, blue]")
    _, wrong = read(tmp_path, fact(**fields) + sky)
    assert len(wrong) == 1
    assert "light.on" in wrong[0]
    assert reason in wrong[0]


def test_a_class_is_declared_once(tmp_path: Path) -> None:
    (tmp_path / "codes" / "vocabulary").mkdir(parents=True)
    (tmp_path / "codes" / "vocabulary" / "other.yaml").write_text(CLASS, "utf-8")
    (tmp_path / "codes" / "vocabulary" / "facts.yaml").write_text(CLASS + "facts:\n" + fact(), "utf-8")
    found = read_corpus(tmp_path / "codes", added=()).diagnostics
    assert [item.message for item in found if item.code == "R413"] == ["the class `moving` is declared twice"]
