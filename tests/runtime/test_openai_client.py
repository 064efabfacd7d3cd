"""The client over real HTTP against a server that misbehaves: an answer or a failure, always before the deadline."""

import base64
import io
import socket
import sys
import threading
import time
from typing import Any

import pytest
from camera_frames import FRAME
from PIL import Image
from regdb_runtime.errors import MissingExtra, RequestError
from regdb_runtime.perception import openai_client
from regdb_runtime.perception.crops import PictureSettings
from regdb_runtime.perception.describer import Closing, Describer, Description, Frame, Prompt
from regdb_runtime.perception.openai_client import OpenAIDescriber, ServerSettings
from regdb_runtime.perception.server_profiles import PROFILES
from stub_server import Behaviour, chunked, completion, dripping, hanging_up, raw, says, serving, slow

SCHEMA = {"type": "object", "properties": {"seen": {"type": "array"}}}
LATE = 0.05
"""Seconds by which a call may outlast its deadline."""

PROMPT = Prompt("Examine the current driving scenario.")


def ask(behaviour: Behaviour, deadline: float = 5.0, prompt: Prompt = PROMPT, frame: Frame = FRAME, **settings: Any) -> tuple[Description, Any]:
    """One call to a server that behaves so; the description, and what the server was asked."""
    with serving(behaviour) as stub:
        client = OpenAIDescriber(ServerSettings("stub-7b", base_url=stub.url, **settings))
        found = client.describe(frame, prompt, deadline)
        client._calls.wait(2.0)
        return found, stub


def sent_image(request: dict[str, Any]) -> Image.Image:
    uri = request["messages"][-1]["content"][0]["image_url"]["url"]
    head, _, data = uri.partition(",")
    assert head == "data:image/jpeg;base64"
    return Image.open(io.BytesIO(base64.b64decode(data)))


def test_a_right_answer_comes_back_with_what_it_cost() -> None:
    found, stub = ask(says("The traffic light is red."))
    assert found.text == "The traffic light is red."
    assert (found.failure, found.model, found.usage["completion_tokens"]) == ("", "stub-7b", 20)
    assert 0 < found.took < 5
    (request,) = stub.requests
    assert request["path"] == "/v1/chat/completions"
    assert (request["model"], request["max_tokens"], request["temperature"], request["stream"]) == ("stub-7b", 128, 0.0, False)
    assert request["messages"][0]["content"][1] == {"type": "text", "text": PROMPT.text}
    assert "response_format" not in request
    assert sent_image(request).size == (1024, 576)


def test_the_client_keeps_the_protocol() -> None:
    client: Describer = OpenAIDescriber(ServerSettings("m"))
    assert client.provenance == "live"
    assert isinstance(client, Closing)


def test_a_schema_earlier_turns_and_a_crop_go_along() -> None:
    prompt = Prompt("And now?", SCHEMA, (("What is ahead?", "A stop sign."),), "state", 32, (900.0, 200.0, 1100.0, 400.0))
    found, stub = ask(says('{"seen": []}'), prompt=prompt)
    assert not found.failure
    (request,) = stub.requests
    assert request["response_format"]["json_schema"]["schema"] == SCHEMA
    assert [turn["role"] for turn in request["messages"]] == ["user", "assistant", "user"]
    assert request["messages"][1]["content"] == "A stop sign."
    assert request["max_tokens"] == 32
    assert sent_image(request).size == (300, 300)


@pytest.mark.parametrize("name", sorted(PROFILES))
def test_each_kind_of_server_is_asked_in_its_own_words(name: str) -> None:
    found, stub = ask(says("{}"), prompt=Prompt("?", SCHEMA, max_tokens=7), profile=name)
    assert not found.failure
    (request,) = stub.requests
    assert request[PROFILES[name].tokens] == 7
    assert ("response_format" in request) == (PROFILES[name].structured != "none")


