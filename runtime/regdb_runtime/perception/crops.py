"""Frames made small for a model: cropped around a sign, resized, padded to a square where a model would cut the sides off, encoded again."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import TYPE_CHECKING

from regdb_runtime.errors import MissingExtra
from regdb_runtime.perception.describer import Box, Frame

if TYPE_CHECKING:
    from PIL.Image import Image


class PictureError(ValueError):
    """An image that cannot be decoded, or is too large to be."""


@dataclass(frozen=True)
class PictureSettings:
    """How a frame is sent.

    `longest`: pixels of the longer side; larger frames are made smaller, never the other way. 1024 keeps a 30 in sign legible at 25 m in a
    1080p frame of 60 degrees (some 30 pixels before, 16 after). `quality`: JPEG, 1-95. `margin`: share of a crop's sides that is added around
    it; `least`: pixels that a crop is at least wide and high. `square`: pad to a square with `grey` (the mean of CLIP's training images, which
    the network sees as nothing), for models that else cut the sides off, as LLaVA-1.5's processor does. `most_pixels`: larger images are
    refused, so that decoding stays a matter of milliseconds.
    """

    longest: int = 1024
    quality: int = 85
    margin: float = 0.25
    least: int = 64
    square: bool = False
    grey: tuple[int, int, int] = (122, 116, 104)
    most_pixels: int = 40_000_000


@dataclass(frozen=True, slots=True)
class Picture:
    """An encoded image as it is sent."""

    image: bytes
    media_type: str
    width: int = 0
    height: int = 0

    @property
    def data_uri(self) -> str:
        """The image as text that goes into a request."""
        return f"data:{self.media_type};base64,{base64.b64encode(self.image).decode('ascii')}"


def need_pillow() -> None:
    """Raise MissingExtra, with the command that installs it, where Pillow is not there."""
    try:
        import PIL.Image  # noqa: F401
    except ImportError:
        raise MissingExtra("Pillow", "vlm", "making frames small for a vision model") from None


def as_sent(frame: Frame, crop: Box | None, settings: PictureSettings | None) -> Picture:
    """The frame, or the crop of it, as a client sends it; without settings and crop just as it came. Raises PictureError, MissingExtra."""
    if settings is None and crop is None:
        return Picture(frame.image, frame.media_type, frame.width, frame.height)
    found = settings or PictureSettings()
    image = small_image(frame, crop, found)
    out = io.BytesIO()
    image.save(out, "JPEG", quality=found.quality)
    return Picture(out.getvalue(), "image/jpeg", *image.size)


def small_image(frame: Frame, crop: Box | None, settings: PictureSettings) -> Image:
    """The frame, or the crop of it, decoded and small, in RGB. Raises PictureError, MissingExtra."""
    need_pillow()
    from PIL import Image

    try:
        image: Image.Image = Image.open(io.BytesIO(frame.image))
        if image.width * image.height > settings.most_pixels:
            raise PictureError(f"a frame of {image.width} x {image.height} pixels is too large")
        if crop is None:
            image.draft("RGB", (settings.longest, settings.longest))
        image = image.convert("RGB")
    except PictureError:
        raise
    except Exception as error:  # noqa: BLE001  # Pillow raises whatever its decoders raise
        raise PictureError(f"frame {frame.id} cannot be decoded: {error}") from None
    if crop is not None:
        image = image.crop(widened(crop, image.width, image.height, settings))
    image.thumbnail((settings.longest, settings.longest))
    return _padded(image, settings) if settings.square else image


def widened(crop: Box, width: int, height: int, settings: PictureSettings) -> tuple[int, int, int, int]:
    """The part of a frame that shows a box with its margin, within the frame. Raises PictureError for a box that lies outside it."""
    left, top, right, bottom = crop
    if not (left < right and top < bottom and left < width and top < height and right > 0 and bottom > 0):
        raise PictureError(f"the crop {crop} is not within a frame of {width} x {height}")
    across = max((right - left) * (1 + 2 * settings.margin), settings.least) / 2
    along = max((bottom - top) * (1 + 2 * settings.margin), settings.least) / 2
    x, y = (left + right) / 2, (top + bottom) / 2
    return max(round(x - across), 0), max(round(y - along), 0), min(round(x + across), width), min(round(y + along), height)


def _padded(image: Image, settings: PictureSettings) -> Image:
    from PIL import Image

    side = max(image.size)
    if image.size == (side, side):
        return image
    whole = Image.new("RGB", (side, side), settings.grey)
    whole.paste(image, ((side - image.width) // 2, (side - image.height) // 2))
    return whole
