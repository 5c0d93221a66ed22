"""Small pictures of the gallery's meshes, drawn without OpenGL."""

import io
from typing import Any

import numpy as np

from app.render import Image
from lutcore.arrays import AnyArray, FloatArray
from lutcore.gallery.case import Case
from lutcore.geometry import face_areas

_CLOSE = 8.0  # spacings from the middle of a close view to its sides
_FRONT, _BACK = np.array([0.78, 0.80, 0.83]), np.array([0.84, 0.37, 0.0])
_FROM, _LIGHT = np.array([0.35, -0.75, 0.6]), np.array([-0.3, -0.4, 0.9])


def thumbnails(case: Case, pixels: int) -> Image:
    """Draw a case's broken mesh, whole and from near.

    Parameters
    ----------
    case : Case
        The case.
    pixels : int
        Height, and width of either view.

    Returns
    -------
    ndarray of uint8, shape=(pixels, 2 pixels, 3)
        sRGB; right, triangles around a vertex that is judged. Faces seen from behind are orange.
    """
    points = case.broken.mesh.vertices
    corners = points[case.broken.mesh.faces]
    used = corners.reshape(-1, 3)
    middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
    judged = points[case.broken.judged]
    centre = judged.mean(axis=0)
    spacing = float(np.sqrt(2.0 * face_areas(case.broken.mesh).mean()))
    towards = _FROM
    reach = np.linalg.norm(judged - centre, axis=1).max()
    if len(judged) < 0.5 * len(points) and reach < 2.0 * _CLOSE * spacing:
        # Damage in one place is seen from outside, a little from the side; in the mesh's middle,
        # across its longest axis.
        away = centre - middle
        if np.linalg.norm(away) > spacing:
            towards = away / np.linalg.norm(away) + 0.9 * _sideways(away)
        else:
            towards = _sideways(np.linalg.eigh(np.cov(used.T))[1][:, -1])
    else:
        centre = judged[np.argmax(judged @ _FROM)]
    close = np.linalg.norm(corners.mean(axis=1) - centre, axis=1) < 1.5 * _CLOSE * spacing
    whole = _draw(corners, middle, 0.0, towards, pixels)
    return np.hstack([whole, _draw(corners[close], centre, _CLOSE * spacing, towards, pixels)])


def png(image: Image) -> bytes:
    """Return a small picture as the content of a PNG file, of 128 colours for a third the bytes.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3)
        sRGB.

    Returns
    -------
    bytes
        The file.
    """
    from PIL import Image as Pillow

    out = io.BytesIO()
    Pillow.fromarray(image).quantize(128).save(out, format="PNG", optimize=True)
    return out.getvalue()


def _draw(
    corners: FloatArray, middle: FloatArray, reach: float, towards: FloatArray, pixels: int
) -> Image:
    """Draw triangles from far to near; a reach of 0 shows all, any other their edges too."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

    towards = towards / np.linalg.norm(towards)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right = right / np.linalg.norm(right)
    screen = np.stack([right, np.cross(towards, right)], axis=1)
    order = np.argsort((corners.mean(axis=1) - middle) @ towards)
    flat = ((corners - middle) @ screen)[order]
    edges = "#00000070" if reach else "face"
    if not reach:
        low, high = flat.min(axis=(0, 1)), flat.max(axis=(0, 1))
        flat = flat - 0.5 * (low + high)
        reach = 0.53 * float((high - low).max())
    figure = Figure(figsize=(1.0, 1.0), dpi=pixels)
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    colors = _colors(corners[order], towards)
    width = 45.0 / pixels  # points, 72 of which are `pixels`
    axes.add_collection(
        PolyCollection(list(flat), facecolors=colors, edgecolors=edges, linewidths=width)
    )
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _sideways(vector: FloatArray) -> FloatArray:
    across = np.cross(vector, [0.0, 0.0, 1.0] if abs(vector[2]) < 0.9 else [1.0, 0.0, 0.0])
    return across / np.linalg.norm(across)


def _colors(corners: FloatArray, towards: FloatArray) -> AnyArray:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(length > 0.0, length, 1.0)
    behind = normals @ towards < 0.0
    lit = np.where(behind, -1.0, 1.0) * (normals @ (_LIGHT / np.linalg.norm(_LIGHT)))
    light = 0.45 + 0.55 * np.clip(lit, 0.0, 1.0)
    return light[:, None] * np.where(behind[:, None], _BACK, _FRONT)
