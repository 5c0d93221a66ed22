"""MP4 files: H.264 as players show it, and a comment."""

import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from app.animation_motion import Motion
from app.provenance import PictureError
from app.render import Image

# Constant rate factor of x264; 18 and below is taken as visually lossless.
_QUALITY = "18"
# The colours of HDTV, and said so: players guess otherwise, and differently.
_COLOR_SPACE = (
    "scale=out_color_matrix=bt709:out_range=tv,"
    "setparams=colorspace=bt709:color_primaries=bt709:color_trc=iec61966-2-1:range=tv"
)
_SECONDS = 300
_FIELD = "comment="


def write(path: Path, images: Iterable[Image], size: tuple[int, int], motion: Motion) -> int:
    """Write a film.

    Parameters
    ----------
    path : Path
        Where to.
    images : iterable of ndarray of uint8, shape=(height, width, 3)
        Frames.
    size : tuple of 2 ints
        Width and height, even.
    motion : Motion
        How long each is shown.

    Returns
    -------
    int
        How many frames can be read back from it.

    Raises
    ------
    RuntimeError
        If there is no encoder for this system.
    """
    import imageio_ffmpeg

    encoder = imageio_ffmpeg.write_frames(
        path,
        size,
        fps=motion.fps,
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


def write_comment(path: Path, target: Path, text: str) -> bool:
    """Copy a film and give it a comment: the encoder takes one only before it knows the frames.

    Parameters
    ----------
    path, target : Path
        The film, and where to; not one coded frame changes.
    text : str
        What it shall say.

    Returns
    -------
    bool
        Whether it was written.
    """
    words = ("-codec", "copy", "-movflags", "+faststart", "-metadata", _FIELD + text)
    done = _ffmpeg("-y", "-i", _name(path), *words, _name(target))
    return done.returncode == 0


def read_comment(path: Path) -> str:
    """Return the comment of an MP4 file.

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
    if not path.is_file():
        raise PictureError(f"{path}: there is no such file; check its name and folder")
    done = _ffmpeg("-i", _name(path), "-f", "ffmetadata", "-")
    if done.returncode:
        raise PictureError(f"{path}: it is no MP4 film, or damaged; copy or make it again")
    text = done.stdout.decode(errors="replace")
    said = (line for line in _lines(text) if line.startswith(_FIELD))
    return _unescaped(next(said, _FIELD).removeprefix(_FIELD))


def read(path: Path) -> Iterator[Image]:
    """Return the frames of an MP4 file.

    Parameters
    ----------
    path : Path
        The file.

    Yields
    ------
    ndarray of uint8, shape=(height, width, 3)
        sRGB.

    Raises
    ------
    PictureError
        If it cannot be read.
    """
    import imageio_ffmpeg

    reader = imageio_ffmpeg.read_frames(str(path))
    try:
        about = next(reader)
        width, height = about["size"]
        for frame in reader:
            yield np.frombuffer(frame, np.uint8).reshape(height, width, 3)
    except (RuntimeError, OSError, StopIteration) as error:
        raise PictureError(f"{path}: it is damaged ({error}); copy or make it again") from None
    finally:
        reader.close()


def _ffmpeg(*words: str) -> "subprocess.CompletedProcess[bytes]":
    import imageio_ffmpeg

    command = (imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-nostdin", *words)
    return subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)  # noqa: S603


def _name(path: Path) -> str:
    # So that no name is taken for a flag or for the address of a server.
    return f"file:{path.resolve()}"


def _lines(text: str) -> Iterator[str]:
    """Part text at the ends of lines that no backslash goes before."""
    line = ""
    for part in text.split("\n"):
        line += part
        if (len(part) - len(part.rstrip("\\"))) % 2:
            line += "\n"
            continue
        yield line
        line = ""


def _unescaped(text: str) -> str:
    found, escaped = [], False
    for letter in text:
        escaped = letter == "\\" and not escaped
        if not escaped:
            found.append(letter)
    return "".join(found)
