"""The loop with its thread: the planner never waits, whatever the model does; facts come with evidence and go when nothing confirms them."""

import threading
import time
from collections.abc import Callable, Iterator

import pytest
from camera_frames import FRAME
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.observation import EgoState, Provenance
from regdb_runtime.perception.describer import Describer, Description, Frame, Prompt
from regdb_runtime.perception.evidence import Reading
from regdb_runtime.perception.fusion import Fusion
from regdb_runtime.perception.loop import Belief, LoopEye, PerceptionLoop
from regdb_runtime.perception.loop_core import Attention, LoopSettings
from regdb_runtime.perception.matcher import Matcher
from regdb_runtime.perception.openai_client import OpenAIDescriber, ServerSettings
from regdb_runtime.perception.prompts import PromptMaker
from regdb_runtime.perception.scripted_client import ScriptedDescriber
from regdb_runtime.worlds.eye import Eye
from stub_server import Behaviour, dripping, hanging_up, raw, says, serving, slow

from regdb.front import database

STOP = "There is a stop sign ahead."
SOON = 20.0
"""Seconds that a loaded machine may take for what happens at once."""


@pytest.fixture(scope="module")
def law() -> RegulationDatabase:
    return RegulationDatabase.open(database())


@pytest.fixture(scope="module")
def matcher(law: RegulationDatabase) -> Matcher:
    return Matcher(law.vocabulary)


class Clock:
    """Seconds since the run began, moved by hand."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


Build = Callable[..., PerceptionLoop]


@pytest.fixture
def build(law: RegulationDatabase, matcher: Matcher) -> Iterator[Build]:
    """Makes loops, and ends them."""
    loops: list[PerceptionLoop] = []

    def make(describer: Describer, clock: Clock | None = None, reader: object = matcher, **settings: float) -> PerceptionLoop:
        belief = Belief(Fusion(law.vocabulary), reader, law.vocabulary)  # type: ignore[arg-type]
        prompts = PromptMaker(law.machine, law.vocabulary)
        loop = PerceptionLoop(describer, prompts, belief, clock, LoopSettings(**settings))  # type: ignore[arg-type]
        loops.append(loop)
        return loop.start()

    yield make
    for loop in loops:
        assert loop.stop(SOON), "a loop has not ended"


def frame(clock: Clock) -> Frame:
    return Frame(f"f{clock.now:g}", clock.now, FRAME.image)


def until(true: Callable[[], bool]) -> None:
    """Wait for what another thread does."""
    end = time.monotonic() + SOON
    while not true():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)


def answered(loop: PerceptionLoop, clock: Clock, count: int) -> None:
    """Offer frames, at times 0.3 s apart and after any pause, until so many more have been answered."""
    wanted = loop.health.answers + count
    while loop.health.answers < wanted:
        clock.now = max(clock.now + 0.3, loop.health.waits_until)
        before = loop.last_answer
        loop.offer(frame(clock))
        until(lambda before=before: loop.last_answer is not before)  # type: ignore[misc]


def test_what_is_said_becomes_a_fact_with_its_evidence(build: Build) -> None:
    clock = Clock()
    loop = build(ScriptedDescriber(lambda *_: STOP), clock)
    assert loop.latest.degraded == "no frame has been answered yet"
    assert "sign.stop" in loop.latest.silent
    answered(loop, clock, 1)
    clock.now += 0.7
    found = loop.snapshot()
    assert found.facts["sign.stop"] is True
    (statement,) = found.evidence["sign.stop"]
    assert (statement.source, statement.frame, statement.captured, statement.prompt) == ("scripted", "f0.3", 0.3, "lane_following.go_straight")
    assert STOP[statement.spans[0].start : statement.spans[-1].end].startswith("stop sign")
    assert found.age["sign.stop"] == pytest.approx(0.7), "age counts from the capture"
    assert (found.degraded, loop.latest) == ("", found)
    assert loop.provenance == "scripted"


class Blocked:
    """A model that answers only when it is told to; `began` says that it was asked."""

    provenance: Provenance = "live"

    def __init__(self) -> None:
        self.began, self.free = threading.Event(), threading.Event()

    def describe(self, *_: object) -> Description:
        self.began.set()
        assert self.free.wait(SOON)
        return Description(STOP)

    def close(self) -> None:
        self.free.set()


def test_the_planner_goes_on_while_the_model_thinks(build: Build) -> None:
    """The model answers only after the planner's hundredth tick: were the planner to wait for it, neither would go on."""
    clock, model = Clock(), Blocked()
    loop = build(model, clock)
    loop.offer(frame(clock))
    assert model.began.wait(SOON)
    for _ in range(100):
        clock.now += 0.1
        loop.attend("intersection_handling.stop", ("sign.no_turn_on_red",), 5.0)
        loop.offer(frame(clock))
        assert loop.snapshot().time == clock.now
    assert (loop.health.calls, loop.health.answers) == (1, 0)
    model.free.set()
    until(lambda: loop.health.answers >= 2)
    assert loop.last_answer is not None
    call, _ = loop.last_answer
    assert (call.frame.captured, call.prompt.name) == (pytest.approx(10.0), "intersection_handling.stop"), "the latest frame was asked about next"


