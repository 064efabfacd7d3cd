"""The local client end to end with a tiny random LLaVA: its words mean nothing, but they come through the real path, and in time."""

import importlib.util
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from camera_frames import FRAME
from regdb_runtime.errors import MissingExtra, ModelError
from regdb_runtime.perception import local_llava
from regdb_runtime.perception.describer import Closing, Describer, Frame, Prompt
from regdb_runtime.perception.fusion import Fusion
from regdb_runtime.perception.local_llava import PAPER_RATES, LlavaDescriber, LlavaSettings, choose_device, load_arguments, settings_of
from regdb_runtime.perception.loop import Belief, PerceptionLoop
from regdb_runtime.perception.loop_core import LoopSettings
from regdb_runtime.perception.matcher import Matcher
from regdb_runtime.perception.prompts import PromptMaker

from regdb.states import State, StateMachine, SuperState
from regdb.vocabulary import Fact, Vocabulary

PROMPT = Prompt("Examine the current driving scenario", max_tokens=8)

needs_torch = pytest.mark.skipif(
    any(importlib.util.find_spec(name) is None for name in ("torch", "transformers")),
    reason="needs torch and transformers: make local-vlm",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from tiny_llava import save_tiny_llava

    return save_tiny_llava(tmp_path_factory.mktemp("llava"))


@pytest.fixture(scope="module")
def client(folder: Path) -> LlavaDescriber:
    return LlavaDescriber(LlavaSettings(str(folder), quantization="none", device="cpu"))


@needs_torch
def test_a_frame_and_a_prompt_give_words(client: LlavaDescriber) -> None:
    found = client.describe(FRAME, PROMPT, 60.0)
    assert found.failure == "", found.detail
    assert found.text
    assert found.usage["completion_tokens"] == 8
    assert found.cut, "it wrote as much as it may, and had not come to an end"
    assert client.describe(FRAME, PROMPT, 60.0).text == found.text


@needs_torch
def test_the_loop_runs_on_a_model_of_this_machine(folder: Path) -> None:
    """Frame, prompt of the state, model, matcher, fusion, snapshot; random weights say nothing worth knowing, but they say it as a model."""
    vocabulary = Vocabulary([Fact("sign.stop", "boolean", phrases={"true": ("stop", "sign")})])
    states = [State("lane_following", "go_straight", prompt=PROMPT.text)]
    prompts = PromptMaker(StateMachine([SuperState("lane_following")], states, "lane_following"), vocabulary)
    belief = Belief(Fusion(vocabulary), Matcher(vocabulary), vocabulary)
    client, end = LlavaDescriber(LlavaSettings(str(folder), quantization="none", device="cpu")), time.monotonic() + 60.0
    with PerceptionLoop(client, prompts, belief, lambda: FRAME.captured, LoopSettings(deadline=30.0)) as loop:
        loop.offer(FRAME)
        while loop.last_answer is None and time.monotonic() < end:
            time.sleep(0.01)
        found = loop.snapshot()
        assert loop.last_answer is not None
        call, description = loop.last_answer
    assert (call.prompt.text, description.failure, loop.provenance, found.degraded) == (PROMPT.text, "", "live", "")
    assert found.facts.get("sign.stop", False) is ("stop" in description.text or "sign" in description.text)
    assert all(item.source == "model" for items in found.evidence.values() for item in items)


@needs_torch
def test_the_picture_matters(client: LlavaDescriber) -> None:
    """The pixels reach the network: another frame changes what it makes of the same words."""
    import io

    from PIL import Image

    seen: list[Any] = []
    real = client._model.generate

    def generate(**inputs: Any) -> Any:
        seen.append(inputs["pixel_values"].clone())
        return real(**inputs)

    out = io.BytesIO()
    Image.new("RGB", (64, 48), (250, 250, 250)).save(out, "PNG")
    client._model.generate = generate
    try:
        for frame in (FRAME, Frame("white", 0.0, out.getvalue(), "image/png")):
            assert not client.describe(frame, PROMPT, 60.0).failure
    finally:
        client._model.generate = real
    assert seen[0].shape == seen[1].shape == (1, 3, 28, 28)
    assert not bool((seen[0] == seen[1]).all())


@needs_torch
def test_earlier_turns_stand_before_the_question(client: LlavaDescriber) -> None:
    prompt = Prompt("the light is", history=(("a sign ahead", "stop"),), max_tokens=2)
    asked = client._question(prompt)
    assert asked == "USER : a sign ahead ASSISTANT : stop USER : <image>\nthe light is ASSISTANT :"
    assert client.describe(FRAME, prompt, 60.0).usage["prompt_tokens"] > client.describe(FRAME, PROMPT, 60.0).usage["prompt_tokens"]


@needs_torch
def test_a_model_without_a_template_is_asked_as_llava_was_trained(tmp_path: Path) -> None:
    from tiny_llava import save_tiny_llava

    plain = LlavaDescriber(LlavaSettings(str(save_tiny_llava(tmp_path, template=False)), quantization="none", device="cpu"))
    assert plain._question(Prompt("And?", history=(("A?", "B."),))) == "USER: A? ASSISTANT: B.</s>USER: <image>\nAnd? ASSISTANT:"
    assert not plain.describe(FRAME, PROMPT, 60.0).failure


@needs_torch
def test_writing_stops_at_the_deadline(client: LlavaDescriber) -> None:
    client.describe(FRAME, PROMPT, 60.0)
    prompt = Prompt("Examine", max_tokens=4000)
    began = time.monotonic()
    found = client.describe(FRAME, prompt, 0.3)
    took = time.monotonic() - began
    assert (found.failure, found.text) == ("deadline", "")
    assert took < 0.3 + 0.2
    assert client._calls.wait(5.0), "it goes on writing"
    assert not client.describe(FRAME, PROMPT, 60.0).failure


@needs_torch
def test_a_model_that_is_stuck_holds_nobody_up(client: LlavaDescriber, monkeypatch: pytest.MonkeyPatch) -> None:
    free = threading.Event()
    monkeypatch.setattr(client._model, "generate", lambda **_: free.wait(10.0))
    assert client.describe(FRAME, PROMPT, 0.2).failure == "deadline"
    busy = client.describe(FRAME, PROMPT, 5.0)
    assert (busy.failure, busy.detail) == ("deadline", "the call before has not ended yet")
    free.set()
    assert client._calls.wait(5.0)


@needs_torch
def test_what_goes_wrong_in_the_model_is_a_failure(client: LlavaDescriber, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(**_: Any) -> None:
        raise RuntimeError("CUDA out of memory")

    assert client.describe(Frame("f", 0.0, b"no picture"), PROMPT, 60.0).failure == "malformed"
    monkeypatch.setattr(client._model, "generate", fail)
    found = client.describe(FRAME, PROMPT, 60.0)
    assert (found.failure, found.detail) == ("malformed", "RuntimeError: CUDA out of memory")


@needs_torch
def test_a_closed_client_writes_nothing(folder: Path) -> None:
    client: Describer = LlavaDescriber(LlavaSettings(str(folder), quantization="none", device="cpu"))
    assert client.provenance == "live"
    assert isinstance(client, Closing)
    threading.Timer(0.2, client.close).start()
    assert client.describe(FRAME, Prompt("Examine", max_tokens=4000), 30.0).failure == "cancelled"
    assert client.describe(FRAME, PROMPT, 60.0).failure == "cancelled"


@needs_torch
def test_a_model_that_is_not_here_says_how_to_fetch_it(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=rf"{tmp_path}/none cannot be loaded: .*; fetch it first: hf download"):
        LlavaDescriber(LlavaSettings(f"{tmp_path}/none", quantization="none"))


@needs_torch
@pytest.mark.parametrize(("row", "bits"), [("7b-4bit", 4), ("13b-8bit", 8)])
def test_the_papers_models_load_in_four_and_eight_bits(row: str, bits: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "bitsandbytes", SimpleNamespace())
    settings = settings_of(row)
    found = load_arguments(settings, "cuda")
    config = found["quantization_config"]
    assert (config.load_in_4bit, config.load_in_8bit) == (bits == 4, bits == 8)
    assert found["device_map"] == {"": "cuda"}
    assert found["local_files_only"]
    if bits == 4:
        assert (config.bnb_4bit_quant_type, config.bnb_4bit_use_double_quant, str(config.bnb_4bit_compute_dtype)) == ("nf4", True, "torch.float16")


@needs_torch
def test_fewer_bits_without_a_gpu_are_refused() -> None:
    with pytest.raises(ModelError, match="4bit loading needs a CUDA GPU; this machine offers cpu: load with quantization='none'"):
        load_arguments(LlavaSettings(), "cpu")


@pytest.mark.parametrize(
    ("wanted", "cuda", "mps", "chosen"),
    [("auto", True, True, "cuda"), ("auto", False, True, "mps"), ("auto", False, False, "cpu"), ("cpu", True, False, "cpu")],
)
def test_the_best_device_that_is_there_is_chosen(wanted: Any, cuda: bool, mps: bool, chosen: str) -> None:
    assert choose_device(wanted, _torch(cuda, mps)) == chosen


def test_a_device_that_is_not_there_is_refused() -> None:
    with pytest.raises(ModelError, match="this machine has no cuda device; there is: cpu"):
        choose_device("cuda", _torch(cuda=False, mps=False))


def _torch(cuda: bool, mps: bool) -> Any:
    """As much of torch as says which devices there are."""
    return SimpleNamespace(
        cuda=SimpleNamespace(is_available=lambda: cuda), backends=SimpleNamespace(mps=SimpleNamespace(is_available=lambda: mps))
    )


def test_without_torch_it_says_what_to_type(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(MissingExtra, match=r"a vision model on this machine needs torch: pip install 'regdb\[local-vlm\]'"):
        LlavaDescriber()


def test_the_paper_measured_four_models() -> None:
    assert {row: (rate.slowest, rate.fastest) for row, rate in PAPER_RATES.items()} == {
        "7b-4bit": (2.0, 2.0), "7b-8bit": (0.5, 1.0), "13b-4bit": (1.0, 2.0), "13b-8bit": (0.2, 0.5),
    }  # fmt: skip
    with pytest.raises(ModelError, match="unknown model '70b'; the paper measured: 7b-4bit"):
        settings_of("70b")
    assert local_llava.LlavaSettings().model == PAPER_RATES["7b-4bit"].model
