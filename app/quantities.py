"""What of a curvature is shown or reported: its values, unit and title."""

from dataclasses import dataclass

from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures

_UNITS = {-1: "mm", 0: "1", 1: "1/mm", 2: "1/mm^2"}


@dataclass(frozen=True)
class Quantity:
    """One scalar that follows from the principal curvatures.

    Parameters
    ----------
    attribute : str
        Its name in `PrincipalCurvatures`.
    words : str
        What it is called above a colour bar, in lines.
    name : str
        What it is called in a line with others.
    power : int
        Its unit is 1/length to this power.
    signed : bool
        Whether it can be negative.
    measured : bool
        Whether it is computed from k1 and k2, so that their error makes it wrong.
    """

    attribute: str
    words: str
    name: str
    power: int = 1
    signed: bool = True
    measured: bool = True

    @property
    def unit(self) -> str:
        """Unit of the values that `values` returns."""
        return _UNITS[self.power]

    @property
    def title(self) -> str:
        """Lines above a colour bar: what it is, and its unit."""
        return f"{self.words}\n{self.printed_unit}" if self.power else self.words

    @property
    def heading(self) -> str:
        """Name and unit in one line."""
        return f"{self.name}, {self.printed_unit}" if self.power else self.name

    @property
    def printed_unit(self) -> str:
        """The unit as a person writes it."""
        return self.unit.replace("^2", "²")

    def in_mm(self, values: FloatArray, mm_per_unit: float) -> FloatArray:
        """Return values in mesh units as values in millimetres.

        Parameters
        ----------
        values : ndarray
            Of this quantity, 1/mesh unit to its power.
        mm_per_unit : float
            Size of a mesh unit.

        Returns
        -------
        ndarray
            In `unit`.
        """
        return values / mm_per_unit**self.power

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
            In `unit`.
        """
        return self.in_mm(raw(self.attribute, curvatures), mm_per_unit)


def raw(attribute: str, curvatures: PrincipalCurvatures) -> FloatArray:
    """Return one value for each vertex, in mesh units.

    Parameters
    ----------
    attribute : str
        Name of a scalar in `PrincipalCurvatures`, `scale` included.
    curvatures : PrincipalCurvatures
        Where it is.

    Returns
    -------
    ndarray, shape=(n,)
        The values.
    """
    if attribute == "scale":
        from lutcore.diagnostics import vertex_scales  # needs what takes a second to load

        return vertex_scales(curvatures)
    values: FloatArray = getattr(curvatures, attribute)
    return values


QUANTITIES = {
    "k1": Quantity("k1", "larger principal\ncurvature k1", "curvature k1"),
    "k2": Quantity("k2", "smaller principal\ncurvature k2", "curvature k2"),
    "mean": Quantity("mean", "mean curvature\n(k1 + k2)/2", "mean curvature"),
    "gauss": Quantity("gauss", "Gauss curvature\nk1 k2", "Gauss curvature", 2),
    "shape_index": Quantity("shape_index", "shape index", "shape index", 0),
    "curvedness": Quantity(
        "curvedness", "curvedness\n√((k1² + k2²)/2)", "curvedness", signed=False
    ),
    "error": Quantity("error", "error of k1, k2\n(one sigma)", "error of k1, k2", 1, False, False),
    "scale": Quantity("scale", "scale, length\naveraged over", "scale", -1, False, False),
    "disagreement": Quantity(
        "", "disagreement\nof estimators\n(one sigma)", "disagreement", 1, False, False
    ),
}
