"""A server that speaks OpenAI's protocol over real HTTP and misbehaves as it is told: slow, dripping, garbage, cut off, too large."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any


def completion(text: str) -> bytes:
    """A chat completion that says this."""
    choice = {"index": 0, "message": {"role": "assistant", "content": text}, "finish_reason": "stop"}
    usage = {"prompt_tokens": 600, "completion_tokens": 20, "total_tokens": 620}
    return json.dumps({"id": "c", "object": "chat.completion", "model": "stub-7b", "choices": [choice], "usage": usage}).encode()


Behaviour = Callable[["Handler"], None]
"""What is done with a request."""


@dataclass
class Stub:
    """The server: its address, what it does with the next request, and what it was asked."""

    url: str
    behaviour: Behaviour
    requests: list[dict[str, Any]] = field(default_factory=list)
    headers: list[Mapping[str, str]] = field(default_factory=list)
    over: threading.Event = field(default_factory=threading.Event)


class Handler(BaseHTTPRequestHandler):
    """One request: read it, note it, misbehave."""

    protocol_version = "HTTP/1.1"
    server: Server

    def do_POST(self) -> None:  # the name the library calls
        body = self.rfile.read(int(self.headers["Content-Length"]))
        stub = self.server.stub
        stub.requests.append(json.loads(body) | {"path": self.path})
        stub.headers.append(dict(self.headers))
        self.close_connection = True
        try:
            stub.behaviour(self)
        except OSError:
            return  # the client has cut the connection, as it should

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002  # the library's own names
        """Say nothing."""

    def answer(self, body: bytes, status: int = 200, declared: int | None = None) -> None:
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body) if declared is None else declared))
        self.end_headers()
        self.wfile.write(body)

    def pause(self, seconds: float) -> None:
        """Wait, but not beyond the end of the test."""
        self.server.stub.over.wait(seconds)


class Server(ThreadingHTTPServer):
    """A server whose handlers know the stub."""

    daemon_threads = True
    stub: Stub

    def handle_error(self, request: object, client_address: object) -> None:
        """A client that hangs up is no error here."""


@contextmanager
def serving(behaviour: Behaviour) -> Iterator[Stub]:
    """A stub server on a free port of this machine, until the block ends."""
    server = Server(("127.0.0.1", 0), Handler)
    stub = server.stub = Stub(f"http://127.0.0.1:{server.server_address[1]}/v1", behaviour)
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        yield stub
    finally:
        stub.over.set()
        server.shutdown()
        server.server_close()
        thread.join(5)


def says(text: str) -> Behaviour:
    """The right answer."""
    return lambda handler: handler.answer(completion(text))


def slow(seconds: float, text: str = "A red light.") -> Behaviour:
    """The right answer, too late."""

    def behave(handler: Handler) -> None:
        handler.pause(seconds)
        handler.answer(completion(text))

    return behave


def dripping(text: str, every: float, *, headers: bool = False) -> Behaviour:
    """A byte now and then: no phase of the exchange ever takes long, all of them together do."""

    def behave(handler: Handler) -> None:
        body = completion(text)
        head = f"HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n".encode()
        handler.wfile.write(b"" if headers else head)
        for byte in (head + body) if headers else body:
            handler.pause(every)
            handler.wfile.write(bytes([byte]))
            handler.wfile.flush()

    return behave


def raw(body: bytes, status: int = 200, declared: int | None = None) -> Behaviour:
    """These bytes, whatever they are; `declared` is what the headers say of their length."""
    return lambda handler: handler.answer(body, status, declared)


def chunked(part: bytes, times: int) -> Behaviour:
    """A body in chunks, of a length that nobody declared."""

    def behave(handler: Handler) -> None:
        handler.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n")
        for _ in range(times):
            handler.wfile.write(f"{len(part):x}\r\n".encode() + part + b"\r\n")
        handler.wfile.write(b"0\r\n\r\n")

    return behave


def hanging_up(handler: Handler) -> None:
    """Close without a word."""
    handler.connection.close()
