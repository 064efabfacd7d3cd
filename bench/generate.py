"""Write many synthetic but valid regulations into a codes folder: `python bench/generate.py 10000 DIR`.

The shipped vocabulary, states and jurisdictions are copied; the sections are made up from a seed. Each has a few prohibitions with
conditions on the scene, some with limits, and permissions as exceptions to them, with tests, as authors write them.
"""

from __future__ import annotations

import argparse
import random
import shutil
from collections.abc import Iterator
from pathlib import Path

from regdb_compiler.read_corpus import read_corpus

from regdb.vocabulary import Fact, Vocabulary

SHIPPED = Path(__file__).parents[1] / "codes"
PER_SECTION = 10
STATES = (
    "{current: [lane_following], next: [lane_following.go_straight, lane_following.car_following]}",
    "{current: [intersection_handling], next: [turn_left, turn_right]}",
    "{current: [lane_following.prepare_lane_change_left], next: [lane_following.lane_change_left]}",
    "{current: [overtaking], next: [overtaking.go_straight]}",
)
TRANSITIONS = (
    "current: lane_following.go_straight, next: lane_following.go_straight",
    "current: stop, next: turn_right",
    "current: lane_following.prepare_lane_change_left, next: lane_following.lane_change_left",
    "current: overtaking.go_straight, next: overtaking.go_straight",
)
MAX_SPEEDS = (15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65)


def generate(count: int, folder: Path, seed: int = 1, source: Path = SHIPPED) -> Path:
    """Write `count` regulations into `folder`/codes, ten to a section; the same seed writes the same bytes. Returns the codes folder."""
    codes = folder / "codes"
    codes.mkdir(parents=True, exist_ok=True)
    for name in ("jurisdictions.yaml", "states.yaml"):
        shutil.copy(source / name, codes / name)
    shutil.copytree(source / "vocabulary", codes / "vocabulary", dirs_exist_ok=True)
    vocabulary = read_corpus(codes).vocabulary
    made = 0
    for number in range(1, -(-count // PER_SECTION) + 1):
        size = min(PER_SECTION, count - made)
        chance = random.Random(f"{seed}-{number}")  # not for secrets: the same seed must give the same law
        code = "cvc" if number % 4 else "uvc"
        path = codes / code / f"{40000 + number}.yaml"
        path.parent.mkdir(exist_ok=True)
        path.write_text("\n".join(_section(40000 + number, size, chance, vocabulary)) + "\n", "utf-8")
        made += size
    return codes


def _section(number: int, size: int, chance: random.Random, vocabulary: Vocabulary) -> Iterator[str]:
    letters = [chr(97 + position) for position in range(size)]
    yield "# yaml-language-server: $schema=../../schema/section.json"
    yield f'section: "{number}"'
    yield f"title: Made-up section {number}"
    yield f"location: [Division {number % 17 + 1}, Chapter {number % 11 + 1}]"
    yield f"topic: made-up-{number % 40}"
    yield "source:"
    yield f"  url: https://example.org/{number}"
    yield f"  also: [https://example.com/{number}]"
    yield "  checked: 2026-03-01"
    yield "  confidence: verified"
    yield "versions:"
    yield f"  - effective: {chance.randrange(1960, 2024)}-0{chance.randrange(1, 10)}-01"
    yield "    text: |"
    for letter in letters:
        yield f"      ({letter}) What a driver does in case {letter} of section {number}."
    yield "    regulations:"
    for position, letter in enumerate(letters):
        permission = position % 5 == 4
        yield from _regulation(letter, letters[position - 1] if permission else "", chance, vocabulary, position // 5 + number)


def _regulation(letter: str, target: str, chance: random.Random, vocabulary: Vocabulary, place: int) -> Iterator[str]:
    facts = chance.sample([fact for fact in vocabulary if fact.kind in {"boolean", "enumeration", "quantity"} and fact.source != "plan"], 4)
    literals = [_literal(fact, chance) for fact in facts]
    scene = ", ".join(f"{fact.name}: {value}" for fact, (_, value) in zip(facts[:3], literals, strict=False))
    at = place % len(STATES)
    limit = None if target or chance.random() < 0.6 else chance.choice(MAX_SPEEDS)
    yield f"      - id: {letter}"
    if target:
        yield f"        exception_to: [{target}]"
    yield "        condition:"
    yield f"          text: Case {letter}, when {' and '.join(fact.name.replace('.', ' ') for fact in facts[:3])}."
    yield f"          when: {' and '.join(text for text, _ in literals[:3])}"
    if chance.random() < 0.5:
        yield f"          unless: {literals[3][0]}"
    yield f"        result: {'may go on' if target else f'must not drive faster than {limit} mph' if limit else 'must not go on'}"
    yield f"        legality: {'true' if target else 'false'}"
    if limit:
        yield f"        attributes: {{max_speed: {limit} mph}}"
        yield "        force: absolute"
    yield f"        states: {STATES[at]}"
    yield f"        quote: words of case {letter}"
    yield "        tests:"
    speeds = (f", speed: {limit} mph", f", speed: {limit + 1} mph") if limit else ("", "")
    deciding = f"{{deciding: [{letter}]}}" if target else "unknown"
    yield f"          - {{name: holds, scene: {{{scene}}}, plan: {{{TRANSITIONS[at]}{speeds[1]}}}, expect: {deciding}}}"
    for fact, (text, value) in zip(facts, literals, strict=True):
        if fact.kind == "quantity":
            number = int(value.strip('"').split()[0])
            near = f'{fact.name}: "{number * 0.95:g} {fact.unit}"'
            yield f"          - {{name: '{text}, by a hair not', scene: {{{near}}}, plan: {{{TRANSITIONS[at]}{speeds[1]}}}, expect: unknown}}"
            yield f"          - {{name: '{text}, just', scene: {{{fact.name}: {value}}}, plan: {{{TRANSITIONS[at]}{speeds[1]}}}, expect: unknown}}"
    yield f"          - {{name: nothing known, plan: {{{TRANSITIONS[at]}{speeds[0]}}}, expect: {'unknown' if target else 'legal'}}}"


def _literal(fact: Fact, chance: random.Random) -> tuple[str, str]:
    """A condition on a fact, and a value that makes it true."""
    if fact.kind == "boolean":
        wanted = chance.random() < 0.7
        return (fact.name, "true") if wanted else (f"not {fact.name}", "false")
    if fact.kind == "enumeration":
        word = chance.choice(fact.values)
        return f"{fact.name} == {word}", f'"{word}"'
    number = chance.randrange(1, 100)
    return f"{fact.name} >= {number} {fact.unit}", f'"{number} {fact.unit}"'


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int, help="how many regulations")
    parser.add_argument("folder", type=Path, help="where to write `codes/`")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    print(generate(asked.count, asked.folder, asked.seed))  # noqa: T201  # a script: its result is where it wrote
