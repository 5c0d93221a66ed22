"""The models as they look, side by side, with maps of how far they are from the reference."""

import io
from collections.abc import Sequence

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from app.picture import render
from app.pipeline import Pipeline
from app.session import Method, Session
from lutcore.progress import Progress, tell
from lutcore.shading import model_registry

REFERENCE = "jensen2002"
# Panels in a row, the reference included, and their pixels.
_ACROSS, _PANEL = 5, 320
# Colours of the maps end here: what differs more is plainly another colour.
_END = 10.0


def strip(
    session: Session, pipeline: Pipeline, names: Sequence[str], progress: Progress
) -> NDArray[np.uint8]:
    """Draw the local models, and below each its CIEDE2000 against the gathered reference.

    Parameters
    ----------
    session : Session
        Everything but its models and its size is used.
    pipeline : Pipeline
        Where arrays come from.
    names : sequence of str
        Models; those that are not local are left out.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB. The reference begins each row; one camera, one exposure and one scale for all.

    Raises
    ------
    DrawingError
        If this machine has no working OpenGL.
    CancelledError
        If `progress` asked to stop.
    """
    local = [Method(name) for name in names if model_registry.get(name).local]
    rows = [local[at : at + _ACROSS - 1] for at in range(0, len(local), _ACROSS - 1)]
    images = []
    for at, row in enumerate(rows):
        tell(progress, at / len(rows), "drawing the models")
        shown = replace(
            session,
            view="compare",
            compared=(Method(REFERENCE), *row),
            compared_by="model",
            wipe=None,
            difference=True,
            range=(0.0, _END),
            size=(_PANEL * (len(row) + 1), 2 * _PANEL),
        )
        made = render(shown, pipeline)
        session = replace(session, exposure=made.exposure, camera=made.camera)
        images.append(made.image)
    width = max(image.shape[1] for image in images)
    return np.vstack([_widened(image, width) for image in images])


def png(image: NDArray[np.uint8]) -> bytes:
    """Return a picture as the content of a PNG file.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB.

    Returns
    -------
    bytes
        The file.
    """
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(image).save(out, format="PNG", optimize=True)
    return out.getvalue()


def _widened(image: NDArray[np.uint8], width: int) -> NDArray[np.uint8]:
    """Fill up a row with its background, which is in its corner."""
    more = np.broadcast_to(image[0, -1], (len(image), width - image.shape[1], image.shape[2]))
    return np.concatenate([image, more], axis=1)
