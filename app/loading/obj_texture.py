"""The textures of an OBJ file: ``vt`` lines, and ``map_Kd`` of the material files beside it."""

import re
from pathlib import Path

import numpy as np

from app.loading.beside import beside
from app.loading.errors import BadContentError
from app.loading.surface import RawPicture, RawTexture
from app.loading.text import numbers
from lutcore.arrays import AnyArray, FloatArray

_PLACE = re.compile(rb"^[ \t]*vt[ \t]+([^\n#]*)", re.MULTILINE)
_USE = re.compile(rb"^[ \t]*usemtl[ \t]+([^\n#]*)", re.MULTILINE)
_LIBRARY = re.compile(rb"^[ \t]*mtllib[ \t]+([^\n#]*)", re.MULTILINE)
_CORNER = re.compile(rb"(?<!\S)[^\s/]+(?:/([^\s/]*))?(?:/\S*)?")
# Options of a map and how many values follow each.
_OPTIONS = {
    b"-blendu": 1,
    b"-blendv": 1,
    b"-bm": 1,
    b"-boost": 1,
    b"-cc": 1,
    b"-clamp": 1,
    b"-imfchan": 1,
    b"-mm": 2,
    b"-o": 3,
    b"-s": 3,
    b"-t": 3,
    b"-texres": 1,
}


def texture_of(
    content: bytes,
    faces: list[re.Match[bytes]],
    counts: AnyArray,
    folder: Path,
    warnings: list[str],
    others: list[bytes],
) -> RawTexture | None:
    """Return what an OBJ file wraps around its surface.

    Parameters
    ----------
    content : bytes
        The file with joined lines.
    faces : list of match
        Its face lines, their corners in group 1.
    counts : ndarray of int, shape=(f,)
        Corners of each.
    folder : Path
        Where the file lies. No file outside this folder is opened.
    warnings : list of str
        Grows by what cannot be used: a broken texture never hides the mesh.
    others : list of bytes
        Grows by the files that were read along.

    Returns
    -------
    RawTexture or None
        None where it has none, or none that can be used.
    """
    libraries = [match.group(1).strip() for match in _LIBRARY.finditer(content)]
    if not libraries or not faces or not _PLACE.search(content):
        return None
    maps: dict[bytes, str] = {}
    for library in libraries:
        found = _read(folder, library, warnings, others)
        if found is not None:
            maps |= _maps(found)
    names = list(dict.fromkeys(maps.values()))
    if not names:
        return None
    try:
        places = _places(content)
        corners = _corners(content, faces, counts, len(places))
    except BadContentError as error:
        warnings.append(f"its texture coordinates cannot be used: {error.problem}")
        return None
    pictures = [_read(folder, name.encode(), warnings, others) for name in names]
    images = [
        RawPicture(name, data)
        for name, data in zip(names, pictures, strict=True)
        if data is not None
    ]
    number = {picture.name: index for index, picture in enumerate(images)}
    of_material = {material: number.get(name, -1) for material, name in maps.items()}
    if not images:
        return None
    uv = np.full((len(corners), 2), np.nan)
    uv[corners >= 0] = places[corners[corners >= 0]]
    return RawTexture(uv, _which(content, faces, of_material), images)


def _read(folder: Path, name: bytes, warnings: list[str], others: list[bytes]) -> bytes | None:
    try:
        # Written on Windows, whose folders end with a backslash.
        found = beside(folder, name.decode("utf-8", "replace").strip('"').replace("\\", "/"))
    except BadContentError as error:
        warnings.append(f"texture: {error.problem}")
        return None
    others.append(found)
    return found


def _maps(library: bytes) -> dict[bytes, str]:
    """Return the picture of each material that has one."""
    found: dict[bytes, str] = {}
    material = b""
    for line in library.splitlines():
        key, _, rest = line.strip().partition(b" ")
        if key == b"newmtl":
            material = rest.strip()
        elif key.lower() == b"map_kd":
            words = rest.split()
            while words and words[0].lower() in _OPTIONS:
                words = words[1 + _OPTIONS[words[0].lower()] :]
            if words:
                found[material] = b" ".join(words).decode("utf-8", "replace")
    return found


def _places(content: bytes) -> FloatArray:
    lines = [match.group(1).split()[:2] for match in _PLACE.finditer(content)]
    if min(map(len, lines)) < 2:
        raise BadContentError("a 'vt' line has fewer than two numbers")
    table = numbers(b"\n".join(map(b" ".join, lines)), first_line=None)
    return table.reshape(-1, 2)


def _corners(
    content: bytes, faces: list[re.Match[bytes]], counts: AnyArray, places: int
) -> AnyArray:
    """Return the place of each corner, -1 for none."""
    text = b"\n".join(match.group(1) for match in faces)
    words = _CORNER.sub(lambda match: match.group(1) or b"0", text)
    found = numbers(words, first_line=None).astype(np.int64)
    if len(found) != counts.sum():
        raise BadContentError("a face line holds something other than indices")
    relative = found < 0
    if relative.any():
        starts = np.fromiter((match.start() for match in _PLACE.finditer(content)), np.int64)
        lines = np.fromiter((match.start() for match in faces), np.int64)
        before = np.repeat(np.searchsorted(starts, lines), counts)
        found[relative] += before[relative] + 1
        found[relative & (found < 1)] = places + 1
    if (found > places).any():
        raise BadContentError(f"a face uses one of them that does not exist, of {places}")
    return found - 1


def _which(content: bytes, faces: list[re.Match[bytes]], of_material: dict[bytes, int]) -> AnyArray:
    uses = list(_USE.finditer(content))
    kinds = np.array([-1] + [of_material.get(use.group(1).strip(), -1) for use in uses])
    if not uses and len(of_material) == 1:
        # A file that never says which material is meant has the only one.
        kinds[0] = next(iter(of_material.values()))
    starts = np.fromiter((use.start() for use in uses), np.int64, len(uses))
    lines = np.fromiter((match.start() for match in faces), np.int64, len(faces))
    return np.asarray(kinds[np.searchsorted(starts, lines)])
