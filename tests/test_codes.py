"""The shipped codes: what the first issue asks of them, whatever else grows."""

from pathlib import Path

import pytest
from regdb_compiler.driver import Build, build

from regdb.condition import literals
from regdb.meaning import decide, governing
from regdb.situation import Situation, read_plan, read_scene
from regdb.vocabulary import read_date

CVC = (
    *map(str, range(21450, 21458)), "21460", "21460.5", *map(str, range(21650, 21653)), *map(str, range(21654, 21659)), "21703",
    *map(str, range(21750, 21761)), "21800", "21801", "21802", "21806", "21809", "21950", "22100", "22101", "22107", "22108", "22348",
    "22349", "22350", "22352", "22352.5", "22357", "22358", "22358.4", "22406", "22450", "22454", "22526",
)  # fmt: skip
PROMPTS = {
    "lane_following": "Examine the current driving scenario, look out for intersections or obstacle vehicles.",
    "intersection_handling": "Examine the current driving scenario, check if the ego vehicle is still facing an intersection.",
    "overtaking": "Examine the current driving scenario, check nearby lane occupation conditions, and look out for intersection.",
}


@pytest.fixture(scope="module")
def law(codes: Path) -> Build:
    return build(codes)


def test_the_codes_have_no_errors(law: Build) -> None:
    assert [f"{item.place} {item.code} {item.message}" for item in law.diagnostics if item.level == "error"] == []


@pytest.mark.parametrize("section", CVC)
def test_the_section_is_there(law: Build, section: str) -> None:
    there = ("CVC", section) in law.corpus.by_citation
    assert there


def test_every_code_has_regulations_and_there_are_enough(law: Build) -> None:
    by_code = {jurisdiction.code: 0 for jurisdiction in law.corpus.tree}
    for entry in law.corpus.regulations:
        by_code[entry.jurisdiction.code] += 1
    assert min(by_code.values()) >= 5, by_code
    assert len({entry.id for entry in law.corpus.regulations}) >= 70
    assert len(law.corpus.vocabulary) >= 120


def test_every_regulation_has_a_test_and_a_source(law: Build) -> None:
    assert [entry.id for entry in law.corpus.regulations if not entry.doc.tests] == []
    unsourced = [s.id for s in law.corpus.sections if s.doc.source.confidence != "recalled" and not s.doc.source.url]
    assert unsourced == []
    lonely = [s.id for s in law.corpus.sections if s.doc.source.confidence == "verified" and not s.doc.source.also]
    assert lonely == []


def test_local_law_names_its_authority(law: Build) -> None:
    local = [entry for entry in law.corpus.regulations if entry.jurisdiction.is_local]
    assert local
    assert [entry.id for entry in local if not entry.doc.authority] == []


def test_every_construct_is_exercised(law: Build) -> None:
    docs = [entry.doc for entry in law.corpus.regulations]
    kinds = {type(literal).__name__ for rule in law.regulations for literal in literals(rule.when)}
    assert {"Is", "OneOf", "Has", "Compare"} <= kinds
    for field in ("exception_to", "overrides", "authority", "requires_sign", "applies_to", "tags", "attributes"):
        assert any(getattr(doc, field) for doc in docs), field
    assert {doc.force for doc in docs} >= {"absolute", "prima_facie", "basic", "penalty_tier"}
    assert any(len(section.versions) > 1 for section in law.corpus.sections)
    assert any(version.doc.definitions for version in law.corpus.versions)
    assert any(version.doc.delegates for version in law.corpus.versions)


def test_table_one_s_row_is_a_penalty_tier_over_all_states_of_overtaking(law: Build) -> None:
    (row,) = [rule for rule in law.regulations if rule.id.startswith("cvc-22348-b") and rule.force == "penalty_tier" and rule.until is None]
    assert [limit.text for limit in row.limits] == ["100 mph"]
    assert row.current is not None
    assert set(law.corpus.machine.expand("overtaking")) <= row.current


def test_the_school_zone_rule_s_vagueness_is_one(law: Build) -> None:
    scores = {e.doc.vagueness.score for e in law.corpus.by_citation["CVC", "22358.4"].versions[-1].regulations}
    assert scores
    assert scores <= {0, 1}
    assert 1 in scores


@pytest.mark.parametrize("name", sorted(PROMPTS))
def test_table_two_s_prompts_are_word_for_word(law: Build, name: str) -> None:
    assert law.corpus.machine.super_states[name].prompt == PROMPTS[name]


def test_table_two_s_successors_and_the_only_doors(law: Build) -> None:
    machine = law.corpus.machine
    assert machine.super_states["lane_following"].next == ("lane_following", "intersection_handling", "overtaking")
    assert machine.super_states["intersection_handling"].next == ("intersection_handling", "lane_following")
    assert set(machine.super_states["overtaking"].next) == {"overtaking", "lane_following", "intersection_handling"}
    for state in machine.states.values():
        for target in state.next:
            other = machine.states[target]
            if other.super_state not in {state.super_state, "emergency_stop"}:
                door = machine.super_states[state.super_state].exit
                assert state.name == door
                assert other.name == machine.super_states[other.super_state].entry
        assert any(target.startswith("emergency_stop.") for target in state.next)


@pytest.mark.parametrize(("without", "verdict"), [((), "legal"), (("cvc-21453-b-right",), "illegal")])
def test_right_on_red_is_lawful_by_the_database_alone(law: Build, without: tuple[str, ...], verdict: str) -> None:
    scene = read_scene(
        {"like": "quiet", "signal.present": "true", "signal.color": "red", "signal.shape": "circular", "ego.stopped_at_line": "true"},
        law.corpus.vocabulary,
    )
    plan = read_plan({"current": "stop", "next": "turn_right", "speed": "10 mph"}, law.corpus.vocabulary, law.corpus.machine)
    rules = [rule for rule in law.regulations if rule.id not in without]
    there = governing(rules, law.corpus.tree, "california", read_date("2026-03-02"))
    assert decide(there, Situation(law.corpus.vocabulary, scene, plan)).verdict == verdict
