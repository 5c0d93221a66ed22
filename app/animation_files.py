"""Animations as GIF and MP4 that carry how they were made, written whole or not at all."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from app import gif, mp4
from app.animation import Scene, frames, palette_frames
from app.animation_motion import GIF, MP4
from app.film import Film, Tally, film_of
from app.picture import Picture
from app.pipeline import Pipeline
from app.provenance import Stored, said, understood
from app.render import Image
from app.writing import WriteError, replacing

if TYPE_CHECKING:
    from PIL.Image import Image as Pillow


def write_animation(path: Path, scene: Scene, pipeline: Pipeline) -> Film:
    """Draw an animation and write it with its record; a GIF repeats for ever.

    Parameters
    ----------
    path : Path
        A name that ends on .gif or .mp4.
    scene : Scene
        See `app.animation.stage`; for MP4 its width and height are even.
    pipeline : Pipeline
        Where arrays come from.

    Returns
    -------
    Film
        How it was made.

    Raises
    ------
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    """
    drawn, tally = _Drawn(frames(scene, pipeline)), Tally()
    with replacing(path) as beside:
        if path.suffix.lower() == GIF:
            colors = gif.palette(palette_frames(scene, pipeline))
            gif.write(beside, _counted(gif.indexed(drawn.images(), colors), tally), scene.motion)
            film = film_of(scene, pipeline, drawn.first, tally)
            gif.write_comment(beside, said(film, path.resolve().parent))
            return film
        try:
            found = mp4.write(beside, tally.of(drawn.images()), scene.session.size, scene.motion)
        except RuntimeError as error:  # imageio-ffmpeg has no encoder for this system
            raise WriteError(f"{path}: {error}; write .gif") from None
        if found != scene.motion.count:
            raise WriteError(
                f"{path}: the encoder wrote {found} of {scene.motion.count} frames; free some "
                "space on the disk, or write .gif"
            )
        film = film_of(scene, pipeline, drawn.first, tally)
        with replacing(beside) as told:
            if not mp4.write_comment(beside, told, said(film, path.resolve().parent)):
                raise WriteError(
                    f"{path}: the encoder could not add how it was made; free some space on the "
                    "disk, or write .gif"
                )
        return film


def read_film(path: Path) -> Stored[Film]:
    """Read how an animation was made.

    Parameters
    ----------
    path : Path
        A GIF or MP4 file that `write_animation` wrote.

    Returns
    -------
    Stored
        The record.

    Raises
    ------
    PictureError
        If the file cannot be read, has no record or one that is not understood.
    """
    container = mp4 if path.suffix.lower() == MP4 else gif
    return understood(container.read_comment(path), path, Film)


def _counted(images: "Iterator[Pillow]", tally: Tally) -> "Iterator[Pillow]":
    for image in images:
        tally.add(gif.pixels(image))
        yield image


class _Drawn:
    """Frames as they are drawn, the first one kept."""

    def __init__(self, pictures: Iterator[Picture]) -> None:
        self._pictures = pictures
        self.first: Picture

    def images(self) -> Iterator[Image]:
        for index, picture in enumerate(self._pictures):
            if index == 0:
                self.first = picture
            yield picture.image
