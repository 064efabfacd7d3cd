"""A town of one crossing: codes with an exception, a limit, an override and tests whose outcome each test can change."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from regdb_compiler.driver import Build, build

JURISDICTIONS = """\
jurisdictions:
  state: {name: State, kind: state, code: sc, citation: {short: SC}}
  town: {name: Town, kind: city, parent: state, code: tc, citation: {short: TC}}
"""
VOCABULARY = """\
facts:
  signal.color: {type: enumeration, values: [none, red, green], source: perception, meaning: The light., quiet: none}
  stopped: {type: boolean, source: history, meaning: Came to a stop.}
  sign.no_turn: {type: boolean, source: perception, meaning: A sign forbids the turn.}
  officer: {type: boolean, source: perception, meaning: An officer directs., unknown: {assume: false, because: officers are reported}}
  school: {type: boolean, source: map, meaning: A school is near.}
  plan.speed: {type: quantity, unit: mph, source: plan, meaning: Speed.}
attributes:
  max_speed: {kind: limit, quantity: plan.speed, direction: max, meaning: Highest speed.}
"""
RED = """\
section: "10"
title: Red
location: [Lights]
topic: red-signal
source: {checked: 2026-05-05, confidence: recalled}
versions:
  - effective: 2000-01-01
    text: (a) Stop at red. (b) A right turn after stopping.
    regulations:
      - id: a
        condition:
          text: At red.
          when: signal.color == red
        result: must not go
        legality: false
        states: {current: [intersection_handling], next: [go_straight, turn_right]}
        tests:
          - {name: through red, scene: {signal.color: red}, plan: {current: stop, next: go_straight}, expect: {verdict: illegal, deciding: [a]}}
          - {name: at green, scene: {signal.color: green}, plan: {current: stop, next: go_straight}, expect: legal}
          - name: an officer waves on
            scene: {signal.color: red, officer: true}
            plan: {current: stop, next: go_straight}
            expect: {verdict: legal, deciding: [sc-12-a]}
      - id: b
        exception_to: [a]
        condition:
          text: After stopping.
          when: stopped
          unless: sign.no_turn
        result: may turn right
        legality: true
        states: {current: [stop], next: [turn_right]}
        tests:
          - name: right after stopping
            scene: {signal.color: red, stopped: true, sign.no_turn: false}
            expect: {verdict: legal, deciding: [b], assumed: [officer]}
          - name: right with the sign unseen
            scene: {signal.color: red, stopped: true}
            expect: {verdict: unknown, deciding: [a], unknown: [sign.no_turn]}
"""
SPEED = """\
section: "11"
title: Speed
location: [Speed]
topic: speed
source: {checked: 2026-05-05, confidence: recalled}
versions:
  - effective: 2000-01-01
    until: 2020-01-01
    text: Fifty.
    delegates: [{to: [city]}]
    regulations:
      - id: a
        condition: {text: Anywhere.}
        result: at most 50
        legality: false
        attributes: {max_speed: 50 mph}
        tests:
          - {name: the old limit, plan: {speed: 45 mph}, expect: {verdict: legal, limits: {max_speed: 50 mph}}}
  - effective: 2020-01-01
    text: Forty.
    delegates: [{to: [city]}]
    regulations:
      - id: a
        condition: {text: Anywhere.}
        result: at most 40
        legality: false
        attributes: {max_speed: 40 mph}
        tests:
          - {name: over the limit, plan: {speed: 45 mph}, expect: {verdict: illegal, deciding: [a], limits: {max_speed: 40 mph}}}
          - {name: at the limit, plan: {speed: 40 mph}, expect: legal}
          - {name: the day before the change, on: 2019-12-31, plan: {speed: 45 mph}, expect: {verdict: legal, limits: {max_speed: 50 mph}}}
          - {name: in the town, in: town, scene: {school: true}, plan: {speed: 30 mph}, expect: {verdict: illegal, deciding: [tc-1-a]}}
"""
OFFICER = """\
section: "12"
title: Officers
location: [Officers]
topic: officers
source: {checked: 2026-05-05, confidence: recalled}
versions:
  - effective: 2000-01-01
    text: An officer's word goes before lights.
    regulations:
      - id: a
        exception_to: [sc-10-a]
        condition: {text: An officer directs., when: officer}
        result: may go
        legality: true
        tests:
          - {name: against red, scene: {signal.color: red, officer: true}, plan: {current: stop, next: turn_right}, expect: {deciding: [a]}}
"""
TOWN = """\
section: "1"
title: Schools
location: [Speed]
topic: speed
source: {checked: 2026-05-05, confidence: recalled}
versions:
  - effective: 2021-01-01
    text: Twenty at schools.
    regulations:
      - id: a
        overrides: [sc-11-a]
        authority: SC 11
        condition: {text: Near a school., when: school}
        result: at most 20
        legality: false
        attributes: {max_speed: 20 mph}
        tests:
          - {name: past a school, scene: {school: true}, plan: {speed: 20 mph}, expect: {verdict: legal, limits: {max_speed: 20 mph}}}
"""
CASES = """\
cases:
  - name: Right on red in town after a stop
    cites: [SC 10(b)]
    in: town
    on: 2026-03-02
    scene: {like: quiet, signal.color: red, stopped: true, sign.no_turn: false}
    plan: {current: stop, next: turn_right, speed: 15 mph}
    expect: {verdict: legal, deciding: [sc-10-b], limits: {max_speed: 40 mph}}
"""
FILES = {
    "jurisdictions.yaml": JURISDICTIONS, "vocabulary/facts.yaml": VOCABULARY, "sc/10.yaml": RED, "sc/11.yaml": SPEED, "sc/12.yaml": OFFICER,
    "tc/1.yaml": TOWN, "sc/cases/red.yaml": CASES,
}  # fmt: skip

Town = Callable[..., Path]


@pytest.fixture
def town(codes: Path, tmp_path: Path) -> Town:
    """Write the codes; arguments are (file, what stands there, what shall stand there instead)."""

    def write(*changes: tuple[str, str, str]) -> Path:
        folder = tmp_path / "codes"
        for name, text in FILES.items():
            for file, old, new in changes:
                if file == name:
                    assert old in text
                    text = text.replace(old, new)
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")
        shutil.copy(codes / "states.yaml", folder / "states.yaml")
        return folder

    return write


@pytest.fixture
def built(town: Town) -> Callable[..., Build]:
    """The same, built."""
    return lambda *changes: build(town(*changes))
