"""GLB, the one-file form of glTF 2.0: all triangles of the scene in world coordinates.

Own code, since trimesh ignores normalised and sparse accessors and fans (vertices come out wrong
or missing without a word) and lets indices out of range pass; VTK's reader can kill the process.
"""

import struct
from pathlib import Path

from app.loading.errors import BadContentError
from app.loading.gltf import document_of
from app.loading.gltf_buffers import Buffers
from app.loading.gltf_surface import scene_surface
from app.loading.surface import RawSurface

_JSON, _BIN = 0x4E4F534A, 0x004E4942


def read(content: bytes, folder: Path) -> RawSurface:
    """Read a GLB file.

    Parameters
    ----------
    content : bytes
        The whole file.
    folder : Path
        Where it lies, for data that it keeps in files of their own.

    Returns
    -------
    RawSurface
        See `app.loading.gltf_surface`.

    Raises
    ------
    BadContentError
        If it is damaged, cut short or compressed.
    """
    text, binary = _chunks(content)
    document = document_of(text)
    return scene_surface(document, Buffers(document, len(content), folder, binary))


def _chunks(content: bytes) -> tuple[bytes, bytes]:
    if len(content) < 20:
        raise BadContentError(f"it is too short for a GLB header: {len(content)} bytes")
    _, version, total = struct.unpack_from("<4sII", content)
    if version != 2:
        raise BadContentError(f"it is GLB version {version}", "export it as glTF 2.0")
    if total > len(content):
        raise BadContentError(f"its header promises {total} bytes, the file has {len(content)}")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= total:
        length, kind = struct.unpack_from("<II", content, at)
        at += 8
        if at + length > total:
            raise BadContentError(f"a chunk of {length} bytes at byte {at} reaches beyond its end")
        chunks.setdefault(kind, content[at : at + length])
        at += length
    return chunks.get(_JSON, b""), chunks.get(_BIN, b"")