def test_a_key_comes_from_the_environment_and_is_shown_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MY_KEY", "sk-secret")
    found, stub = ask(raw(b"no such key", 401), key_variable="MY_KEY")
    assert stub.headers[0]["Authorization"] == "Bearer sk-secret"
    assert "secret" not in repr(found) + repr(ServerSettings("m", key_variable="MY_KEY"))


def test_without_a_picture_setting_frames_go_as_they_come() -> None:
    _, stub = ask(says("x"), picture=None)
    assert sent_image(stub.requests[0]).size == (1920, 1080)


LATE_ANSWERS = [
    pytest.param(slow(3.0), id="slow"),
    pytest.param(dripping("The light is red.", 0.05), id="dripping body"),
    pytest.param(dripping("The light is red.", 0.05, headers=True), id="dripping headers"),
]


@pytest.mark.parametrize("behaviour", LATE_ANSWERS)
def test_the_deadline_bounds_the_whole_call(behaviour: Behaviour) -> None:
    """The best of three counts: what this machine's other work adds is not the client's."""
    late = []
    with serving(behaviour) as stub:
        client = OpenAIDescriber(ServerSettings("m", base_url=stub.url))
        for _ in range(3):
            began = time.monotonic()
            found = client.describe(FRAME, PROMPT, 0.4)
            late.append(time.monotonic() - began - 0.4)
            assert (found.failure, found.text) == ("deadline", "")
            assert found.took == pytest.approx(0.4, abs=0.4)
            assert client._calls.wait(2.0), "the request given up goes on"
    assert -0.01 < min(late) < LATE


def test_the_call_after_a_late_one_is_served() -> None:
    with serving(slow(3.0)) as stub:
        client = OpenAIDescriber(ServerSettings("m", base_url=stub.url))
        assert client.describe(FRAME, PROMPT, 0.2).failure == "deadline"
        assert client._calls.wait(1.0)
        stub.behaviour = says("A stop sign.")
        assert client.describe(FRAME, PROMPT, 5.0).text == "A stop sign."


MISBEHAVED = [
    pytest.param(raw(b"\x00\xff garbage \x80"), "malformed", "no chat completion", id="garbage"),
    pytest.param(raw(b""), "malformed", "an empty body", id="empty"),
    pytest.param(raw(completion("The light is red.")[:60]), "malformed", "no chat completion", id="half JSON"),
    pytest.param(raw(b'{"choices": []}'), "malformed", "no chat completion", id="no choice"),
    pytest.param(raw(b'{"choices": [{"message": {"content": 5}}]}'), "malformed", "no chat completion", id="a number for words"),
    pytest.param(raw(b'{"choices": [{"message": {"content": null}}]}'), "malformed", "no chat completion", id="null for words"),
    pytest.param(raw(b"[" * 50_000), "malformed", "no chat completion", id="nested too deep"),
    pytest.param(says("  "), "malformed", "said nothing", id="blank"),
    pytest.param(raw(b"out of memory", 500), "status", "500 Internal Server Error: out of memory", id="500"),
    pytest.param(raw(b"", 429), "status", "429", id="too many requests"),
    pytest.param(raw(b"", 302), "status", "302", id="redirect"),
    pytest.param(raw(completion("x" * 10_000_000)), "too_large", "larger than 65,536 bytes", id="10 MB"),
    pytest.param(chunked(b"x" * 10_000, 1_000), "too_large", "larger than 65,536 bytes", id="10 MB in chunks"),
    pytest.param(raw(completion("half"), declared=5_000), "connection", "closed the connection", id="closed in the middle"),
    pytest.param(hanging_up, "connection", "", id="closed at once"),
    pytest.param(lambda handler: handler.wfile.write(b"SSH-2.0-OpenSSH_9\r\n"), "connection", "", id="no HTTP"),
]


@pytest.mark.parametrize(("behaviour", "failure", "detail"), MISBEHAVED)
def test_misbehaviour_is_a_failure_with_its_reason(behaviour: Behaviour, failure: str, detail: str) -> None:
    found, _ = ask(behaviour)
    assert (found.failure, found.text) == (failure, "")
    assert detail in found.detail
    assert len(found.detail) < 300


