"""A line on stderr for work that takes longer than half a second, on a terminal only, gone when the work is done."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE_S = 0.5


@contextmanager
def working(what: str) -> Iterator[None]:
    """Say what is being done once it has taken `PATIENCE_S` seconds."""
    if not sys.stderr.isatty():
        yield
        return
    shown = threading.Event()
    timer = threading.Timer(PATIENCE_S, _say, (what, shown))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        if shown.is_set():
            sys.stderr.write("\r" + " " * (len(what) + 4) + "\r")
            sys.stderr.flush()


def _say(what: str, shown: threading.Event) -> None:
    shown.set()
    sys.stderr.write(f"{what} ...")
    sys.stderr.flush()
