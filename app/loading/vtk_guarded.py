"""VTP, VTU and legacy VTK files: read by VTK, in a child process because it may crash."""

import re

from app.loading.errors import BadContentError
from app.loading.guard import read_guarded
from app.loading.surface import RawSurface

# "NumberOfPoints="12"" of the XML formats, "POINTS 12 float" of the legacy one.
_COUNT = re.compile(
    rb"\bNumberOf(?:Points|Polys|Cells|Strips|Verts|Lines)\s*=\s*[\"'](\d+)[\"']"
    rb"|^(?:POINTS|POLYGONS|CELLS|TRIANGLE_STRIPS|CELL_TYPES)[ \t]+(\d+)",
    re.MULTILINE,
)
# The shortest cell takes two bytes, "3 " without its corners; each block of 32 KiB that is packed
# takes eight at least.
_BYTES_EACH, _UNFOLDING = 2, 4096


def read(content: bytes) -> RawSurface:
    """Read a VTP, VTU or legacy VTK file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        Its points, polygons (or triangle strips, taken apart) and colours.

    Raises
    ------
    BadContentError
        If it is damaged, promises more than it can hold, or VTK crashes on it or goes beyond its
        time or memory.
    lutcore.errors.MeshError
        If it holds data of a kind that has no surface.
    """
    packed = b"compressor" in content[:4096]
    most = len(content) * (_UNFOLDING if packed else 1) // _BYTES_EACH
    for match in _COUNT.finditer(content):
        digits = match.group(1) or match.group(2)
        # Few digits, since Python turns no thousands of them into a number.
        if len(digits.lstrip(b"0")) > 18 or int(digits) > most:
            promised = match.group().decode("ascii", "replace")[:60]
            raise BadContentError(
                f"at byte {match.start()} it says {promised!r}, more than its {len(content)} bytes "
                "can hold"
            )
    return read_guarded("app.loading.vtp_vtk", content)
