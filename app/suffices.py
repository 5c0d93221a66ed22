"""Which shading model is enough at each vertex, and what that looks like on the surface."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import AnyArray
from lutcore.progress import Progress, silent, tell

if TYPE_CHECKING:
    from app.composition import Composition
    from lutcore.judging import Rung
    from lutcore.shading import ShadingInputs

# Okabe and Ito's colours, which those who see fewer colours can tell apart, cheapest model first.
_COLORS = (
    (86, 180, 233),
    (0, 158, 115),
    (240, 228, 66),
    (230, 159, 0),
    (0, 114, 178),
    (204, 121, 167),
)
_NONE = (190, 60, 40)
_LEAST_SHARE = 0.01


@dataclass(frozen=True, eq=False)
class Sufficient:
    """The cheapest model that is enough, vertex by vertex.

    Parameters
    ----------
    labels : tuple of str
        Models with their parameters, cheapest first.
    which : ndarray of int, shape=(n,)
        Index of a label; -1 where no local model is enough.
    """

    labels: tuple[str, ...]
    which: AnyArray

    def share(self, index: int) -> float:
        """Return the share of the vertices of one label.

        Parameters
        ----------
        index : int
            Of the label, or -1 for none.

        Returns
        -------
        float
            0 to 1.
        """
        return float(np.mean(self.which == index)) if len(self.which) else 0.0

    def color(self, index: int) -> tuple[int, int, int]:
        """Return the colour of one label.

        Parameters
        ----------
        index : int
            Of the label, or -1 for none.

        Returns
        -------
        tuple of 3 ints
            sRGB, 0 to 255.
        """
        return _NONE if index < 0 else _COLORS[min(index, len(_COLORS) - 1)]

    @property
    def rgb(self) -> NDArray[np.uint8]:
        """Colours of the vertices, shape (n, 3)."""
        colors = [self.color(index) for index in range(len(self.labels))]
        return np.array([*colors, _NONE], np.uint8)[self.which]


def sufficient(
    inputs: "ShadingInputs",
    rungs: Sequence["Rung"],
    tolerance: float,
    progress: Progress = silent,
) -> Sufficient:
    """Return the cheapest model that is enough at each vertex.

    A model that is enough at hardly more vertices than cheaper ones has no place of its own.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene, with its curvatures.
    rungs : sequence of Rung
        The ladder, cheapest first; see `lutcore.choice.choose`.
    tolerance : float
        Of the error relative to R_d and the largest irradiance.
    progress : callable
        Told where the work stands.

    Returns
    -------
    Sufficient
        For each vertex of the mesh.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    from lutcore.prediction import Scene
    from lutcore.tolerance import relative

    assert inputs.curvatures is not None
    scene = Scene.of(inputs, inputs.curvatures)
    irradiance = scene.irradiance
    which = np.full(len(inputs.points), -1)
    labels: list[str] = []
    worth = _worth(rungs)
    for step, rung in enumerate(worth):
        tell(progress, step / len(worth), "where each model is enough")
        left = np.flatnonzero(which < 0)
        if not len(left) or len(labels) == len(_COLORS):
            break
        errors = rung.candidate.model.predicted_error(scene.at(left))
        if errors is None:
            continue
        enough = left[relative(errors, irradiance) <= tolerance]
        which[enough] = len(labels)
        labels.append(rung.candidate.label)
    return Sufficient(tuple(labels), which)


def _worth(rungs: Sequence["Rung"]) -> list["Rung"]:
    """Return the local models that are enough at more vertices than any cheaper one."""
    worth: list[Rung] = []
    for rung in rungs:
        most = max((one.share for one in worth), default=0.0)
        if rung.candidate.model.local and rung.share > most + _LEAST_SHARE:
            worth.append(rung)
    return worth


def colored(made: "Composition", rgb: NDArray[np.uint8]) -> "Composition":
    """Return a composition whose meshes have other colours, under a soft light.

    Parameters
    ----------
    made : Composition
        Any.
    rgb : ndarray of uint8, shape=(n, 3)
        sRGB.

    Returns
    -------
    Composition
        Its colour bars are left as they are.
    """
    from app.scene import Surface

    panels = tuple(
        replace(panel, content=replace(panel.content, rgb=rgb, values=None, scale=None, lit=True))
        if isinstance(panel.content, Surface)
        else panel
        for panel in made.panels
    )
    return replace(made, panels=panels)
