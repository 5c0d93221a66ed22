"""How like two pictures are: bit for bit, or as eyes see them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.render import Image
from app.transparency import checks, over, with_alpha
from app.writing import replacing
from lutcore.arrays import FloatArray

THRESHOLD = 5.0
"""Largest CIEDE2000 averaged over `WINDOW` pixels squared, where none is given.

Drivers differ most at outlines: one that smooths none is up to 4.2 from one that takes four
samples, on the samples at 600 pixels; a missing colour bar is 81.
"""
WINDOW = 11
"""Side of the squares that CIEDE2000 is averaged over, pixels."""
LEAST_SSIM = 0.98
"""Least structural similarity of pictures that are alike."""
_STRIP = 24
_LETTERS = 15
_INK = 220
# Of the pixels that differ, the percentile that is as bright as any: few are far off at outlines.
_BRIGHT = 90.0


@dataclass(frozen=True, eq=False)
class Likeness:
    """How like a picture is to the one that was expected.

    Parameters
    ----------
    alike : bool
        The verdict: no pixel differs, or, where a threshold is given, no eye tells.
    threshold : float or None
        Largest local CIEDE2000 that was allowed; None where every bit counted.
    pixels : int
        How many pixels differ; all of them where the sizes do.
    total : int
        Of the picture.
    local : float
        Largest CIEDE2000 averaged over 11 x 11 pixels; infinite where the sizes differ. What is
        transparent is seen before black and before white, and the worse counts.
    largest : float
        Largest CIEDE2000 of a pixel; infinite where the sizes differ.
    ssim : float
        Mean structural similarity, 1 for equal pictures; 0 where the sizes differ.
    sizes : tuple of 2 tuples of 2 ints
        Width and height of the expected and of the other picture.
    difference : ndarray, shape=(height, width), or None
        CIEDE2000 of each pixel; None where the sizes differ.
    least_ssim : float
        Least SSIM that was allowed, where a threshold is given.
    """

    alike: bool
    threshold: float | None
    pixels: int
    total: int
    local: float
    largest: float
    ssim: float
    sizes: tuple[tuple[int, int], tuple[int, int]]
    difference: FloatArray | None
    least_ssim: float = LEAST_SSIM

    @property
    def sentence(self) -> str:
        """The measures and what was asked of them."""
        if self.difference is None:
            (width, height), (other_width, other_height) = self.sizes
            return f"{width} x {height} pixels were expected, not {other_width} x {other_height}"
        if not self.pixels:
            return f"all {self.total:,} pixels are the same, bit for bit"
        asked = (
            "not a bit may differ"
            if self.threshold is None
            else f"at most {self.threshold:g} and at least {self.least_ssim} may be"
        )
        return (
            f"{self.pixels:,} of {self.total:,} pixels differ; CIEDE2000 up to {self.local:.3g} "
            f"over {WINDOW} x {WINDOW} pixels, SSIM {self.ssim:.4f}; {asked}"
        )

    def as_json(self) -> dict[str, object]:
        """Return the measures as plain data.

        Returns
        -------
        dict
            Without the difference of each pixel.
        """
        return {
            "alike": self.alike,
            "threshold": self.threshold,
            "pixels": self.pixels,
            "total": self.total,
            "ciede2000_local": self.local,
            "ciede2000_largest": self.largest,
            "ssim": self.ssim,
            "least_ssim": None if self.threshold is None else self.least_ssim,
        }


def likeness(
    expected: Image, other: Image, threshold: float | None, least_ssim: float = LEAST_SSIM
) -> Likeness:
    """Compare two pictures.

    Parameters
    ----------
    expected, other : ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB.
    threshold : float or None
        Largest CIEDE2000, averaged over 11 x 11 pixels, of pictures that are alike. None asks for
        the same bits.
    least_ssim : float
        What their SSIM must be at least, where a threshold is given.

    Returns
    -------
    Likeness
        The verdict with its measures.
    """
    height, width = expected.shape[:2]
    sizes = (width, height), (other.shape[1], other.shape[0])
    if expected.shape[:2] != other.shape[:2]:
        return Likeness(
            False, threshold, height * width, height * width, np.inf, np.inf, 0.0, sizes, None
        )
    differing = (with_alpha(expected) != with_alpha(other)).any(axis=2)
    pixels, difference = int(np.count_nonzero(differing)), np.zeros((height, width))
    if not pixels:
        return Likeness(True, threshold, 0, height * width, 0.0, 0.0, 1.0, sizes, difference)
    from scipy.ndimage import uniform_filter
    from skimage.metrics import structural_similarity

    from lutcore.metrics import ciede2000

    ssim = 1.0
    for one, two in _seen(expected, other):
        found = ciede2000(one[differing], two[differing])
        difference[differing] = np.maximum(difference[differing], found)
        ssim = min(ssim, float(structural_similarity(one, two, channel_axis=2)))
    local = float(uniform_filter(difference, WINDOW).max())
    alike = threshold is not None and local <= threshold and ssim >= least_ssim
    largest = float(difference.max())
    return Likeness(
        alike,
        threshold,
        pixels,
        height * width,
        local,
        largest,
        ssim,
        sizes,
        difference,
        least_ssim,
    )


def _seen(one: Image, other: Image) -> list[tuple[Image, Image]]:
    """Return two pictures as they are seen: before black and before white, where they let through.

    Alike before both, they are alike before any grey between.
    """
    if one.shape[2] == other.shape[2] == 3:
        return [(one, other)]
    return [(over(one, grey), over(other, grey)) for grey in (0, 255)]


def write_difference(path: Path, expected: Image, other: Image, found: Likeness) -> None:
    """Write a picture of how two pictures differ: both, and CIEDE2000 from black to bright.

    What is transparent lies on grey checks.

    Parameters
    ----------
    path : Path
        A PNG file.
    expected, other : ndarray of uint8, shape=(height, width, 3 or 4)
        What was compared, of one size.
    found : Likeness
        What was found.

    Raises
    ------
    WriteError
        If it cannot be written.
    """
    from PIL import Image as Pillow
    from PIL import ImageDraw, ImageFont

    from app.colormaps import table

    if found.difference is None:
        raise ValueError("pictures of different sizes have no difference picture")
    height, width = found.difference.shape
    colors = np.rint(255.0 * table("magma")).astype(np.uint8)
    differing = found.difference[found.difference > 0.0]
    top = max(1.0, float(np.percentile(differing, _BRIGHT)) if differing.size else 0.0)
    heat = colors[np.rint(np.minimum(found.difference / top, 1.0) * (len(colors) - 1)).astype(int)]
    sheet = Pillow.new("RGB", (3 * width, height + _STRIP))
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(_LETTERS)
    titles = "expected", "found", f"CIEDE2000: bright is {top:.3g} or more"
    for index, (image, title) in enumerate(zip((expected, other, heat), titles, strict=True)):
        laid = over(image, checks(height, width))
        sheet.paste(Pillow.fromarray(laid), (index * width, 0))
        pen.text((index * width + 4, height + 2), title, fill=(_INK,) * 3, font=font)
    with replacing(path) as beside:
        sheet.save(beside, format="PNG")
