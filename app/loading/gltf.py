"""glTF 2.0 as JSON text, its numbers in data URIs or in files beside it."""

import json
from pathlib import Path
from typing import Any

from app.loading.errors import BadContentError
from app.loading.gltf_buffers import Buffers
from app.loading.gltf_surface import scene_surface
from app.loading.surface import RawSurface


def read(content: bytes, folder: Path) -> RawSurface:
    """Read a glTF file.

    Parameters
    ----------
    content : bytes
        The whole file.
    folder : Path
        Where it lies.

    Returns
    -------
    RawSurface
        See `app.loading.gltf_surface`.

    Raises
    ------
    BadContentError
        If it is damaged or compressed, or names data that are not there.
    """
    document = document_of(content)
    return scene_surface(document, Buffers(document, len(content), folder))


def document_of(text: bytes) -> dict[str, Any]:
    """Parse the JSON of a glTF file.

    Parameters
    ----------
    text : bytes
        The JSON.

    Returns
    -------
    dict
        What it holds.

    Raises
    ------
    BadContentError
        If it is no JSON object.
    """
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise BadContentError(f"its JSON cannot be read ({error})") from error
    if not isinstance(document, dict):
        raise BadContentError("its JSON is not a glTF document")
    return document
