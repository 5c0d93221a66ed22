"""Whether a scene lies where its shading models fail, and on how much of the surface.

On balls every local model's error crosses 10 % at one value of E2 = <r^2>/2 (3 k1^2 + 2 k1 k2 +
3 k2^2)/8, in l_u, or nearly so, whatever the absorption and the refractive index: `BOUNDS` holds
the least of `lutcore.stability_of_shading.maps`. It costs no more than looking at the curvature,
and tells of the region that the maps outline; how wrong a model is there, and which is better,
`curvelight choose` predicts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.pipeline import Pipeline
from app.session import Method, Session
from lutcore.arrays import FloatArray
from lutcore.stability_of_shading.maps import OFF_BENT, OFF_FLAT

ERROR = 0.1
"""Relative L2 error on a ball that a user is warned of."""
# 0: on a flat surface already. `curvature-lut-physical` is held against the random walk instead of
# the profile: skin1 in three channels. `sphere-table` is right on balls; others have no bound.
BOUNDS = {
    "bredow2002": 0.0,
    "wrap": 0.0,
    "curvature-lut-physical": 0.06,
    "lambert": 0.1,
    "kubo2010": 0.1,
    "kolchin2007": 0.12,
    "kolchin2007-simplified": 0.12,
    "penner2011": 0.21,
    "curvature-lut": 0.24,
    "monge-patch": 0.31,
}
"""E2 from which on a model's error is above `ERROR`."""
_LEAST = 0.01


@dataclass(frozen=True)
class Failing:
    """One model on one scene.

    Parameters
    ----------
    model : str
        Its name, with its parameters.
    region : str
        Name of the region, as in `lutcore.stability_of_shading.maps.REASONS`.
    share : float
        Of the vertices that lie in it, in one channel at least.
    """

    model: str
    region: str
    share: float

    @property
    def sentence(self) -> str:
        """What a user is told."""
        which = f"{100.0 * self.share:.2g} %" if self.share < 0.995 else "all"
        return (
            f"{self.model} is off by more than {100.0 * ERROR:g} % on balls that are curved like "
            f"{which} of the vertices: {self.region}; see curvelight choose"
        )

    def as_json(self) -> dict[str, object]:
        """Return what a script reads.

        Returns
        -------
        dict
            Model, region and share of the vertices.
        """
        return {"model": self.model, "region": self.region, "share": self.share}


def failing(session: Session, pipeline: Pipeline, models: Sequence[Method]) -> list[Failing]:
    """Find the models in whose failing regions a session's mesh lies.

    Parameters
    ----------
    session : Session
        Its mesh, size of a mesh unit, curvature, material and profile are used.
    pipeline : Pipeline
        Where arrays come from.
    models : sequence of Method
        The models.

    Returns
    -------
    list of Failing
        Those with more than 1 % of the vertices in one; models without a bound are left out.

    Raises
    ------
    MeshError, ParameterError
        As the pipeline.
    """
    known = [one for one in models if one.name in BOUNDS]
    if not known:
        return []
    second = _second(session, pipeline)
    found = []
    for one in known:
        bound = BOUNDS[one.name]
        share = float(np.mean(second >= bound)) if len(second) else 0.0
        if share > _LEAST:
            found.append(Failing(one.label, OFF_BENT if bound > 0.0 else OFF_FLAT, share))
    return found


def _second(session: Session, pipeline: Pipeline) -> FloatArray:
    """Return E2 of each vertex with an estimate, in the channel where it is most."""
    from lutcore.baking import bake

    curvatures = pipeline.curvatures(session)
    seen, size = curvatures.estimated, pipeline.mm_per_unit(session)
    k1, k2 = curvatures.k1[seen] / size, curvatures.k2[seen] / size
    table = bake(pipeline.material(session), profile=pipeline.profile(session))
    widest = float((table.mean_square * table.mean_free_path**2).max())
    return np.asarray(widest * (3.0 * (k1 * k1 + k2 * k2) + 2.0 * k1 * k2) / 16.0)
