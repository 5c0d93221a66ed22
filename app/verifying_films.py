"""Whether an animation is what its own record makes, frame by frame, and if not, why."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

from msgspec.structs import replace

from app import gif, mp4
from app.animation import Scene, frames, palette_frames, stage
from app.animation_files import read_film
from app.animation_motion import MP4
from app.film import Tally, film_of
from app.likeness import LEAST_SSIM, THRESHOLD, Likeness, likeness
from app.picture import Picture
from app.pipeline import Pipeline
from app.record import elsewhere
from app.redrawing import redrawing
from app.render import Image
from app.verifying import Verdict

CODED_THRESHOLD, CODED_SSIM = 12.0, 0.9
"""As `app.likeness.THRESHOLD` and its SSIM, of a film against the frames that were encoded.

Coding is off by up to 7.2 and down to .959 on the samples at 200 to 700 pixels, most of all at
small letters and at outlines of strong colour, for colour is coded at half the resolution.
"""


@dataclass(frozen=True, eq=False)
class FilmVerdict(Verdict):
    """What became of redrawing an animation; `likeness` and both pictures are of its worst frame.

    Parameters
    ----------
    coded : bool
        Whether its frames went through a lossy encoder, as an MP4's do.
    exact : bool
        Whether the frames that were drawn again are, bit for bit, those that were written, or were
        given to the encoder.
    worst : int
        The frame that is least alike, from 0.
    differing : int
        How many frames differ.
    counts : tuple of 2 ints
        How many frames its record and the file have.
    within : bool
        Whether each frame is alike.
    """

    coded: bool
    exact: bool
    worst: int
    differing: int
    counts: tuple[int, int]
    within: bool

    @property
    def alike(self) -> bool:
        """Whether every frame is there and alike, and was drawn again bit for bit if it can be."""
        whole = self.within and self.counts[0] == self.counts[1]
        return whole and (self.exact or not self.coded or bool(self.elsewhere))

    @property
    def untouched(self) -> bool:
        """Whether not a bit differs of what can be compared."""
        return not self.differing or (self.coded and self.exact)

    @property
    def _measure(self) -> str:
        wanted, found = self.counts
        if wanted != found:
            return f"{wanted} frames were written, and the file has {found}"
        if not self.differing:
            return f"all {found} frames are the same, bit for bit"
        frame = f"frame {self.worst + 1}: {self.likeness.sentence}"
        if not self.coded:
            return f"{self.differing} of {found} frames differ, most of all {frame}"
        drawn = (
            "the frames drawn again are bit for bit those that were encoded"
            if self.exact
            else "the frames drawn again are not those that were encoded"
        )
        return f"{drawn}; the film, whose coding loses detail, is furthest from them in {frame}"

    def as_json(self) -> dict[str, object]:
        """Return the verdict as plain data.

        Returns
        -------
        dict
            As `Verdict.as_json`; the likeness is that of the worst frame.
        """
        return super().as_json() | {
            "frames": {"written": self.counts[0], "found": self.counts[1]},
            "frames_differing": self.differing,
            "worst_frame": self.worst,
            "drawn_again_exactly": self.exact,
        }


def verify_film(
    path: Path, pipeline: Pipeline, mesh: str | None = None, threshold: float | None = None
) -> FilmVerdict:
    """Redraw all frames of an animation from what it says of itself, and compare.

    The frames of a GIF must be the same, bit for bit, where the same driver, VTK and kind of
    processor drew them. An MP4 holds the SHA-256 of the frames that were given to its encoder:
    the frames drawn again must have that one, and the film, which lost detail, must be within the
    threshold of them, so that a film whose picture was changed is found out too.

    Parameters
    ----------
    path : Path
        A GIF or MP4 file that Curvelight wrote.
    pipeline : Pipeline
        Where arrays come from.
    mesh : str, optional
        Where the mesh is now, if not where the file says.
    threshold : float, optional
        Largest local CIEDE2000 of any frame (see `app.likeness.likeness`). If not given,
        `THRESHOLD` where not every bit can count, and `CODED_THRESHOLD` for an MP4.

    Returns
    -------
    FilmVerdict
        Same or not, and why.

    Raises
    ------
    PictureError
        If the file cannot be read, has no record, or cannot be redrawn here.
    MeshError, DrawingError
        If the mesh or the machine does not allow it.
    """
    stored = read_film(path)
    then, coded = stored.record, path.suffix.lower() == MP4
    if mesh is not None:
        then = replace(then, session=replace(then.session, mesh=mesh))
    with redrawing(path, then, stored.edited):
        scene = stage(then.session, pipeline, then.motion)
        drawn = frames(scene, pipeline)
        first = next(drawn)
    now_tally, file_tally = Tally(), Tally()
    again = now_tally.of(_shown(scene, pipeline, first, drawn, coded))
    found = file_tally.of(mp4.read(path) if coded else gif.read(path, then.motion))
    now = film_of(scene, pipeline, first, now_tally)
    if threshold is None and (coded or elsewhere(then, now)):
        threshold = CODED_THRESHOLD if coded else THRESHOLD
    worst, likest, pair, differing, within = 0, None, None, 0, True
    for index, (one, other) in enumerate(zip_longest(found, again)):
        if one is None or other is None:
            continue  # counted to the end, and told
        alike = likeness(one, other, threshold, CODED_SSIM if coded else LEAST_SSIM)
        differing += alike.pixels > 0
        within = within and alike.alike
        if likest is None or _badness(alike) > _badness(likest):
            worst, likest, pair = index, alike, (one, other)
    assert likest is not None and pair is not None  # a file has a frame, and so has a motion
    now = replace(now, pixels=now_tally.digest)
    exact = now.pixels == then.pixels
    return FilmVerdict(
        then=then,
        now=now,
        edited=stored.edited,
        repainted=exact and not within if coded else file_tally.digest != then.pixels,
        likeness=likest,
        expected=pair[0],
        redrawn=pair[1],
        coded=coded,
        exact=exact,
        worst=worst,
        differing=differing,
        counts=(then.motion.count, file_tally.count),
        within=within,
    )


def _shown(
    scene: Scene, pipeline: Pipeline, first: Picture, rest: Iterator[Picture], coded: bool
) -> Iterator[Image]:
    """Give the frames as the file has them, but for what an encoder loses."""

    def images() -> Iterator[Image]:
        yield first.image
        for picture in rest:
            yield picture.image

    if coded:
        return images()
    colors = gif.palette(palette_frames(scene, pipeline))
    return map(gif.pixels, gif.indexed(images(), colors))


def _badness(found: Likeness) -> tuple[bool, float, int]:
    return not found.alike, found.local, found.pixels
