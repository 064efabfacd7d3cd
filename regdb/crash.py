"""Our own errors: one line for the person, the whole story in a saved report."""

import platform
import sys
import tempfile
import traceback
from pathlib import Path

from regdb.version import VERSION


def report_crash(error: BaseException) -> str:
    """Save a report of an unexpected error and say where it is, in one line."""
    story = "".join(traceback.format_exception(error))
    text = f"regdb {VERSION}, Python {platform.python_version()}, {platform.system()}\n{' '.join(sys.argv)}\n\n{story}"
    try:
        with tempfile.NamedTemporaryFile("w", prefix="regdb-", suffix=".txt", delete=False, encoding="utf-8") as file:
            file.write(text)
            where = str(Path(file.name))
    except OSError:
        where = "(the report could not be saved)"
    return f"internal error: {type(error).__name__}: {error}; please report it with {where}"
