"""The perception loop as a state machine, fed with events at times of the test's choosing."""

import pytest
from regdb_runtime.perception.describer import Description, Frame, Prompt
from regdb_runtime.perception.evidence import Choice, Question
from regdb_runtime.perception.loop_core import Attention, Call, Health, LoopCore, LoopSettings, degraded

GOING, BRAKING = Attention("lane_following.go_straight"), Attention("emergency_stop.emergency_stop")
SAID, LATE = Description("A stop sign."), Description("", "deadline", "no answer within 2 s")
QUESTION = Question("sign.stop", (Choice("sign.stop", True, "stop sign"),), "Which one is it: (a) stop sign; (b) none of these?")  # noqa: FBT003


class Sentences:
    """Prompts that say what they were made of; none in an emergency."""

    def prompt(
        self, state_id: str, missing: tuple[str, ...] = (), history: tuple[tuple[str, str], ...] = (), relevant: frozenset[str] | None = None,
        turn: int = 0,
    ) -> Prompt | None:  # fmt: skip
        words = (state_id, *missing, *sorted(relevant or ()), str(turn))
        return None if state_id.startswith("emergency") else Prompt(" ".join(words), history=history, name=state_id)


def frame(captured: float) -> Frame:
    return Frame(f"f{captured:g}", captured, b"")


def core(**settings: float) -> LoopCore:
    return LoopCore(Sentences(), LoopSettings(**settings))  # type: ignore[arg-type]


def asked(machine: LoopCore, now: float, attention: Attention = GOING) -> Call:
    """A frame offered and asked about at once."""
    machine.offer(frame(now), attention)
    call = machine.next_call(now)
    assert call is not None
    return call


def test_nothing_is_asked_before_there_is_a_frame() -> None:
    assert core().next_call(0.0) is None


def test_the_latest_frame_wins() -> None:
    machine = core()
    for captured in (0.1, 0.2, 0.3):
        machine.offer(frame(captured), GOING)
    call = machine.next_call(0.35)
    assert call is not None
    assert (call.frame.captured, call.started) == (0.3, 0.35)
    machine.finished(SAID, 0.4)
    assert machine.next_call(0.4) is None, "the frames before are gone"


def test_one_call_is_in_flight() -> None:
    machine = core()
    first = asked(machine, 0.0)
    machine.offer(frame(0.1), GOING)
    assert (machine.next_call(0.1), machine.in_flight) == (None, first)
    assert machine.finished(SAID, 0.2) is first
    second = machine.next_call(0.2)
    assert second is not None
    assert second.frame.captured == 0.1


def test_an_answer_without_a_question_is_an_error() -> None:
    with pytest.raises(RuntimeError, match="no call was in flight"):
        core().finished(SAID, 0.0)


@pytest.mark.parametrize("rate", [0.2, 0.5, 2.0, 10.0, 20.0])
def test_at_any_rate_of_the_model_every_answer_is_of_the_newest_frame_then(rate: float) -> None:
    """A camera of 20 Hz and a model that takes 1/rate: a minute of it."""
    machine, due, ages = core(), float("inf"), []
    for tick in range(1200):
        now = tick * 0.05
        if now >= due - 1e-9:
            machine.finished(SAID, now)
        machine.offer(frame(now), GOING)
        call = machine.next_call(now)
        if call is not None:
            due = now + 1 / rate
            ages.append(now - call.frame.captured)
    assert max(ages) == 0.0
    assert machine.health.calls == pytest.approx(60 * rate, abs=2)


def test_a_period_keeps_calls_apart() -> None:
    machine = core(period=0.5)
    asked(machine, 0.0)
    machine.finished(SAID, 0.1)
    machine.offer(frame(0.2), GOING)
    assert machine.next_call(0.2) is None
    assert machine.waits_until == 0.5
    machine.offer(frame(0.5), GOING)
    assert machine.next_call(0.5) is not None


