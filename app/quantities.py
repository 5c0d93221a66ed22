"""What of a curvature is shown or reported: its values, unit and title."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures

_ROBUST = (5.0, 95.0)


@dataclass(frozen=True)
class Quantity:
    """One scalar that follows from the principal curvatures.

    Parameters
    ----------
    attribute : str
        Its name in `PrincipalCurvatures`.
    title : str
        What a person reads above the colour bar.
    power : int
        Its unit is 1/length to this power.
    """

    attribute: str
    title: str
    power: int = 1

    @property
    def unit(self) -> str:
        """Unit of the values that `values` returns."""
        return ("1", "1/mm", "1/mm^2")[self.power]

    def values(self, curvatures: PrincipalCurvatures, mm_per_unit: float) -> FloatArray:
        """Return the values in millimetres.

        Parameters
        ----------
        curvatures : PrincipalCurvatures
            In units of the mesh.
        mm_per_unit : float
            Size of a mesh unit.

        Returns
        -------
        ndarray, shape=(n,)
            In 1/mm to the quantity's power.
        """
        values: FloatArray = getattr(curvatures, self.attribute)
        return values / mm_per_unit**self.power


QUANTITIES = {
    "curvedness": Quantity("curvedness", "curvedness\n√((k1² + k2²)/2)\n1/mm"),
    "k1": Quantity("k1", "larger principal\ncurvature k1\n1/mm"),
    "k2": Quantity("k2", "smaller principal\ncurvature k2\n1/mm"),
    "mean": Quantity("mean", "mean curvature\n(k1 + k2)/2\n1/mm"),
    "gauss": Quantity("gauss", "Gauss curvature\nk1 k2\n1/mm²", 2),
    "shape_index": Quantity("shape_index", "shape index", 0),
    "error": Quantity("error", "error of k1, k2\n(one sigma)\n1/mm"),
}


def robust_range(values: FloatArray, symmetric: bool = False) -> tuple[float, float]:
    """Return the range that shows most of the values.

    Parameters
    ----------
    values : ndarray
        Infinite ones are left out.
    symmetric : bool
        Whether the range is as wide below zero as above.

    Returns
    -------
    tuple of 2 floats
        The 5th and the 95th percentile, kept apart where all is equal.
    """
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return 0.0, 1.0
    low, high = (float(end) for end in np.percentile(finite, _ROBUST))
    if symmetric:
        low, high = -max(abs(low), abs(high)), max(abs(low), abs(high))
    # Where all is equal the range opens upwards, so that nothing looks large.
    gap = 1e-3 * max(abs(low), abs(high), 1e-9)
    return (low, high) if high - low > 1e-3 * gap else (low, low + gap)
