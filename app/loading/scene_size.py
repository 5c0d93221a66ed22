"""How large a scene may unfold out of a file that places its parts again and again."""

from app.loading.errors import BadContentError

# As much memory as a million vertices and twice as many faces take is always granted, and beyond
# that this many bytes for each of the file.
GRANTED, GROWTH = 72_000_000, 64
_VERTEX_BYTES, _CORNER_BYTES = 24, 8


def check_scene_size(vertices: int, corners: int, size: int) -> None:
    """Refuse a scene too large for its file, before any of it is expanded.

    Parameters
    ----------
    vertices : int
        How many vertices it would have.
    corners : int
        How many face corners.
    size : int
        Bytes of the file, and of those that it names.

    Raises
    ------
    BadContentError
        If a few kilobytes would unfold to gigabytes.
    """
    if _VERTEX_BYTES * vertices + _CORNER_BYTES * corners > GRANTED + GROWTH * size:
        raise BadContentError(
            f"its scene has {vertices} vertices and {corners} face corners, out of a file of "
            f"{size} bytes",
            "check that it is not damaged, or export fewer copies of its meshes",
        )
