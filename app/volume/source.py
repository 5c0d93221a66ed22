"""Whether a path is a volume, in which format, and which files it is made of."""

import re
import zlib
from dataclasses import dataclass
from pathlib import Path

from app.volume.metaimage_header import KEY, data_files

_HEAD = 4096
_GZIP = b"\x1f\x8b"
_TIFF = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_SLICES = (".tif", ".tiff")
_SUFFIXES = {
    ".nii": "nifti",
    ".nii.gz": "nifti",
    ".mha": "metaimage",
    ".mhd": "metaimage",
    ".vti": "vti",
    ".tif": "tiff",
    ".tiff": "tiff",
}


@dataclass(frozen=True)
class Source:
    """Where a surface comes from.

    Parameters
    ----------
    path : Path
        The file or folder that the user named.
    format : str or None
        nifti, metaimage, vti or tiff, the module of `app.volume` that reads it; None for what is
        no volume, which `app.loading` reads or refuses.
    files : tuple of Path
        All files that the surface depends on.
    """

    path: Path
    format: str | None
    files: tuple[Path, ...]


def source_of(path: Path) -> Source:
    """Tell a volume from a mesh, by its content and, where that is damaged, by its name.

    Parameters
    ----------
    path : Path
        A file, a folder of TIFF slices, or anything else.

    Returns
    -------
    Source
        What it is; a path that cannot be read is no volume, so that the mesh loader says why.
    """
    try:
        if path.is_dir():
            slices = tuple(sorted(_slices(path), key=_natural))
            return Source(path, "tiff" if slices else None, slices or (path,))
        if not path.is_file():
            return Source(path, None, (path,))
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except (OSError, ValueError):
        return Source(path, None, (path,))
    found = _by_content(head) or (_by_name(path) if head else None)
    files = (path, *data_files(path, head)) if found == "metaimage" else (path,)
    return Source(path, found, files)


def _slices(folder: Path) -> list[Path]:
    # macOS leaves "._slice.tif" beside each file that it copies.
    return [
        one
        for one in folder.iterdir()
        if one.suffix.lower() in _SLICES and not one.name.startswith(".") and one.is_file()
    ]


def _natural(path: Path) -> list[tuple[int, int, str]]:
    """Order slice9 before slice10."""
    words = re.split(r"(\d+)", path.name)
    return [(0, int(word), word) if word.isdecimal() else (1, 0, word) for word in words]


def _by_content(head: bytes) -> str | None:
    plain = _unpacked(head) if head.startswith(_GZIP) else head
    # NIfTI-1 has its magic at byte 344 of 348, NIfTI-2 at byte 4 of 540.
    if plain[344:348] == b"n+1\0" or plain[4:8] == b"n+2\0":
        return "nifti"
    if head.startswith(_TIFF):
        return "tiff"
    if re.search(rb"<VTKFile[^>]*\btype\s*=\s*[\"']ImageData[\"']", head):
        return "vti"
    if b"DimSize" in head and KEY.match(head) and re.search(rb"^NDims\s*=", head, re.MULTILINE):
        return "metaimage"
    return None


def _unpacked(head: bytes) -> bytes:
    try:
        return zlib.decompressobj(wbits=31).decompress(head, 1024)
    except zlib.error:
        return b""


def _by_name(path: Path) -> str | None:
    name = path.name.lower()
    return next((kind for end, kind in _SUFFIXES.items() if name.endswith(end)), None)
