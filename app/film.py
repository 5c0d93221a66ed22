"""What an animation says of its own making, as plain data: enough to make it again."""

import hashlib
from collections.abc import Iterable, Iterator

from app.animation import Scene
from app.animation_motion import Motion
from app.picture import Picture
from app.pipeline import Pipeline
from app.record import Record, record_of
from app.render import Image


class Film(Record, frozen=True, kw_only=True):
    """How an animation was made; `pixels` is that of all its frames, see `Tally`.

    Parameters
    ----------
    motion : Motion
        What turns, how long, and how many frames show it.
    """

    motion: Motion


class Tally:
    """The SHA-256 of the size and the pixels of frames, as they come."""

    def __init__(self) -> None:
        self.count = 0
        self._hash = hashlib.sha256()

    def add(self, image: Image) -> None:
        """Count a frame.

        Parameters
        ----------
        image : ndarray of uint8, shape=(height, width, 3)
            The next one.
        """
        height, width, _ = image.shape
        self._hash.update(f"{width}x{height}:".encode() + image.tobytes())
        self.count += 1

    def of(self, images: Iterable[Image]) -> Iterator[Image]:
        """Give the same frames, each counted.

        Parameters
        ----------
        images : iterable of ndarray of uint8, shape=(height, width, 3)
            Frames.

        Yields
        ------
        ndarray
            Each of them.
        """
        for image in images:
            self.add(image)
            yield image

    @property
    def digest(self) -> str:
        """Of the frames so far, hexadecimal."""
        return self._hash.hexdigest()


def film_of(scene: Scene, pipeline: Pipeline, first: Picture, tally: Tally) -> Film:
    """Return how an animation was made.

    Parameters
    ----------
    scene : Scene
        See `app.animation.stage`.
    pipeline : Pipeline
        The one that it was drawn with.
    first : Picture
        Its first frame.
    tally : Tally
        Of its frames: those that a GIF holds, and those that were given to the encoder of an MP4.

    Returns
    -------
    Film
        For `app.animation_files`.
    """
    record = record_of(scene.asked, pipeline, first)
    fields = {name: getattr(record, name) for name in Record.__struct_fields__}
    return Film(**fields | {"pixels": tally.digest}, motion=scene.motion)