def test_an_old_frame_is_not_worth_a_question() -> None:
    machine = core(oldest_frame=0.5)
    machine.offer(frame(0.0), GOING)
    assert machine.next_call(0.6) is None
    assert machine.health.skipped == 1


def test_errors_in_a_row_back_off_twice_as_long_each_time() -> None:
    machine, now, pauses = core(first_backoff=0.5, longest_backoff=8.0), 0.0, []
    for _ in range(7):
        asked(machine, now)
        machine.finished(LATE, now)
        machine.offer(frame(now), GOING)
        assert machine.next_call(now + 0.01) is None
        pauses.append(machine.waits_until - now)
        now = machine.waits_until
    assert pauses == pytest.approx([0.5, 1.0, 2.0, 4.0, 8.0, 8.0, 8.0])
    asked(machine, now)
    machine.finished(SAID, now)
    asked(machine, now)
    machine.finished(LATE, now)
    assert machine.waits_until - now == pytest.approx(0.5), "an answer forgives"


def test_an_emergency_asks_nothing_and_is_no_fault() -> None:
    machine = core()
    machine.offer(frame(0.0), BRAKING)
    assert machine.next_call(0.0) is None
    assert (machine.health.asking, degraded(machine.health, 9.0, machine.settings)) == (False, "")
    asked(machine, 9.0)
    assert machine.health.asking


def test_why_perception_is_degraded() -> None:
    machine = core(late_after=3.0)
    say = lambda now: degraded(machine.health, now, machine.settings)  # noqa: E731
    assert say(0.0) == "no frame has been answered yet"
    asked(machine, 0.0)
    machine.finished(SAID, 1.0)
    assert say(3.0) == ""
    assert say(3.5) == "the newest frame answered is 3.5 s old", "age counts from the capture"
    asked(machine, 4.0)
    machine.finished(LATE, 6.0)
    assert say(6.0) == "the model does not answer (deadline: no answer within 2 s)"
    asked(machine, 6.5)
    machine.finished(LATE, 8.5)
    assert say(8.5) == "the model does not answer (deadline: no answer within 2 s, 2 times in a row)"


def test_a_prompt_carries_what_is_missing_the_turn_and_what_was_said() -> None:
    machine = core(turns=2)
    for turn in range(4):
        call = asked(machine, float(turn), Attention("lane_following.go_straight", ("sign.stop",), relevant=frozenset(("sign.school",))))
        assert call.prompt.text == f"lane_following.go_straight sign.stop sign.school {turn}"
        machine.finished(Description(f"answer {turn}"), turn + 0.5)
    assert [answer for _, answer in asked(machine, 4.0).prompt.history] == ["answer 2", "answer 3"]


def test_a_call_knows_where_its_frame_was_taken() -> None:
    machine = core()
    assert asked(machine, 1.0, Attention("lane_following.go_straight", travelled=42.0)).travelled == 42.0


def test_an_open_question_is_put_every_other_time_and_on_the_crop() -> None:
    machine = LoopCore(Sentences(), LoopSettings(choice_tokens=9), lambda _, fact: (1.0, 2.0, 3.0, 4.0) if fact == "sign.stop" else None, (QUESTION,))
    calls = []
    for now in range(4):
        calls.append(asked(machine, float(now)))
        machine.finished(SAID, now + 0.5)
    assert [call.question for call in calls] == [QUESTION, None, QUESTION, None]
    prompt = calls[0].prompt
    assert (prompt.text, prompt.name, prompt.max_tokens, prompt.crop) == (QUESTION.text, "choice:sign.stop", 9, (1.0, 2.0, 3.0, 4.0))
    assert len(calls[3].prompt.history) == 1, "a closed question is no turn of the conversation"
    machine.questions = ()
    assert asked(machine, 4.0).question is None


def test_health_is_one_value_for_whoever_reads_it() -> None:
    machine = core()
    before = machine.health
    asked(machine, 0.0)
    assert (before, machine.health) == (Health(), Health(calls=1))
