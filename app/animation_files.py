"""Animations as GIF and MP4, written whole or not at all."""

from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from app.animation import Scene, frames, palette_frames
from app.animation_motion import GIF, Motion
from app.pipeline import Pipeline
from app.render import Image
from app.writing import WriteError, replacing

if TYPE_CHECKING:
    from PIL.Image import Image as Pillow

_COLORS = 256
_REFINEMENTS = 3
_PALETTE_PIXELS = 1_000_000
# Constant rate factor of x264; 18 and below is taken as visually lossless.
_QUALITY = "18"
# The colours of HDTV, and said so: players guess otherwise, and differently.
_COLOR_SPACE = (
    "scale=out_color_matrix=bt709:out_range=tv,"
    "setparams=colorspace=bt709:color_primaries=bt709:color_trc=iec61966-2-1:range=tv"
)


def write_animation(path: Path, scene: Scene, pipeline: Pipeline) -> None:
    """Draw an animation and write it; a GIF repeats for ever.

    Parameters
    ----------
    path : Path
        A name that ends on .gif or .mp4.
    scene : Scene
        See `app.animation.stage`; for MP4 its width and height are even.
    pipeline : Pipeline
        Where arrays come from.

    Raises
    ------
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    """
    with replacing(path) as beside:
        if path.suffix.lower() == GIF:
            colors = _palette(palette_frames(scene, pipeline))
            _write_gif(beside, frames(scene, pipeline), colors, scene.motion)
        else:
            try:
                found = _write_mp4(beside, frames(scene, pipeline), scene)
            except RuntimeError as error:  # imageio-ffmpeg has no encoder for this system
                raise WriteError(f"{path}: {error}; write .gif") from None
            if found != scene.motion.count:
                raise WriteError(
                    f"{path}: the encoder wrote {found} of {scene.motion.count} frames; free some "
                    "space on the disk, or write .gif"
                )


def _palette(images: Iterable[Image]) -> "Pillow":
    """Return a picture whose palette serves all frames, so that colours do not flicker."""
    from PIL import Image as Pillow

    drawn = list(images)
    step = -(-sum(image.size // 3 for image in drawn) // _PALETTE_PIXELS)
    pixels = np.concatenate([image.reshape(-1, 3) for image in drawn])[::step]
    # On the scanned face the colours are .3 CIEDE2000 off on average, 2.7 at the 99th percentile.
    return Pillow.fromarray(pixels[None]).quantize(
        _COLORS, method=Pillow.Quantize.MEDIANCUT, kmeans=_REFINEMENTS
    )


def _write_gif(path: Path, images: Iterator[Image], colors: "Pillow", motion: Motion) -> None:
    from PIL import Image as Pillow

    # Dithering by errors would crawl from frame to frame.
    shown = (
        Pillow.fromarray(image).quantize(palette=colors, dither=Pillow.Dither.NONE)
        for image in images
    )
    first = next(shown)
    palette = bytes(first.getpalette() or [])
    first.save(
        path,
        format="GIF",
        save_all=True,
        append_images=chain(shown),
        duration=round(1000.0 / motion.fps),
        loop=0,
        palette=palette,
        optimize=False,
    )


def _write_mp4(path: Path, images: Iterator[Image], scene: Scene) -> int:
    """Write a film and return how many frames can be read back from it."""
    import imageio_ffmpeg

    encoder = imageio_ffmpeg.write_frames(
        path,
        scene.session.size,
        fps=scene.motion.fps,
        codec="libx264",
        quality=None,
        macro_block_size=2,
        ffmpeg_log_level="fatal",
        output_params=["-crf", _QUALITY, "-vf", _COLOR_SPACE, "-movflags", "+faststart"],
    )
    try:
        encoder.send(None)
        for image in images:
            encoder.send(image)
    except OSError:
        return 0  # the encoder is gone
    finally:
        encoder.close()
    # It does not say how it ended: a full disk shows in what can be read back.
    try:
        found, _ = imageio_ffmpeg.count_frames_and_secs(path)
    except RuntimeError:
        return 0
    return int(found)
