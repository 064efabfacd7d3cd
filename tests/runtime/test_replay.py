"""What a model said is kept and said again, by hash or by time, as fast or as slowly as then."""

import json
from pathlib import Path

import pytest
from camera_frames import FRAME
from regdb_runtime.errors import LogError
from regdb_runtime.perception.describer import Closing, Describer, Description, Frame, Prompt
from regdb_runtime.perception.replay import Entry, Recorder, ReplayDescriber, frame_hash, prompt_hash, read_record
from regdb_runtime.perception.scripted_client import ScriptedDescriber

PROMPT, OTHER = Prompt("What is ahead?"), Prompt("Which sign is it?")


def frames(count: int) -> list[Frame]:
    return [Frame(f"f{index}", index * 0.5, f"image {index}".encode()) for index in range(count)]


def recorded(path: Path, takes: float = 0.3) -> list[Description]:
    """A record of four frames, asked two things each."""
    script = ScriptedDescriber(lambda frame, prompt: f"{frame.id}: {prompt.text}", takes, lambda _: None)
    recorder = Recorder(script, path)
    return [recorder.describe(frame, prompt, 1.0) for frame in frames(4) for prompt in (PROMPT, OTHER)]


def test_a_record_says_again_what_was_said(tmp_path: Path) -> None:
    said = recorded(tmp_path / "vision.jsonl")
    replay = ReplayDescriber.read(tmp_path / "vision.jsonl")
    assert replay.provenance == "recorded"
    assert [replay.describe(frame, prompt, 1.0) for frame in frames(4) for prompt in (PROMPT, OTHER)] == said


def test_a_line_says_all_there_is_to_know() -> None:
    description = Description("Ein Stoppschild: „STOP“", took=0.25, model="llava", usage={"completion_tokens": 4}, cut=True)
    line = Entry.of(FRAME, Prompt("?", name="lane_following.go_straight"), description).to_line()
    assert "\n" not in line
    assert Entry.read(json.loads(line)).description == description
    raw = json.loads(line)
    assert (raw["version"], raw["captured"], raw["id"], raw["name"], raw["frame"]) == (1, 12.5, "f1", "lane_following.go_straight", frame_hash(FRAME))


def test_failures_are_recorded_too(tmp_path: Path) -> None:
    recorder = Recorder(ScriptedDescriber(lambda *_: "late", 3.0, lambda _: None), tmp_path / "vision.jsonl")
    found = recorder.describe(FRAME, PROMPT, 1.0)
    assert found.failure == "deadline"
    assert ReplayDescriber.read(tmp_path / "vision.jsonl").describe(FRAME, PROMPT, 1.0) == found


def test_another_frame_or_prompt_was_not_recorded(tmp_path: Path) -> None:
    recorded(tmp_path / "vision.jsonl")
    replay = ReplayDescriber.read(tmp_path / "vision.jsonl")
    for frame, prompt in ((FRAME, PROMPT), (frames(1)[0], Prompt("And now?"))):
        found = replay.describe(frame, prompt, 1.0)
        assert (found.text, found.failure, found.detail) == ("", "connection", "nothing was recorded of this frame and prompt")


def test_the_hash_is_of_all_that_is_asked() -> None:
    prompts = [
        Prompt("a"), Prompt("b"), Prompt("a", {"type": "object"}), Prompt("a", history=(("q", "a"),)), Prompt("a", crop=(0.0, 0.0, 9.0, 9.0)),
        Prompt("a", max_tokens=5),
    ]  # fmt: skip
    assert len({prompt_hash(prompt) for prompt in prompts}) == len(prompts)
    assert prompt_hash(Prompt("a", name="x")) == prompt_hash(Prompt("a")), "a name is no part of the question"


def test_a_frame_asked_again_gets_the_answers_in_their_order() -> None:
    frame = frames(1)[0]
    replay = ReplayDescriber([Entry.of(frame, PROMPT, Description(text)) for text in ("first", "second")])
    assert [replay.describe(frame, PROMPT, 1.0).text for _ in range(3)] == ["first", "second", "second"]


def test_by_time_the_nearest_of_the_same_prompt_answers(tmp_path: Path) -> None:
    recorded(tmp_path / "vision.jsonl")
    replay = ReplayDescriber.read(tmp_path / "vision.jsonl", "time")
    ask = {when: replay.describe(Frame("x", when, b"another camera"), OTHER, 1.0) for when in (-0.4, 0.2, 0.3, 1.5, 1.9, 2.1)}
    assert [found.text for found in ask.values()] == [
        "f0: Which sign is it?", "f0: Which sign is it?", "f1: Which sign is it?", "f3: Which sign is it?", "f3: Which sign is it?", "",
    ]  # fmt: skip
    assert replay.describe(Frame("x", 1.0, b""), Prompt("never asked"), 1.0).text.startswith("f2: ")


def test_a_paced_replay_misses_the_deadlines_that_were_missed(tmp_path: Path) -> None:
    recorded(tmp_path / "vision.jsonl", takes=0.8)
    slept: list[float] = []
    replay = ReplayDescriber(read_record(tmp_path / "vision.jsonl"), paced=True, sleep=slept.append)
    assert not replay.describe(frames(1)[0], PROMPT, 1.0).failure
    assert replay.describe(frames(1)[0], PROMPT, 0.5).failure == "deadline"
    assert slept == [0.8, 0.5]


def test_a_line_that_was_being_written_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "vision.jsonl"
    recorded(path)
    path.write_text(path.read_text("utf-8")[:-20], "utf-8")
    assert len(read_record(path)) == 7


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("{}", "'version'"), ('{"version": 2}', "it has version 2, this reads version 1"), ("[]", "list indices"), ("not json", "Expecting value"),
        ('{"version": 1, "failure": "tired"}', "'tired' is no failure"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_record_is_refused_with_its_line(tmp_path: Path, line: str, why: str) -> None:
    path = tmp_path / "vision.jsonl"
    recorded(path)
    with path.open("a", encoding="utf-8") as file:
        file.write(line + "\n")
    with pytest.raises(LogError, match=r"vision.jsonl:9: no line of a record of a vision model") as caught:
        read_record(path)
    assert why in str(caught.value)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read"):
        read_record(tmp_path / "none.jsonl")


def test_a_full_disk_costs_the_record_not_the_drive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recorder = Recorder(ScriptedDescriber(lambda *_: "A stop sign."), tmp_path / "vision.jsonl")

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "open", full)
    assert [recorder.describe(FRAME, PROMPT, 1.0).text for _ in range(2)] == ["A stop sign."] * 2
    assert "No space left" in recorder.broken


def test_a_recorder_is_what_it_records(tmp_path: Path) -> None:
    class Model(ScriptedDescriber):
        closed = False

        def close(self) -> None:
            self.closed = True

    model = Model(lambda *_: "x")
    recorder: Describer = Recorder(model, tmp_path / "vision.jsonl")
    assert recorder.provenance == "scripted"
    assert isinstance(recorder, Closing)
    recorder.close()
    assert model.closed
