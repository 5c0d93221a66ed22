"""How far apart compared surfaces are: numbers, and the place where it is most."""

from typing import TypedDict

import numpy as np

from lutcore.arrays import BoolArray, FloatArray
from lutcore.errors import ParameterError
from lutcore.mesh import TriangleMesh


class Difference(TypedDict):
    """A difference over the vertices of a surface, as a script reads it.

    `mean`, `p99` (the 99th percentile) and `max` are CIEDE2000, or in the unit of the quantity
    that estimators are compared by; `vertex` is where the largest is, counted from 0 in the
    file's order, and `position` its place in mesh units.
    """

    mean: float
    p99: float
    max: float
    vertex: int
    position: list[float]


def difference_of(values: FloatArray, mesh: TriangleMesh, counted: BoolArray) -> Difference:
    """Return what is said of a difference.

    Parameters
    ----------
    values : ndarray, shape=(n,)
        At each vertex, not negative.
    mesh : TriangleMesh
        Where the vertices are.
    counted : ndarray of bool, shape=(n,)
        Which vertices have a say.

    Returns
    -------
    Difference
        Over those vertices.

    Raises
    ------
    ParameterError
        If no vertex has a say.
    """
    if not counted.any():
        raise ParameterError("what is compared has no vertex in common; choose another estimator")
    at = np.flatnonzero(counted)
    found = values[at]
    worst = int(at[np.argmax(found)])
    return {
        "mean": float(found.mean()),
        "p99": float(np.percentile(found, 99.0)),
        "max": float(found.max()),
        "vertex": worst,
        "position": [float(one) for one in mesh.vertices[worst]],
    }


def sentence(found: Difference, unit: str = "") -> str:
    """Return a difference as a person reads it.

    Parameters
    ----------
    found : Difference
        Of `difference_of`.
    unit : str
        Of its values, empty for CIEDE2000.

    Returns
    -------
    str
        One line.
    """
    numbers = ", ".join(f"{key} {found[key]:.3g}" for key in ("mean", "p99", "max"))
    place = ", ".join(f"{one:.4g}" for one in found["position"])
    gap = f" {unit}" if unit and unit != "1" else ""
    return f"{numbers}{gap} at vertex {found['vertex']} ({place})"
