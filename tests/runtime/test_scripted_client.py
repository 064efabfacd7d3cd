"""A script answers like a model, and is labelled."""

from regdb_runtime.perception.describer import Describer, Frame, Prompt
from regdb_runtime.perception.scripted_client import ScriptedDescriber

PROMPT = Prompt("What is ahead?")


def frame(captured: float) -> Frame:
    return Frame(f"f{captured}", captured, b"")


def test_it_is_labelled() -> None:
    script: Describer = ScriptedDescriber(lambda *_: "x")
    assert script.provenance == "scripted"


def test_by_time_the_line_that_has_begun_is_said() -> None:
    script = ScriptedDescriber.by_time([(5.0, "A stop sign."), (1.0, "A red light.")])
    said = [script.describe(frame(when), PROMPT, 1.0).text for when in (0.0, 1.0, 4.9, 5.0, 99.0)]
    assert said == ["Nothing is known yet.", "A red light.", "A red light.", "A stop sign.", "A stop sign."]


def test_it_takes_its_time_and_misses_deadlines() -> None:
    slept: list[float] = []
    script = ScriptedDescriber(lambda *_: "A red light.", 0.7, slept.append, "llava")
    found = script.describe(frame(0.0), PROMPT, 1.0)
    assert (found.text, found.took, found.model) == ("A red light.", 0.7, "llava")
    late = script.describe(frame(0.0), PROMPT, 0.5)
    assert (late.text, late.failure, late.took) == ("", "deadline", 0.5)
    assert slept == [0.7, 0.5]


def test_it_never_raises_and_never_says_nothing() -> None:
    def fail(*_: object) -> str:
        raise KeyError("no such frame")

    assert ScriptedDescriber(fail).describe(frame(0.0), PROMPT, 1.0).failure == "malformed"
    assert ScriptedDescriber(lambda *_: "").describe(frame(0.0), PROMPT, 1.0).failure == "malformed"
