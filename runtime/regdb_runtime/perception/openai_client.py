"""A vision model behind any server that speaks OpenAI's protocol (vLLM, Ollama, llama.cpp, LM Studio): one request, one answer, in time."""

from __future__ import annotations

import http.client
import json
import os
import socket
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

from regdb_runtime.errors import RequestError
from regdb_runtime.observation import Provenance
from regdb_runtime.perception.bounded import BoundedCalls, DeadlinePassed, StillBusy
from regdb_runtime.perception.crops import PictureError, PictureSettings, as_sent, need_pillow
from regdb_runtime.perception.describer import Description, Failure, Frame, Prompt
from regdb_runtime.perception.server_profiles import PROFILES, ServerProfile, Structured, response_format

_SCHEMA_REFUSED = ("response_format", "json_schema", "schema", "grammar", "guided", "structured")


@dataclass(frozen=True)
class ServerSettings:
    """One server and its model.

    `base_url`: up to and with `/v1`; empty takes the profile's. `key_variable`: the environment variable that holds the key, if one is
    needed. `largest_answer`: bytes of a response, beyond which it is refused unread. `picture`: how frames are made small; None sends them
    as they come. `temperature` 0 and a fixed `seed`: the same frame gives the same words, as far as the server keeps that.
    """

    model: str
    profile: str = "vllm"
    base_url: str = ""
    key_variable: str = ""
    largest_answer: int = 65_536
    picture: PictureSettings | None = field(default_factory=PictureSettings)
    temperature: float = 0.0
    seed: int = 0


class _Refused(Exception):  # noqa: N818  # reads as what it says
    """An exchange that ends in a failure, which is an answer too."""

    def __init__(self, failure: Failure, detail: str) -> None:
        super().__init__(detail)
        self.failure, self.detail = failure, detail


