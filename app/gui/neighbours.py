"""The mesh before and after one, in its folder or among the samples. Knows no Qt."""

from pathlib import Path

from app.loading.formats import FORMATS
from app.samples import PREFIX, names


def neighbour(mesh: str, step: int) -> str | None:
    """Return the mesh that lies beside another.

    Parameters
    ----------
    mesh : str
        A path or ``sample:NAME``.
    step : int
        1 for the next, -1 for the one before.

    Returns
    -------
    str or None
        A path in the same folder, or another sample, in the order of their names, the first after
        the last; None if there is no other.
    """
    if mesh.startswith(PREFIX):
        beside = [PREFIX + name for name in names()]
    else:
        folder = Path(mesh).resolve().parent
        try:
            files = [one for one in folder.iterdir() if one.suffix[1:].lower() in FORMATS]
        except OSError:
            return None
        beside = sorted(str(one) for one in files)
        mesh = str(Path(mesh).resolve())
    if mesh not in beside:
        return beside[0] if beside else None
    return beside[(beside.index(mesh) + step) % len(beside)] if len(beside) > 1 else None
