"""Frames made small: what is in them stays, at the size and within the time that a model needs."""

import io

import pytest
from camera_frames import FRAME, picture
from PIL import Image
from regdb_runtime.perception.crops import PictureError, PictureSettings, as_sent, widened
from regdb_runtime.perception.describer import Box, Frame

SETTINGS = PictureSettings()


def opened(image: bytes) -> Image.Image:
    return Image.open(io.BytesIO(image)).convert("RGB")


def test_a_large_frame_becomes_small_and_keeps_its_form() -> None:
    found = as_sent(FRAME, None, SETTINGS)
    assert (found.width, found.height, found.media_type) == (1024, 576, "image/jpeg")
    assert opened(found.image).size == (1024, 576)
    assert len(found.image) < len(FRAME.image) + 20_000


def test_a_small_frame_is_not_made_larger() -> None:
    found = as_sent(Frame("f", 0.0, picture(320, 180)), None, SETTINGS)
    assert (found.width, found.height) == (320, 180)


def test_a_crop_shows_the_sign_at_its_full_size() -> None:
    """The red square at (960, 270) with 60 pixels a side, and a quarter of that around it."""
    found = as_sent(FRAME, (960.0, 270.0, 1020.0, 330.0), SETTINGS)
    image = opened(found.image)
    assert image.size == (90, 90)
    assert image.getpixel((45, 45)) == pytest.approx((220, 20, 20), abs=8)
    assert image.getpixel((3, 3)) == pytest.approx((90, 110, 130), abs=8)


@pytest.mark.parametrize(
    ("crop", "part"),
    [
        ((900.0, 200.0, 1000.0, 300.0), (875, 175, 1025, 325)),
        ((0.0, 0.0, 100.0, 100.0), (0, 0, 125, 125)),
        ((1900.0, 1070.0, 2000.0, 1200.0), (1875, 1038, 1920, 1080)),
        ((500.0, 500.0, 510.0, 510.0), (473, 473, 537, 537)),
    ],
)
def test_a_crop_has_room_around_it_and_stays_within_the_frame(crop: Box, part: tuple[int, ...]) -> None:
    assert widened(crop, 1920, 1080, SETTINGS) == part


@pytest.mark.parametrize("crop", [(2000.0, 0.0, 2100.0, 50.0), (50.0, 0.0, 50.0, 50.0), (60.0, 0.0, 50.0, 50.0), (float("nan"), 0.0, 50.0, 50.0)])
def test_a_crop_outside_the_frame_is_refused(crop: Box) -> None:
    with pytest.raises(PictureError, match="is not within a frame of 1920 x 1080"):
        as_sent(FRAME, crop, SETTINGS)


def test_a_crop_is_made_also_where_frames_go_as_they_come() -> None:
    assert as_sent(FRAME, None, None).image is FRAME.image
    assert as_sent(FRAME, (960.0, 270.0, 1020.0, 330.0), None).width == 90


def test_what_is_no_picture_is_refused() -> None:
    half = FRAME.image[: len(FRAME.image) // 2]
    for image in (b"", b"no picture", half):
        with pytest.raises(PictureError, match="frame f cannot be decoded"):
            as_sent(Frame("f", 0.0, image), None, SETTINGS)


def test_a_picture_too_large_is_refused_before_it_is_decoded() -> None:
    with pytest.raises(PictureError, match="a frame of 1920 x 1080 pixels is too large"):
        as_sent(FRAME, None, PictureSettings(most_pixels=1_000_000))


def test_other_formats_and_transparency_become_plain_pictures() -> None:
    out = io.BytesIO()
    Image.new("RGBA", (40, 30), (255, 0, 0, 128)).save(out, "PNG")
    found = as_sent(Frame("f", 0.0, out.getvalue(), "image/png"), None, SETTINGS)
    assert found.data_uri.startswith("data:image/jpeg;base64,/9j/")
    assert opened(found.image).size == (40, 30)


def test_a_square_has_the_whole_frame_in_its_middle() -> None:
    image = opened(as_sent(FRAME, None, PictureSettings(longest=336, square=True)).image)
    assert image.size == (336, 336)
    assert [image.getpixel((x, 168)) for x in (1, 334)] == [pytest.approx((90, 110, 130), abs=6)] * 2
    assert image.getpixel((168, 10)) == pytest.approx((122, 116, 104), abs=6)
