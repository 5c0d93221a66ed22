"""The mesh in grey, for the moments before its first picture is computed. Knows no Qt.

It needs none of the packages that curvature and shading do, which take a second to load.
"""

from typing import TYPE_CHECKING

import numpy as np

from app.camera import camera_of
from app.composition import Composition
from app.render import STRIP, Panel
from app.scene import Surface
from lutcore.arrays import FloatArray
from lutcore.mesh import TriangleMesh

if TYPE_CHECKING:
    from app.session import Session
    from app.steps.subject import Subject


def preview(session: "Session", subject: "Subject") -> Composition:
    """Return a composition that shows a mesh in grey.

    Parameters
    ----------
    session : Session
        Its camera, size and background are used.
    subject : Subject
        The mesh.

    Returns
    -------
    Composition
        One panel.
    """
    width, height = session.size
    camera = camera_of(session.camera, subject, width / (height * (1.0 - STRIP)), whole=True)
    surface = Surface(subject.mesh, _normals(subject.mesh), lit=True)
    return Composition(session, (Panel(surface, 1.0, camera),), 1, camera, None, {}, None)


def _normals(mesh: TriangleMesh) -> FloatArray:
    """Return unit normals, those of faces weighted by area: good enough for a moment's look."""
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    count = len(mesh.vertices)
    summed = np.stack(
        [
            np.bincount(mesh.faces.ravel(), np.repeat(across[:, axis], 3), minlength=count)
            for axis in range(3)
        ],
        axis=1,
    )
    length = np.linalg.norm(summed, axis=1, keepdims=True)
    normals: FloatArray = summed / np.where(length > 0.0, length, 1.0)
    return normals
