"""What a shading model gets and returns, and the call that runs one."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import prange
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, IndexArray, finite
from lutcore.baking import resolved
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.lights import Light, pack
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh
from lutcore.parameters import Parameters, create
from lutcore.registry import Registry


@dataclass(frozen=True)
class ShadingInputs:
    """All that a local shading model may depend on, vertex by vertex.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    normals : ndarray, shape=(n, 3)
        Outward unit normals; zero where there is none, which `shade` makes dark.
    shape : ndarray, shape=(n, 6)
        Positive (convex) part S+ of the shape operator as a symmetric tensor of the tangent
        plane, 1/mm, in the order xx, yy, zz, xy, yz, xz. Concave curvature is 0, as section 3 of
        Kolchin 2007 clamps it.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    material : Material
        What the surface is made of.
    """

    points: FloatArray
    normals: FloatArray
    shape: FloatArray
    lights: FloatArray
    material: Material


@dataclass(frozen=True)
class ShadingModel(Parameters, ABC):
    """Base of every shading plug-in."""

    @abstractmethod
    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface.

        Parameters
        ----------
        inputs : ShadingInputs
            Geometry, lights and material.

        Returns
        -------
        ndarray, shape=(n, 3)
            Radiant exitance, linear RGB, before the exit Fresnel factor.
        """


model_registry: Registry[ShadingModel] = Registry(
    "shading model", "plugins.shading", "curvelight.shading"
)
"""The shading models by name."""


def shading_models() -> list[str]:
    """Return the names of the shading models.

    Returns
    -------
    list of str
        Sorted; built-in ones and those that other packages bring.
    """
    return model_registry.names()


def shade(
    mesh: TriangleMesh,
    curvatures: PrincipalCurvatures,
    material: Material | str,
    lights: Sequence[Light],
    model: str = "curvature-lut",
    mm_per_unit: float = 1.0,
    *,
    normals: ArrayLike | None = None,
    **parameters: Any,
) -> FloatArray:
    """Shade a mesh as a translucent body, from its curvature alone.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, n vertices.
    curvatures : PrincipalCurvatures
        Of the same vertices.
    material : Material or str
        A material, or the name of a built-in one.
    lights : sequence of DirectionalLight, PointLight or ConeLight
        Any number, also none.
    model : str
        One of `shading_models`.
    mm_per_unit : float
        Millimetres in one mesh unit, above 0.
    normals : array_like, shape=(n, 3), optional
        Outward normals of any length to be used instead of those at the curvature's scale.
    **parameters : object
        The model's parameters.

    Returns
    -------
    ndarray, shape=(n, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor and before any exposure; 0 at
        vertices without a normal.

    Raises
    ------
    ParameterError
        If a name is unknown, a value out of range or an array of the wrong length.
    """
    chosen = create(model_registry.get(model), f"shading model {model!r}", parameters)
    substance = resolved(material)
    scale = float(finite("mm_per_unit", mm_per_unit, ()))
    if scale <= 0.0:
        raise ParameterError(f"mm_per_unit = {mm_per_unit!r} must be above 0")
    count = len(mesh.vertices)
    facing, absent = _normals(curvatures.normals if normals is None else normals, count)
    inputs = ShadingInputs(
        points=mesh.vertices,
        normals=facing,
        shape=_shape(curvatures, count, 1.0 / scale),
        lights=pack(lights),
        material=substance,
    )
    exitance = chosen.shade(inputs)
    exitance[absent] = 0.0
    return exitance


@compiled()
def bending(shape: FloatArray, vertex: int, x: float, y: float, z: float) -> float:
    """Return |S+ w_t|, how fast N.w changes over the surface.

    Parameters
    ----------
    shape : ndarray, shape=(n, 6)
        `ShadingInputs.shape`.
    vertex : int
        Which vertex.
    x, y, z : float
        Unit vector w to the light. S+ is tangent, so w itself stands for its tangent part w_t.

    Returns
    -------
    float
        The paper's sqrt(w1^2 k1^2 + w2^2 k2^2) with concave curvature 0, 1/mm.
    """
    xx, yy, zz = shape[vertex, 0], shape[vertex, 1], shape[vertex, 2]
    xy, yz, xz = shape[vertex, 3], shape[vertex, 4], shape[vertex, 5]
    along_x = xx * x + xy * y + xz * z
    along_y = xy * x + yy * y + yz * z
    along_z = xz * x + yz * y + zz * z
    length: float = np.sqrt(along_x * along_x + along_y * along_y + along_z * along_z)
    return length


@compiled()
def invariants(shape: FloatArray, vertex: int) -> tuple[float, float]:
    """Return the sum and the sum of squares of the convex principal curvatures.

    Parameters
    ----------
    shape : ndarray, shape=(n, 6)
        `ShadingInputs.shape`.
    vertex : int
        Which vertex.

    Returns
    -------
    tuple of float
        k1 + k2 in 1/mm and k1^2 + k2^2 in 1/mm^2, concave curvature being 0.
    """
    xx, yy, zz = shape[vertex, 0], shape[vertex, 1], shape[vertex, 2]
    xy, yz, xz = shape[vertex, 3], shape[vertex, 4], shape[vertex, 5]
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + xz * xz)
    return xx + yy + zz, squares


@compiled(parallel=True)
def _convex_part(
    k1: FloatArray, k2: FloatArray, d1: FloatArray, d2: FloatArray, per_mm: float
) -> FloatArray:
    shape = np.empty((len(k1), 6))
    for i in prange(len(k1)):
        p, q = max(k1[i], 0.0) * per_mm, max(k2[i], 0.0) * per_mm
        ux, uy, uz = d1[i, 0], d1[i, 1], d1[i, 2]
        vx, vy, vz = d2[i, 0], d2[i, 1], d2[i, 2]
        shape[i, 0] = p * ux * ux + q * vx * vx
        shape[i, 1] = p * uy * uy + q * vy * vy
        shape[i, 2] = p * uz * uz + q * vz * vz
        shape[i, 3] = p * ux * uy + q * vx * vy
        shape[i, 4] = p * uy * uz + q * vy * vz
        shape[i, 5] = p * ux * uz + q * vx * vz
    return shape


def _shape(curvatures: PrincipalCurvatures, count: int, per_mm: float) -> FloatArray:
    return _convex_part(
        finite("k1 of the curvatures", curvatures.k1, (count,)),
        finite("k2 of the curvatures", curvatures.k2, (count,)),
        finite("d1 of the curvatures", curvatures.d1, (count, 3)),
        finite("d2 of the curvatures", curvatures.d2, (count, 3)),
        per_mm,
    )


def _normals(given: ArrayLike, count: int) -> tuple[FloatArray, IndexArray]:
    normals = finite("normals", given, (count, 3))
    square = np.einsum("ij,ij->i", normals, normals)
    absent = np.flatnonzero(square == 0.0).astype(np.int32)
    square[absent] = 1.0
    # Unit normals are used as they are: no copy of the curvatures' own.
    if np.max(np.abs(square - 1.0), initial=0.0) > 1e-12:
        normals = normals / np.sqrt(square)[:, None]
    return normals, absent
