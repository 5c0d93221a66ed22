"""What an open mesh loses of the light: near its borders the truth is not in it."""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.lut import PsiTable
from lutcore.mesh import TriangleMesh
from lutcore.shading import ShadingInputs
from lutcore.topology import edges
from lutcore.weld import weld


def light_lost(inputs: ShadingInputs) -> FloatArray:
    """Bound the share of its light that each vertex would get from beyond the mesh's borders.

    A scan ends where the scanner saw no more, the body goes on. Light that would enter there is
    missing from what is gathered over the mesh, so that near a border, or a hole, neither the
    gathered light nor a model's distance from it says anything. Beyond a straight border at the
    distance x the profile holds L0(x)/R_d of its light: no more comes from there, however it is
    lit, and less through a hole.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene.

    Returns
    -------
    ndarray, shape=(n,)
        0 to 1/2, of the channel where it is most; 0 on a closed mesh.
    """
    lost = np.zeros(len(inputs.points))
    welded = weld(TriangleMesh(inputs.points, inputs.faces))
    if welded.mesh is None:
        return lost
    found = edges(welded.mesh.faces, len(welded.mesh.vertices))
    ends = welded.mesh.vertices[found.ends[found.boundary]]
    if not len(ends):
        return lost
    from scipy.spatial import cKDTree

    border = cKDTree(np.concatenate([ends[:, 0], ends[:, 1], ends.mean(axis=1)]))
    far = border.query(welded.mesh.vertices)[0] * inputs.mm_per_unit
    share = beyond(inputs.table, far)
    held = welded.index >= 0
    lost[held] = share[welded.index[held]]
    return lost


def beyond(table: PsiTable, distance: FloatArray) -> FloatArray:
    """Return the share of the light that spreads farther than a distance to one side.

    Parameters
    ----------
    table : PsiTable
        Of the material and the profile.
    distance : ndarray, shape=(n,)
        From a straight border, mm.

    Returns
    -------
    ndarray, shape=(n,)
        L0/R_d = -psi', of the channel where it is most.
    """
    share = np.zeros(len(distance))
    for channel, length in enumerate(table.mean_free_path):
        t = np.linspace(0.0, table.reach[channel], table.psi.shape[1])
        held = -table.slope[channel] / np.cosh(t)  # dpsi/dt = psi' cosh t
        share = np.maximum(share, np.interp(np.arcsinh(distance / length), t, held, right=0.0))
    return share
