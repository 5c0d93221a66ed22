"""Where the vertices of a mesh lie in the table of psi."""

from typing import TYPE_CHECKING

import numpy as np

from lutcore.arrays import AnyArray, FloatArray

if TYPE_CHECKING:
    from lutcore.shading import ShadingInputs


def table_arguments(inputs: "ShadingInputs", light: int) -> FloatArray:
    """Return the argument of psi at each vertex under one light.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene; where it has detail, each channel's own surface counts.
    light : int
        Index of the light.

    Returns
    -------
    ndarray, shape=(3, n)
        u = |N.w| / (l_u |S+ w_t|) by channel; infinite where the surface does not bend towards
        the light, so that nothing is added to Lambert's cosine.
    """
    row = inputs.lights[light]
    towards = np.broadcast_to(row[1:4], inputs.points.shape)
    if row[0] != 0.0:  # not directional
        towards = row[1:4] - inputs.points
        towards = towards / np.linalg.norm(towards, axis=1, keepdims=True)
    seen = inputs.detail
    out = np.empty((3, len(inputs.points)))
    for channel, length in enumerate(inputs.table.mean_free_path):
        normals = inputs.normals if seen is None else seen.normals[channel]
        shape = inputs.shape if seen is None else seen.shape[channel]
        height = np.abs(np.einsum("ij,ij->i", normals, towards))
        bend = length * _bending(shape, towards)
        out[channel] = np.divide(height, bend, out=np.full(len(height), np.inf), where=bend > 0.0)
    return out


def _bending(shape: FloatArray, towards: FloatArray) -> FloatArray:
    xx, yy, zz, xy, yz, xz = shape.T
    x, y, z = towards.T
    along = np.stack([xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z])
    bend: FloatArray = np.linalg.norm(along, axis=0)
    return bend


def within(arguments: FloatArray, channel: int, low: float, high: float) -> AnyArray:
    """Return the vertices whose argument lies in a range.

    Parameters
    ----------
    arguments : ndarray, shape=(3, n)
        From `table_arguments`.
    channel : int
        Whose.
    low, high : float
        Ends of the range, both in it.

    Returns
    -------
    ndarray of bool, shape=(n,)
        Which.
    """
    chosen: AnyArray = (arguments[channel] >= low) & (arguments[channel] <= high)
    return chosen
