"""Pictures that carry how they were made: the only way that PNG files of a session are written.

The record is JSON in a text chunk called ``curvelight``, which image viewers show. A digest tells
whether it was edited since; it is no signature, for anybody can make another.
"""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import msgspec
import numpy as np
from msgspec.structs import replace

from app.portable import portable
from app.record import Record
from app.render import Image
from app.session import Session, SessionError
from app.transparency import without_need
from app.writing import replacing
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from PIL.ImageFile import ImageFile

R = TypeVar("R", bound=Record)
KEYWORD = "curvelight"
_DIGEST = "digest"
_LARGEST = 16384


class PictureError(SessionError):
    """A picture cannot be read, or does not say how it was made."""


@dataclass(frozen=True)
class Stored(Generic[R]):
    """What a picture says of itself.

    Parameters
    ----------
    record : Record
        How it was made; the mesh's path is taken from the picture's own folder.
    edited : bool
        Whether the record is not the one that was written.
    """

    record: R
    edited: bool


def write_picture(path: Path, image: Image, record: Record) -> None:
    """Write a picture as PNG with its record, whole or not at all.

    Parameters
    ----------
    path : Path
        Where to.
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB.
    record : Record
        See `app.record.record_of`; the mesh's path follows the picture.

    Raises
    ------
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    """
    from PIL import Image as Pillow
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add_itxt(KEYWORD, said(record, path.resolve().parent))
    with replacing(path) as beside:
        # Level 1 writes five times faster than the default for a tenth more bytes.
        Pillow.fromarray(image).save(beside, format="PNG", compress_level=1, pnginfo=info)


def said(record: Record, folder: Path) -> str:
    """Return a record as text, with its digest.

    Parameters
    ----------
    record : Record
        How a picture was made.
    folder : Path
        Where it will lie: the mesh's path begins there.

    Returns
    -------
    str
        JSON.
    """
    session = replace(record.session, mesh=portable(record.session.mesh, folder))
    fields: dict[str, Any] = msgspec.to_builtins(replace(record, session=session))
    return msgspec.json.encode(fields | {_DIGEST: _digest(fields)}).decode()


def read_record(path: Path) -> Stored[Record]:
    """Read how a picture was made.

    Parameters
    ----------
    path : Path
        A PNG file that `write_picture` wrote.

    Returns
    -------
    Stored
        The record.

    Raises
    ------
    PictureError
        If the file cannot be read, has no record or one that is not understood.
    """
    with opened(path, "PNG") as picture:
        text = str(picture.text.get(KEYWORD, ""))  # type: ignore[attr-defined]  # a PNG has it
    return understood(text, path, Record)


def understood(text: str, path: Path, kind: type[R]) -> Stored[R]:
    """Return the record that text says.

    Parameters
    ----------
    text : str
        As `said` makes it; empty where a file has none.
    path : Path
        The file.
    kind : type
        Of record.

    Returns
    -------
    Stored
        The record.

    Raises
    ------
    PictureError
        If there is none, or one that is not understood.
    """
    if not text:
        raise PictureError(
            f"{path}: does not say how it was made: another program wrote it, or removed its "
            "metadata; take the file as Curvelight wrote it"
        )
    try:
        fields = msgspec.json.decode(text)
        stated = fields.pop(_DIGEST)
    except (msgspec.MsgspecError, UnicodeError, AttributeError, KeyError, TypeError):
        raise PictureError(
            f"{path}: its metadata is damaged; take the file as Curvelight wrote it"
        ) from None
    edited = stated != _digest(fields)
    try:
        record = msgspec.convert(fields, kind)
    except (msgspec.MsgspecError, ValueError, ParameterError) as error:
        raise PictureError(f"{path}: {_misunderstood(fields, edited)} ({error})") from None
    return Stored(replace(record, session=_placed(record.session, path)), edited)


def read_pixels(path: Path) -> Image:
    """Read a picture's pixels.

    Parameters
    ----------
    path : Path
        Any PNG file.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB; with alpha only where something can be seen through.

    Raises
    ------
    PictureError
        If it cannot be read.
    """
    with opened(path, "PNG") as picture:
        clear = "transparency" in picture.info or "A" in picture.getbands()
        return without_need(np.asarray(picture.convert("RGBA" if clear else "RGB")))


@contextmanager
def opened(path: Path, kind: str) -> "Iterator[ImageFile]":
    """Open a picture and say what is wrong with it.

    Parameters
    ----------
    path : Path
        The file.
    kind : str
        Its format, by Pillow's name.

    Yields
    ------
    PIL.ImageFile.ImageFile
        The picture.

    Raises
    ------
    PictureError
        If it cannot be read.
    """
    from PIL import Image as Pillow
    from PIL import UnidentifiedImageError
    from PIL.ImageFile import ImageFile

    # The largest picture of a session is no attack.
    Pillow.MAX_IMAGE_PIXELS = max(Pillow.MAX_IMAGE_PIXELS or 0, _LARGEST**2)
    try:
        with Pillow.open(path, formats=[kind]) as picture:
            picture.load()
            assert isinstance(picture, ImageFile)
            yield picture
    except FileNotFoundError:
        problem = "there is no such file; check its name and folder"
    except IsADirectoryError:
        problem = "it is a folder; name a picture inside it"
    except PermissionError:
        problem = "it may not be read; ask for permission to read it"
    except UnidentifiedImageError:
        problem = f"it is no {kind} picture; name one that Curvelight wrote"
    except (OSError, SyntaxError, ValueError, Pillow.DecompressionBombError) as error:
        problem = f"it is damaged ({error}); copy or make it again"
    else:
        return
    raise PictureError(f"{path}: {problem}")


def _digest(fields: dict[str, Any]) -> str:
    return hashlib.sha256(msgspec.json.encode(fields, order="sorted")).hexdigest()


def _misunderstood(fields: dict[str, Any], edited: bool) -> str:
    if edited:
        return "its metadata was edited and makes no sense any more; take the file as it was"
    versions = fields.get("versions")
    maker = versions.get("curvelight") if isinstance(versions, dict) else None
    return f"made by Curvelight {maker}, whose metadata this version cannot read; install that one"


def _placed(session: Session, path: Path) -> Session:
    if session.mesh.startswith("sample:") or Path(session.mesh).is_absolute():
        return session
    return replace(session, mesh=str(path.parent / session.mesh))
