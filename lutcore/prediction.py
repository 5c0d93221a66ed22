"""How wrong a local shading model will be at a vertex, before it is run.

The truth is the diffusion profile integrated over the true surface, with F_t inside. A model says
in `Knowledge` what of it it has right; the rest, term by term (`lutcore.error_terms`), is its
error. What no local model can know is the same for all.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, read_only
from lutcore.error_terms import Known, Spread, Where, errors, irradiances
from lutcore.facets import facets, in_frames
from lutcore.fresnel import hinges_of, transmittance
from lutcore.lut import PsiTable
from lutcore.shadow_doubt import doubt_of_softening

if TYPE_CHECKING:
    from lutcore.curvature import PrincipalCurvatures
    from lutcore.shading import ShadingInputs

COSINES: FloatArray = np.linspace(-1.0, 1.0, 257)
"""Cosines at which a model says what it gives on a flat surface."""

BENDS = ("none", "mean", "rms", "tensor")
"""See `Knowledge.bend`."""

WEIGHTS = {
    "first": 2.2,
    "second": 1.0,
    "anisotropy": 1.2,
    "higher": 0.5,
    "third": 0.5,
    "concave": 2.1,
    "corner": 1.9,
    "base": 1e-05,
    "bumps": 0.23,
    "residue": 0.3,
    "beside": 0.055,
    "strays": 0.066,
    "unsure": 0.34,
    "least": 0.0001,
}
"""By how much each term of `lutcore.error_terms` counts.

