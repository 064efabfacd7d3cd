"""A call with a wall-clock bound: it runs on a thread of its own, and whoever waits for it waits no longer than the deadline."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class DeadlinePassed(Exception):  # noqa: N818  # reads as what it says
    """The call did not end in time; it has been told to give up, and its answer, should it still come, is thrown away."""


class StillBusy(Exception):  # noqa: N818
    """The call before was given up but has not ended; a second one beside it would pile up."""


class _Job(Generic[T]):
    """One call: the function, what it returned or raised, and the event that says so."""

    def __init__(self, function: Callable[[], T]) -> None:
        self.function = function
        self.done = threading.Event()
        self.value: T | None = None
        self.error: BaseException | None = None

    def run(self) -> None:
        try:
            self.value = self.function()
        except BaseException as error:  # noqa: BLE001  # handed to whoever waits for it
            self.error = error
        self.done.set()


class BoundedCalls:
    """One call at a time, each on a daemon thread; a time limit of a library counts per phase, and some of its phases have none."""

    def __init__(self, name: str = "perception-call") -> None:
        self._name = name
        self._running: threading.Thread | None = None

    @property
    def busy(self) -> bool:
        """Whether a call, given up or not, has not ended yet."""
        return self._running is not None and self._running.is_alive()

    def call(self, function: Callable[[], T], seconds: float, give_up: Callable[[], object]) -> T:
        """What `function` returns, or raises. After `seconds` `give_up` is called, which should make it end, and DeadlinePassed raised.

        Raises StillBusy at once where the call before has not ended. Meant for one caller.
        """
        if self.busy:
            raise StillBusy
        job = _Job(function)
        self._running = threading.Thread(target=job.run, name=self._name, daemon=True)
        self._running.start()
        if not job.done.wait(max(seconds, 0.0)):
            give_up()
            raise DeadlinePassed
        if job.error is not None:
            raise job.error
        return job.value  # type: ignore[return-value]  # a job that is done and raised nothing has returned a T

    def wait(self, seconds: float) -> bool:
        """Wait for a call that was given up to end; whether it has."""
        if self._running is not None:
            self._running.join(max(seconds, 0.0))
        return not self.busy
