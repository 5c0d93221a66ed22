"""VTP, the XML poly data of VTK: read by VTK, in a child process because it may crash."""

from app.loading.guard import read_guarded
from app.loading.surface import RawSurface


def read(content: bytes) -> RawSurface:
    """Read a VTP file.

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
        If it is damaged, or VTK crashes on it or goes beyond its time or memory.
    """
    return read_guarded("app.loading.vtp_vtk", content)