@pytest.mark.parametrize("rate", [20.0, 2.0])
def test_ticks_are_kept_beside_a_model_of_any_rate(build: Build, rate: float) -> None:
    """A planner of 10 Hz for a second and a half, with 1080p frames sent over HTTP: one that waited for a model of 2 Hz would make three
    ticks of the fifteen; a third is left for what else this machine does."""
    with serving(slow(1 / rate, STOP)) as stub:
        loop = build(OpenAIDescriber(ServerSettings("m", base_url=stub.url)))
        began, ticks = time.monotonic(), 0
        while (now := time.monotonic() - began) < 1.5:
            loop.offer(Frame(f"f{ticks}", now, FRAME.image))
            loop.snapshot()
            ticks += 1
            time.sleep(max(ticks * 0.1 - (time.monotonic() - began), 0.0))
        until(lambda: loop.health.answers >= 1)
        loop.stop(SOON)
    assert ticks >= 10


MISBEHAVIOURS = {
    "slow": slow(5.0), "dripping": dripping(STOP, 0.05), "garbage": raw(b"\x00\xff"), "half JSON": raw(b'{"choices": [{"mess'), "500": raw(b"", 500),
    "10 MB": raw(b"x" * 10_000_000), "closed": hanging_up, "wrong schema": raw(b'{"answer": "stop sign"}'),
}  # fmt: skip


@pytest.mark.parametrize("name", MISBEHAVIOURS)
def test_facts_decay_to_unknown_while_the_model_misbehaves(build: Build, name: str) -> None:
    clock = Clock()
    behaviour: Behaviour = MISBEHAVIOURS[name]
    with serving(says(STOP)) as stub:
        loop = build(OpenAIDescriber(ServerSettings("m", base_url=stub.url)), clock, deadline=0.5)
        answered(loop, clock, 1)
        assert loop.snapshot().facts["sign.stop"] is True
        stub.behaviour = behaviour
        clock.now += 0.3
        loop.offer(frame(clock))
        until(lambda: loop.health.failures == 1)
        now = loop.snapshot()
        assert now.facts["sign.stop"] is True, "what was seen a moment ago still is"
        assert now.degraded.startswith("the model does not answer (")
        clock.now += 90.0
        loop.attend("lane_following.go_straight", travelled=500.0)
        later = loop.snapshot()
        assert "sign.stop" not in later.facts
        assert "sign.stop" in later.silent
        stub.behaviour = says(STOP)
        answered(loop, clock, 1)
        assert (loop.snapshot().facts["sign.stop"], loop.snapshot().degraded) == (True, "")


@pytest.mark.parametrize("text", ['{"traffic_light": "green"}', '{"seen": ["signal.color=gr', "!!! ???", '{"seen": [], "not_seen": ["sign.st'])
def test_an_answer_that_means_nothing_says_nothing(build: Build, text: str) -> None:
    clock = Clock()
    loop = build(ScriptedDescriber(lambda *_: text), clock)
    answered(loop, clock, 3)
    assert loop.snapshot().facts == {}


def test_no_call_in_an_emergency(build: Build) -> None:
    clock = Clock()
    asked: list[str] = []
    loop = build(ScriptedDescriber(lambda _, prompt: asked.append(prompt.name) or STOP), clock)  # type: ignore[func-returns-value]
    loop.attend("emergency_stop.emergency_stop")
    loop.offer(frame(clock))
    until(lambda: not loop.health.asking)
    loop.attend("lane_following.go_straight")
    answered(loop, clock, 1)
    assert set(asked) == {"lane_following.go_straight"}