One set for all models, found together with the constants of `lutcore.error_terms` by a seeded
random search for errors that cover 96.8 % and are no wider than 4.3 times the median, for the six
settings that are nearest to the truth, on every shape of the table of ``python -m
tests.bench.prediction``, each in 60 scenes of other seeds, and rounded; not on the bunny. What is
known of corners, facets and the gradient kept the constants that make its sign and size right;
first was left larger than what it found, or blends would begin too steeply to have no seam.
``python -m tests.bench.prediction --tune 80`` prints what regression to the 95th percentile gives
in scenes of its own, and what such a search over the weights alone finds from there.
"""

_HINGES = 4
_NEAR = 2
# Of A (k1^2 + k2^2): what lies between a facet and the body that it stands for.
_FACET = 0.09


@dataclass(frozen=True, eq=False)
class Knowledge:
    """What a model has right, and so how wrong it is.

    Parameters
    ----------
    flat : ndarray, shape=(257,) or (3, 257)
        What it gives on a flat surface under light at `COSINES`, per R_d and unit irradiance; by
        channel where their refractive indices differ.
    bend : str
        The curvature that its glow follows: ``none``, the ``mean``, the ``rms`` of the two, or the
        ``tensor`` along the light. Concave curvature is taken as 0.
    second : float
        Share of X that it leaves out.
    anisotropy : float
        Share of X's part with (k1 - k2)^2 that it leaves out: models that know one curvature.
    higher : float
        How large its error beyond the second order is, against that of the first order.
    residue : float
        Its error in units of E2/(1 + E2) where the others have none, in the dark: of its tables.
    """

    flat: FloatArray
    bend: str = "tensor"
    second: float = 1.0
    anisotropy: float = 0.0
    higher: float = 1.0
    residue: float = 0.0

    @property
    def shares(self) -> FloatArray:
        """What each term of `WEIGHTS` is multiplied by for this model; shape (len(WEIGHTS),)."""
        own = {
            "second": self.second,
            "anisotropy": self.anisotropy,
            "higher": self.higher,
            "residue": self.residue,
        }
        return np.array([own.get(term, 1.0) for term in WEIGHTS])


@dataclass(frozen=True, eq=False)
class Scene:
    """What is known of a surface and its light before anything is shaded.

    Parameters
    ----------
    points, normals : ndarray, shape=(n, 3)
        Positions in mesh units and outward unit normals.
    curvatures : ndarray, shape=(n, 2)
        k1 and k2, signed, 1/mm.
    directions : ndarray, shape=(n, 2, 3)
        Their unit directions.
    error : ndarray, shape=(n,)
        One sigma of k1 and k2, 1/mm; 0 where it is not known.
    slope : ndarray, shape=(n, 3)
        Gradient of k1 + k2 along the surface, 1/mm^2.
    facet : ndarray, shape=(n,)
        Area of the mesh for each vertex, mm^2.
    sides : ndarray, shape=(n, 3)
        Mean of e e^T over the sides e of the facets around it, between the first direction and
        itself, both directions, and the second and itself; mm^2.
    shaded : ndarray, shape=(1, n, 3) or (3, n, 3)
        Normals that models are given: for all channels, or for each what its light sees.
    variance : ndarray, shape=(1, n) or (3, n)
        That of the normals that a model's means are of: see `lutcore.detail.Detail`; 0 for all
        channels where they have one scale.
    bare : ndarray, shape=(n, 3)
        Mean by area of the faces' normals.
    grain, corner : ndarray, shape=(n,)
        See `lutcore.facets.Facets`.
    radius : float
        That of a ball of the same volume over area, mm; see `lutcore.facets.Facets`.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    table : PsiTable
        Of the material and the profile.
    shares : ndarray, shape=(l, n, 3), optional
        Of each light, what the shadows that local models are given leave; None if nothing casts
        any.
    """

    points: FloatArray
    normals: FloatArray
    curvatures: FloatArray
    directions: FloatArray
    error: FloatArray
    slope: FloatArray
    facet: FloatArray
    sides: FloatArray
    shaded: FloatArray
    variance: FloatArray
    bare: FloatArray
    grain: FloatArray
    corner: FloatArray
    radius: float
    lights: FloatArray
    table: PsiTable
    shares: FloatArray | None = None

    @classmethod
    def of(cls, inputs: "ShadingInputs", curvatures: "PrincipalCurvatures") -> "Scene":
        """Return the scene that is to be shaded.

        Parameters
        ----------
        inputs : ShadingInputs
            Of the whole mesh.
        curvatures : PrincipalCurvatures
            Of the same vertices, 1/mesh unit.

        Returns
        -------
        Scene
            One entry for each vertex.
        """
        size = inputs.mm_per_unit
        found = facets(inputs.points, inputs.faces, curvatures.k1 + curvatures.k2)
        error = np.where(np.isfinite(curvatures.error), curvatures.error, 0.0)
        directions = np.stack([curvatures.d1, curvatures.d2], axis=1)
        seen, plain = inputs.detail, np.zeros((1, len(inputs.points)))
        return cls(
            points=inputs.points,
            normals=inputs.normals,
            curvatures=np.stack([curvatures.k1, curvatures.k2], axis=1) / size,
            directions=directions,
            error=error / size,
            slope=found.slope / size**2,
            facet=found.area * size**2,
            sides=in_frames(found.sides, directions) * size**2,
            shaded=inputs.normals[None] if seen is None else seen.normals,
            variance=plain if seen is None else seen.variance,
            bare=found.bare,
            grain=found.grain,
            corner=found.corner,
            radius=found.radius * size,
            lights=inputs.lights,
            table=inputs.table,
            shares=_shares(inputs),
        )

    def at(self, chosen: NDArray[np.integer[Any]]) -> "Scene":
        """Return the scene at some of its vertices.

        Parameters
        ----------
        chosen : ndarray of int, shape=(m,)
            Indices.

        Returns
        -------
        Scene
            Of m vertices.
        """
        return replace(
            self,
            points=read_only(self.points[chosen]),
            normals=self.normals[chosen],
            curvatures=self.curvatures[chosen],
            directions=self.directions[chosen],
            error=self.error[chosen],
            slope=self.slope[chosen],
            facet=self.facet[chosen],
            sides=self.sides[chosen],
            shaded=self.shaded.take(chosen, axis=1),
            variance=self.variance.take(chosen, axis=1),
            bare=self.bare[chosen],
            grain=self.grain[chosen],
            corner=self.corner[chosen],
            shares=None if self.shares is None else self.shares.take(chosen, axis=1),
        )

    @property
    def entering(self) -> FloatArray:
        """Lambert with F_t(N.w) at `COSINES`: what a flat surface gives; shape (3, 257)."""
        lit = np.maximum(COSINES, 0.0)
        return np.stack([lit * transmittance(lit, float(eta)) for eta in self.table.eta])

    @property
    def mean_entering(self) -> FloatArray:
        """Lambert with <F_t> at `COSINES`; shape (3, 257)."""
        return np.maximum(COSINES, 0.0) * self.table.entering[:, None]

    @property
    def irradiance(self) -> FloatArray:
        """Largest irradiance of all lights together by channel; 1 without lights; shape (3,)."""
        if not len(self.lights):
            return np.ones(3)
        strengths = irradiances(self.points, self.lights)
        return np.asarray(strengths.max(axis=0, initial=0.0))

    def error_of(self, model: Knowledge) -> FloatArray:
        """Return how wrong a local model will be.

        Parameters
        ----------
        model : Knowledge
            What it has right.

        Returns
        -------
        ndarray, shape=(n, 3)
            Bound on the absolute error of the exitance, in R_d and the lights' unit of
            irradiance; 0 without a normal. Without lights the largest over all directions of one
            light of unit irradiance.
        """
        found = self.bound(model, model.shares * np.array(list(WEIGHTS.values())))
        if self.shares is not None:
            given = self.points, self.shaded, self.lights, self.shares, self.entering
            found += doubt_of_softening(*given)
        return found

    def facets(self, tolerance: float) -> FloatArray:
        """Return how wrong a model will be that gathers light from the mesh itself.

        Parameters
        ----------
        tolerance : float
            Relative error that it allows itself.

        Returns
        -------
        ndarray, shape=(n, 3)
            As `error_of`.
        """
        weights = np.array([float(term == "base") for term in WEIGHTS])
        bends: FloatArray = self.facet * np.square(self.curvatures).sum(axis=1)
        return (tolerance + _FACET * bends)[:, None] * self.bound(Knowledge(self.entering), weights)

    def bound(self, model: Knowledge, weights: FloatArray) -> FloatArray:
        """Return the error on a flat surface and the weighted terms that curvature adds.

        Parameters
        ----------
        model : Knowledge
            What the model has right; its numbers are not used.
        weights : ndarray, shape=(len(WEIGHTS),)
            In the order of `WEIGHTS`.

        Returns
        -------
        ndarray, shape=(n, 3)
            As `error_of`.
        """
        off = np.abs(model.flat - self.entering)
        # Where the two cross, the error is not less than beside it: curvature moves the crossing.
        padded = np.pad(off, ((0, 0), (_NEAR, _NEAR)), "edge")
        near = np.lib.stride_tricks.sliding_window_view(padded, 2 * _NEAR + 1, axis=1)
        table = self.table
        corners, weights_of = hinges_of(table.eta, _HINGES)
        psi_0 = np.ascontiguousarray(table.psi[:, 0])
        optics = Spread(
            table.mean_free_path,
            psi_0,
            8.0 * psi_0 / (7.0 * table.mean_square),  # int psi = <r^2>/8
            table.mean_square,
            weights_of,
            corners,
            self.entering,
        )
        where = Where(
            self.points,
            self.shaded,
            self.variance,
            self.bare,
            self.curvatures,
            self.directions,
            self.error,
            self.slope,
            self.facet,
            self.sides,
            self.grain,
            self.corner,
            self.radius,
            len(self.shaded) > 1,
        )
        known = Known(near.max(axis=2), BENDS.index(model.bend), weights)
        if self.shares is None:
            return errors(where, self.lights, optics, known)
        # What a light that is kept away would do wrong, it does not.
        each = [
            errors(where, self.lights[i : i + 1], optics, known) for i in range(len(self.lights))
        ]
        return np.asarray(np.einsum("lnc,lnc->nc", self.shares, each))


def _shares(inputs: "ShadingInputs") -> FloatArray | None:
    """Return what cast shadows leave of each light, by channel, where there are some."""
    found = inputs.shares
    if found is None or not len(found):
        return None
    return np.repeat(found[:, :, None], 3, axis=2) if found.ndim == 2 else found
