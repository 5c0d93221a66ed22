"""GIF files: one palette for all frames, and a comment."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from app.animation_motion import Motion
from app.provenance import opened
from app.render import Image

if TYPE_CHECKING:
    from PIL.Image import Image as Pillow

_COLORS = 256
_REFINEMENTS = 3
_PALETTE_PIXELS = 1_000_000
_COMMENT, _END, _LONGEST = b"\x21\xfe", b"\x00", 255
_HEADER, _FLAGS = 13, 10


def palette(images: Iterable[Image]) -> "Pillow":
    """Return a picture whose palette serves all frames, so that colours do not flicker.

    Parameters
    ----------
    images : iterable of ndarray of uint8, shape=(height, width, 3)
        A few frames over the whole animation.

    Returns
    -------
    PIL.Image.Image
        For `indexed`.
    """
    from PIL import Image as Pillow

    drawn = list(images)
    step = -(-sum(image.size // 3 for image in drawn) // _PALETTE_PIXELS)
    pixels = np.concatenate([image.reshape(-1, 3) for image in drawn])[::step]
    # On the scanned face the colours are .3 CIEDE2000 off on average, 2.7 at the 99th percentile.
    return Pillow.fromarray(pixels[None]).quantize(
        _COLORS, method=Pillow.Quantize.MEDIANCUT, kmeans=_REFINEMENTS
    )


def indexed(images: Iterable[Image], colors: "Pillow") -> "Iterator[Pillow]":
    """Return frames in the nearest colours of a palette.

    Parameters
    ----------
    images : iterable of ndarray of uint8, shape=(height, width, 3)
        Frames.
    colors : PIL.Image.Image
        From `palette`.

    Yields
    ------
    PIL.Image.Image
        Each of them.
    """
    from PIL import Image as Pillow

    for image in images:
        # Dithering by errors would crawl from frame to frame.
        yield Pillow.fromarray(image).quantize(palette=colors, dither=Pillow.Dither.NONE)


def pixels(image: "Pillow") -> Image:
    """Return a frame as it is seen.

    Parameters
    ----------
    image : PIL.Image.Image
        From `indexed`, or from a file.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3)
        sRGB.
    """
    return np.asarray(image.convert("RGB"))


def write(path: Path, images: "Iterator[Pillow]", motion: Motion) -> None:
    """Write frames; they repeat for ever.

    Parameters
    ----------
    path : Path
        Where to.
    images : iterator of PIL.Image.Image
        Frames of one palette, from `indexed`.
    motion : Motion
        How long each is shown.
    """
    first = next(images)
    first.save(
        path,
        format="GIF",
        save_all=True,
        append_images=images,
        duration=_milliseconds(motion),
        loop=0,
        palette=bytes(first.getpalette() or []),
        optimize=False,
    )


def write_comment(path: Path, text: str) -> None:
    """Put a comment before the frames of a GIF file that has one palette.

    Parameters
    ----------
    path : Path
        The file.
    text : str
        What it shall say.
    """
    content, said = path.read_bytes(), text.encode()
    blocks = (said[at : at + _LONGEST] for at in range(0, len(said), _LONGEST))
    comment = _COMMENT + b"".join(bytes([len(one)]) + one for one in blocks) + _END
    frames = _HEADER + 3 * 2 ** ((content[_FLAGS] & 7) + 1)  # behind the palette
    path.write_bytes(content[:frames] + comment + content[frames:])


def read_comment(path: Path) -> str:
    """Return the comment of a GIF file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    str
        Empty if it has none.

    Raises
    ------
    PictureError
        If it cannot be read.
    """
    with opened(path, "GIF") as picture:
        said = picture.info.get("comment", b"")
        return bytes(said).decode(errors="replace")


def read(path: Path, motion: Motion) -> Iterator[Image]:
    """Return the frames of a GIF file, each as often as it lasts frames of a motion.

    Parameters
    ----------
    path : Path
        The file.
    motion : Motion
        What it shows: frames that do not differ are stored as one that lasts longer.

    Yields
    ------
    ndarray of uint8, shape=(height, width, 3)
        sRGB.

    Raises
    ------
    PictureError
        If it cannot be read.
    """
    from PIL import ImageSequence

    with opened(path, "GIF") as picture:
        for frame in ImageSequence.Iterator(picture):
            lasts = frame.info.get("duration", 0) / _milliseconds(motion)
            image = pixels(frame)
            for _ in range(max(1, round(lasts))):
                yield image


def _milliseconds(motion: Motion) -> int:
    return round(1000.0 / motion.fps)