class Raises:
    """A client, and a reader, that break their promise."""

    provenance: Provenance = "live"

    def describe(self, *_: object) -> Description:
        raise ValueError("unexpected")

    def read(self, *_: object) -> Reading:
        raise ValueError("unexpected")


def test_a_client_or_reader_that_raises_is_a_failure_and_no_end(build: Build) -> None:
    clock = Clock()
    client, reader = build(Raises(), clock), build(ScriptedDescriber(lambda *_: STOP), clock, Raises())
    for loop in (client, reader):
        loop.offer(frame(clock))
        until(lambda loop=loop: loop.health.failures == 1)  # type: ignore[misc]
    assert "ValueError: unexpected" in client.snapshot().degraded
    assert "the answer cannot be read: unexpected" in reader.snapshot().degraded


def test_a_state_without_a_prompt_to_make_is_a_failure(build: Build) -> None:
    clock = Clock()
    loop = build(ScriptedDescriber(lambda *_: STOP), clock)
    loop.attend("no.such.state")
    loop.offer(frame(clock))
    until(lambda: loop.health.failures == 1)
    assert "no prompt can be made: unknown state 'no.such.state'" in loop.snapshot().degraded


def test_stopping_cancels_a_call_in_flight(build: Build) -> None:
    clock = Clock()
    with serving(slow(60.0)) as stub:
        loop = build(OpenAIDescriber(ServerSettings("m", base_url=stub.url)), clock, deadline=60.0)
        loop.offer(frame(clock))
        until(lambda: bool(stub.requests))
        assert loop.stop(SOON)
    assert loop.health.answers == 0


def test_stopping_does_not_wait_for_a_model_that_will_not(build: Build) -> None:
    class Deaf(Blocked):
        def close(self) -> None:
            """Does not hear."""

    clock, model = Clock(), Deaf()
    loop = build(model, clock)
    loop.offer(frame(clock))
    assert model.began.wait(SOON)
    assert not loop.stop(0.05)
    model.free.set()
    assert loop.stop(SOON)


def test_a_loop_begins_once_and_ends_with_its_block(law: RegulationDatabase) -> None:
    belief = Belief(Fusion(law.vocabulary), None, law.vocabulary)
    with PerceptionLoop(ScriptedDescriber(lambda *_: STOP), PromptMaker(law.machine, law.vocabulary), belief) as loop:
        with pytest.raises(RuntimeError, match="started already"):
            loop.start()
        threads = [thread for thread in threading.enumerate() if thread.name == "perception-loop"]
        assert threads
    assert not any(thread.is_alive() for thread in threads)


def test_a_closed_question_tells_look_alikes_apart(build: Build) -> None:
    """Table III's miss: `stop here on red` described as a stop sign; asked which one it is, the model looks again."""
    clock = Clock()

    def answer(_: Frame, prompt: Prompt) -> str:
        if not prompt.name.startswith("choice:"):
            return STOP
        letter = next(part for part in prompt.text.split("(") if "stop here on red" in part)[0]
        return f"({letter})"

    loop = build(ScriptedDescriber(answer), clock)
    answered(loop, clock, 1)
    questions = {item.fact for item in loop.snapshot().questions}
    assert "sign.stop" in questions
    for _ in range(6):
        answered(loop, clock, 1)
        loop.snapshot()
    assert loop.snapshot().facts["sign.stop_here_on_red"] is True


class Ego:
    """An ego that drives along x."""

    @staticmethod
    def at(x: float) -> EgoState:
        return EgoState(x, 0.0, 0.0, 10.0)


def test_a_loop_is_an_eye_of_a_world(build: Build) -> None:
    clock = Clock()
    loop = build(ScriptedDescriber(lambda *_: STOP + " There is a crossing guard."), clock)
    eye = LoopEye(loop, lambda: Attention("intersection_handling.stop", ("sign.stop",)), frozenset({"sign.stop"}))
    world_eye: Eye = eye
    world_eye.look(0.0, Ego.at(0.0))
    answered(loop, clock, 1)
    facts, silent = world_eye.look(0.1, Ego.at(3.0))
    assert facts == {"sign.stop": True}
    assert "sign.stop" not in silent
    assert world_eye.provenance == "scripted"
    world_eye.look(0.2, Ego.at(500.0))
    facts, silent = world_eye.look(0.3, Ego.at(500.0))
    assert facts == {}
    assert "sign.stop" in silent
