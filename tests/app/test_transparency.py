"""Pictures without a background, laid on what they may be laid on."""

import shutil

import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image

from app.cli.main import main
from app.ground import Ground, ground
from app.likeness import likeness
from app.picture import render
from app.pipeline import Pipeline
from app.provenance import read_pixels, read_record
from app.samples import sample
from app.session import Method, Session
from app.transparency import checks, over, straight, with_alpha, without_need
from app.verifying import verify
from lutcore.errors import ParameterError

CLEAR = Session(
    mesh="sample:torus",
    estimator=Method("rusinkiewicz2004"),
    size=(240, 160),
    background="transparent",
)
FAST = ["--method", "rusinkiewicz2004", "--size", "160x120"]
# Two roundings to 8 bits, of the colour times alpha and of the mixture, half a step each.
ROUNDED = 1


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


def _luminance(grey: float) -> float:
    return ((grey + 0.055) / 1.055) ** 2.4


def test_words_can_be_read_before_black_and_before_white():
    ink = _luminance(ground("transparent").ink)
    assert (ink + 0.05) / 0.05 > 4.5
    assert 1.05 / (ink + 0.05) > 4.5


@pytest.mark.parametrize("text", ["#20242a80", "rgba(1, 2, 3, 0)", "greyish"])
def test_what_is_neither_a_colour_nor_transparent_is_refused(text):
    with pytest.raises(ParameterError, match="transparent"):
        ground(text)
    assert ground("#20242aff") == ground("#20242a") != Ground((0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    "changes",
    [
        {"view": "shade"},
        {"view": "curvature", "strokes": True},
        {"view": "compare", "compared": (Method("lambert"), Method("wrap")), "wipe": 0.4},
        {"mesh": "sample:bunny"},
    ],
)
@pytest.mark.parametrize(("name", "grey"), [("black", 0), ("white", 255)])
def test_laid_on_a_colour_it_is_the_picture_before_that_colour(changes, name, grey, pipeline):
    session = replace(CLEAR, **changes)
    clear = render(session, pipeline).image
    assert clear.shape == (160, 240, 4)
    whole = render(replace(session, background=name), pipeline).image.astype(int)
    apart = np.abs(whole - over(clear, grey)).max(axis=2)
    # Words and dividers have an ink of their own, all else is the same: outlines too.
    inked = (clear[..., 3] > 0) & (np.ptp(clear[..., :3].astype(int), axis=2) <= 2)
    assert apart[~inked].max() <= ROUNDED
    assert np.count_nonzero((clear[..., 3] > 0) & (clear[..., 3] < 255)) > 100
    assert np.count_nonzero(clear[..., 3] == 0) > 3000


def test_a_pixel_half_covered_has_the_colour_that_covers_it():
    drawn = np.array([[[100, 50, 20, 128], [7, 7, 7, 7], [1, 2, 3, 255], [0, 0, 0, 0]]], np.uint8)
    image = straight(drawn)
    assert image[0, 0].tolist() == [199, 100, 40, 128]
    assert image[0, 1].tolist() == [255, 255, 255, 7]
    assert image[0, 2].tolist() == [1, 2, 3, 255]
    np.testing.assert_array_equal(over(image, 0), drawn[..., :3])


def test_checks_go_on_from_tile_to_tile():
    whole = checks(30, 40)
    assert len(np.unique(whole)) == 2
    np.testing.assert_array_equal(checks(10, 9, left=31, bottom=5), whole[15:25, 31:])


def test_an_alpha_channel_that_says_nothing_does_not_count():
    image = np.full((16, 16, 3), 9, np.uint8)
    np.testing.assert_array_equal(without_need(with_alpha(image)), image)
    assert likeness(image, with_alpha(image), None).alike
    clear = with_alpha(image).copy()
    clear[0, 0, 3] = 254
    assert without_need(clear) is clear
    assert not likeness(image, clear, None).alike


def test_what_differs_before_white_only_differs():
    one = np.zeros((40, 40, 4), np.uint8)
    other = one.copy()
    other[10:30, 10:30, 3] = 255  # black on black, but not on white
    found = likeness(one, other, 5.0)
    assert not found.alike
    assert found.local > 90.0


@pytest.fixture
def clear(tmp_path):
    shutil.copy(sample("torus").path, tmp_path / "m.ply")
    picture = tmp_path / "p.png"
    words = ["shade", str(tmp_path / "m.ply"), "-o", str(picture), *FAST]
    assert main([*words, "--background", "transparent", "--quiet"]) == 0
    return picture


def test_a_transparent_picture_is_drawn_again_from_itself(clear):
    with Image.open(clear) as picture:
        assert picture.mode == "RGBA"
    assert read_record(clear).record.session.background == "transparent"
    found = verify(clear, Pipeline())
    assert found.same
    assert found.likeness.pixels == 0
    laid = clear.with_name("laid.png")
    with Image.open(clear) as picture:
        on_white = Image.new("RGBA", picture.size, "white")
        on_white.alpha_composite(picture)
        chunks = picture.info
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add_itxt("curvelight", chunks["curvelight"])
    on_white.save(laid, pnginfo=info)
    assert verify(laid, Pipeline()).repainted


def test_a_reference_may_be_transparent(clear, capsys):
    words = ["shade", str(clear.with_name("m.ply")), "-o", str(clear.with_name("o.png")), *FAST]
    same = [*words, "--background", "transparent", "--reference", str(clear)]
    assert main([*same, "--quiet"]) == 0
    assert main([*words, "--reference", str(clear), "--quiet"]) == 6
    shown = read_pixels(clear.with_name("o-difference.png"))
    assert shown.shape[2] == 3
    np.testing.assert_array_equal(shown[:12, :12], checks(120, 160)[:12, :12])


@pytest.mark.parametrize("ending", ["gif", "mp4"])
def test_animations_say_that_they_cannot(ending, clear, capsys):
    output = clear.with_name(f"a.{ending}")
    words = ["shade", str(clear.with_name("m.ply")), "-o", str(output), *FAST]
    assert main([*words, "--turntable", "1", "--background", "transparent"]) == 2
    assert "cannot be transparent: say --background COLOR" in capsys.readouterr().err
    assert not output.exists()


def test_a_batch_shows_it_on_the_sheet(clear, tmp_path):
    folder = tmp_path / "batch"
    words = ["batch", str(clear.with_name("m.ply")), "-o", str(folder), *FAST]
    assert main([*words, "--background", "transparent", "--quiet"]) == 0
    picture = next(one for one in folder.glob("*.png") if one.name != "contact.png")
    assert read_pixels(picture).shape[2] == 4
    sheet = read_pixels(folder / "contact.png")
    assert (sheet == np.uint8((0x20, 0x24, 0x2A))).all(axis=2).mean() > 0.5