def test_a_server_that_is_not_there() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        client = OpenAIDescriber(ServerSettings("m", base_url=f"http://127.0.0.1:{taken.getsockname()[1]}/v1"))
        assert client.describe(FRAME, PROMPT, 2.0).failure == "connection"


def test_a_server_that_refuses_a_schema_is_asked_in_prose_from_then_on() -> None:
    with serving(raw(b'{"error": "response_format json_schema is not supported"}', 400)) as stub:
        client = OpenAIDescriber(ServerSettings("m", base_url=stub.url))
        prompt = Prompt("?", SCHEMA)
        assert "asked without a schema" in client.describe(FRAME, prompt, 5.0).detail
        stub.behaviour = says("A stop sign.")
        assert client.describe(FRAME, prompt, 5.0).text == "A stop sign."
        assert ["response_format" in request for request in stub.requests] == [True, False]
        assert client.structured == "none"


def test_another_refusal_does_not_cost_the_schema() -> None:
    with serving(raw(b"model not found", 404)) as stub:
        client = OpenAIDescriber(ServerSettings("m", base_url=stub.url))
        assert client.describe(FRAME, Prompt("?", SCHEMA), 5.0).failure == "status"
        assert client.structured == "json_schema"


def test_closing_cancels_a_call_in_flight() -> None:
    with serving(slow(5.0)) as stub:
        client = OpenAIDescriber(ServerSettings("m", base_url=stub.url))
        threading.Timer(0.2, client.close).start()
        began = time.monotonic()
        assert client.describe(FRAME, PROMPT, 5.0).failure == "cancelled"
        assert time.monotonic() - began < 2.0
        assert client.describe(FRAME, PROMPT, 5.0).failure == "cancelled"
        assert len(stub.requests) == 1


def test_a_frame_that_is_no_picture_is_not_sent() -> None:
    found, stub = ask(says("x"), frame=Frame("f2", 0.0, b"not a picture"))
    assert (found.failure, stub.requests) == ("malformed", [])
    assert "frame f2 cannot be decoded" in found.detail


def test_making_a_frame_small_counts_towards_the_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    free = threading.Event()
    monkeypatch.setattr(openai_client, "as_sent", lambda *_: free.wait(5.0))
    with serving(says("x")) as stub:
        client = OpenAIDescriber(ServerSettings("m", base_url=stub.url))
        began = time.monotonic()
        assert client.describe(FRAME, PROMPT, 0.2).failure == "deadline"
        assert time.monotonic() - began < 0.2 + LATE
        busy = client.describe(FRAME, PROMPT, 0.2)
        assert (busy.failure, busy.detail) == ("deadline", "the call before has not ended yet")
        free.set()
        assert client._calls.wait(2.0)
        assert stub.requests == []


@pytest.fixture
def no_pillow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PIL.Image", None)


@pytest.mark.usefixtures("no_pillow")
def test_without_pillow_it_says_what_to_type() -> None:
    with pytest.raises(MissingExtra, match=r"needs Pillow: pip install 'regdb\[vlm\]'"):
        OpenAIDescriber(ServerSettings("m"))
    assert OpenAIDescriber(ServerSettings("m", picture=None)).settings.picture is None


def test_settings_that_make_no_sense_are_refused() -> None:
    with pytest.raises(RequestError, match="unknown kind of server 'vlm'; there are: vllm"):
        OpenAIDescriber(ServerSettings("m", profile="vlm"))
    with pytest.raises(RequestError, match="is no address of a server; write it as http://localhost:8000/v1"):
        OpenAIDescriber(ServerSettings("m", base_url="localhost:8000"))


def test_a_square_picture_loses_nothing_of_the_frame() -> None:
    _, stub = ask(says("x"), picture=PictureSettings(longest=336, square=True))
    image = sent_image(stub.requests[0]).convert("RGB")
    assert image.size == (336, 336)
    assert image.getpixel((2, 2)) == pytest.approx((122, 116, 104), abs=3)
    assert image.getpixel((2, 168)) == pytest.approx((90, 110, 130), abs=3)
