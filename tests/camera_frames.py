"""A camera frame for tests of whatever takes one: 1080p, grey, with a red square."""

from __future__ import annotations

import io

from PIL import Image
from regdb_runtime.perception.describer import Frame


def picture(width: int = 1920, height: int = 1080) -> bytes:
    """A JPEG with a red square in it."""
    image = Image.new("RGB", (width, height), (90, 110, 130))
    image.paste((220, 20, 20), (width // 2, height // 4, width // 2 + 60, height // 4 + 60))
    out = io.BytesIO()
    image.save(out, "JPEG")
    return out.getvalue()


FRAME = Frame("f1", 12.5, picture(), width=1920, height=1080)