class OpenAIDescriber:
    """Keeps the Describer protocol. The standard library's HTTP, for its sockets can be cut: a deadline counts from the call to the answer.

    A server that refuses a request for its schema is asked in prose from the next call on. Redirects are not followed, nothing is retried,
    proxies of the environment are not used. Raises RequestError for settings that make no sense, MissingExtra without Pillow.
    """

    provenance: Provenance = "live"

    def __init__(self, settings: ServerSettings) -> None:
        self.settings = settings
        self._profile = _profile(settings)
        self._structured: Structured = self._profile.structured
        address = urlsplit(settings.base_url or self._profile.base_url)
        if address.scheme not in {"http", "https"} or not address.hostname:
            raise RequestError(f"{settings.base_url!r} is no address of a server; write it as {self._profile.base_url}")
        if settings.picture is not None:
            need_pillow()
        self._secure, self._host, self._port = address.scheme == "https", address.hostname, address.port
        self._path = f"{address.path.rstrip('/')}/chat/completions"
        self._calls = BoundedCalls("vision-request")
        self._socket: socket.socket | None = None
        self._closed = False

    @property
    def structured(self) -> Structured:
        """How answers are constrained now; `none` once the server has refused a schema."""
        return self._structured

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """Ask once. Never raises, never outlasts `deadline` (wall-clock seconds from now)."""
        began = time.monotonic()
        if self._closed:
            return self._failed("cancelled", "the client is closed", began)
        try:
            return self._calls.call(lambda: self._ask(frame, prompt, deadline, began), deadline, self._cut)
        except DeadlinePassed:
            return self._failed("deadline", f"no answer within {deadline:g} s", began)
        except StillBusy:
            return self._failed("deadline", "the call before has not ended yet", began)
        except Exception as error:  # noqa: BLE001  # a client never raises
            return self._failed(*self._failure(error), began)

    def close(self) -> None:
        """Cancel a call in flight and ask nothing more."""
        self._closed = True
        self._cut()

    def _failed(self, failure: Failure, detail: str, began: float) -> Description:
        return Description("", failure, detail, time.monotonic() - began, self.settings.model)

    def _failure(self, error: Exception) -> tuple[Failure, str]:
        """What an exception means to whoever asked."""
        if self._closed:
            return "cancelled", "the client was closed"
        if isinstance(error, _Refused):
            return error.failure, error.detail
        if isinstance(error, TimeoutError):
            return "deadline", "the server did not answer in time"
        if isinstance(error, PictureError):
            return "malformed", str(error)
        if isinstance(error, (OSError, http.client.HTTPException)):
            return "connection", f"{self._host}: {error or type(error).__name__}"
        return "malformed", f"{type(error).__name__}: {error}"

    def _cut(self) -> None:
        """Shut the socket of a call in flight: whatever blocks on it returns."""
        sock = self._socket
        if sock is not None:
            try:
                sock.shutdown(socket.SHUT_RDWR)
            except OSError:
                return  # it was shut already

    def _ask(self, frame: Frame, prompt: Prompt, deadline: float, began: float) -> Description:
        body = json.dumps(self._request(frame, prompt)).encode()
        kind = http.client.HTTPSConnection if self._secure else http.client.HTTPConnection
        connection = kind(self._host, self._port, timeout=self._left(deadline, began))
        try:
            connection.connect()
            self._socket = connection.sock  # the connection forgets its socket once the headers are read; the body still comes through it
            connection.sock.settimeout(self._left(deadline, began))
            connection.request("POST", self._path, body, self._headers())
            with connection.getresponse() as response:
                status, reason, told = response.status, response.reason, self._body(response)
        finally:
            self._socket = None
            connection.close()
        if status != http.client.OK:
            raise self._status(status, reason, told, prompt)
        return self._described(told, time.monotonic() - began)

    def _left(self, deadline: float, began: float) -> float:
        """Seconds that are left. Raises _Refused when there are none, or the client is closed."""
        left = deadline - (time.monotonic() - began)
        if self._closed:
            raise _Refused("cancelled", "the client was closed")
        if left <= 0:
            raise _Refused("deadline", f"no answer within {deadline:g} s")
        return left

    def _headers(self) -> dict[str, str]:
        found = {"Content-Type": "application/json", "Accept": "application/json", "Accept-Encoding": "identity", "Connection": "close"}
        key = os.environ.get(self.settings.key_variable, "") if self.settings.key_variable else ""
        return found | ({"Authorization": f"Bearer {key}"} if key else {})

    def _request(self, frame: Frame, prompt: Prompt) -> dict[str, Any]:
        picture = as_sent(frame, prompt.crop, self.settings.picture)
        turns = [
            {"role": role, "content": text} for question, answer in prompt.history for role, text in (("user", question), ("assistant", answer))
        ]
        content = [{"type": "image_url", "image_url": {"url": picture.data_uri}}, {"type": "text", "text": prompt.text}]
        return {
            "model": self.settings.model,
            "messages": [*turns, {"role": "user", "content": content}],
            self._profile.tokens: prompt.max_tokens,
            "temperature": self.settings.temperature,
            "seed": self.settings.seed,
            "stream": False,
            **self._profile.further,
            **response_format(self._structured, prompt.schema),
        }

    def _body(self, response: http.client.HTTPResponse) -> bytes:
        """All of the response, as long as it is small. Raises _Refused."""
        most = self.settings.largest_answer
        too_large = _Refused("too_large", f"the answer is larger than {most:,} bytes")
        if response.length is not None and response.length > most:
            raise too_large
        parts, size = [], 0
        while part := response.read1(16_384):
            parts.append(part)
            size += len(part)
            if size > most:
                raise too_large
        if response.length:
            raise _Refused("connection", f"the server closed the connection {response.length} bytes before the end")
        return b"".join(parts)

    def _status(self, status: int, reason: str, told: bytes, prompt: Prompt) -> _Refused:
        said = " ".join(told[:400].decode("utf-8", "replace").split())[:200]
        detail = f"{status} {reason}" + (f": {said}" if said else "")
        if self._structured != "none" and prompt.schema is not None and any(word in said.lower() for word in _SCHEMA_REFUSED):
            self._structured = "none"
            detail += "; from now on it is asked without a schema"
        return _Refused("status", detail)

    def _described(self, told: bytes, took: float) -> Description:
        """The text of the first choice. Raises _Refused for another shape."""
        try:
            answer = json.loads(told)
            choice = answer["choices"][0]
            text, cut = _text(choice["message"]["content"]), choice.get("finish_reason") == "length"
        except (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError):
            shown = " ".join(told[:80].decode("utf-8", "replace").split())
            raise _Refused("malformed", f"no chat completion: {shown or 'an empty body'}") from None
        if not text.strip():
            raise _Refused("malformed", "the model said nothing")
        model = str(answer.get("model") or self.settings.model)
        return Description(text, took=took, model=model, usage=_usage(answer.get("usage")), cut=cut)


def _profile(settings: ServerSettings) -> ServerProfile:
    try:
        return PROFILES[settings.profile]
    except KeyError:
        raise RequestError(f"unknown kind of server {settings.profile!r}; there are: {', '.join(PROFILES)}") from None


def _text(content: object) -> str:
    """A message's words: text, or a list of parts of which some are text. Raises TypeError."""
    if isinstance(content, str):
        return content
    if isinstance(content, list):
        return "".join(str(part["text"]) for part in content if part.get("type") == "text")
    raise TypeError


def _usage(raw: object) -> Mapping[str, int]:
    if not isinstance(raw, dict):
        return {}
    return {str(name): count for name, count in raw.items() if isinstance(count, int) and not isinstance(count, bool)}
