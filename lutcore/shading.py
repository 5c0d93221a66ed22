"""What a shading model gets and returns, and the models by name."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import AnyArray, FloatArray, IndexArray, finite
from lutcore.baking import USUAL, bake, resolved
from lutcore.convexity import convex_part
from lutcore.curvature import PrincipalCurvatures
from lutcore.detail import Detail
from lutcore.diffusion import DiffusionProfile, diffusion_profile
from lutcore.errors import ParameterError
from lutcore.lights import Light, pack
from lutcore.lut import PsiTable
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh
from lutcore.parameters import Parameters
from lutcore.progress import Progress, silent
from lutcore.registry import Registry

if TYPE_CHECKING:
    from lutcore.draft import Draft
    from lutcore.prediction import Scene

AUTO = "auto"
"""The name that chooses among the models."""


@dataclass(frozen=True, eq=False)
class ShadingInputs:
    """All that a shading model may depend on.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    normals : ndarray, shape=(n, 3)
        Outward unit normals; zero where there is none: `lutcore.exitance.exitance` makes that dark.
    shape : ndarray, shape=(n, 6)
        Positive (convex) part S+ of the shape operator as a symmetric tensor of the tangent
        plane, 1/mm, in the order xx, yy, zz, xy, yz, xz. Concave curvature is 0, as section 3 of
        Kolchin 2007 clamps it. Not a number where there are no `curvatures`.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    material : Material
        What the surface is made of.
    profile : DiffusionProfile
        How light spreads under a flat surface of it: part of the medium, the same for all models
        that are compared.
    faces : ndarray, shape=(m, 3)
        Triangles, for models that are not local.
    mm_per_unit : float
        Millimetres in one mesh unit.
    visibility : ndarray, shape=(l, n) or (l, n, 3), optional
        Share of each light that reaches each vertex, 0 to 1, by channel where light that spreads
        has softened it; if not given, nothing casts a shadow. A local model never sees it: see
        `lutcore.exitance.exitance`.
    softened : ndarray, shape=(l, n, 3), optional
        The same as local models are given it, where others need it as it is; see
        `lutcore.visibility.softened`. If not given, `visibility` is for all.
    progress : callable
        Told where long work stands; see `lutcore.progress`.
    curvatures : PrincipalCurvatures, optional
        What `shape` was taken from, 1/mesh unit, for predicting errors.
    detail : Detail, optional
        Normals and S+ by channel, as the light of each sees them, in place of `normals` and
        `shape`. No model sees it: see `lutcore.exitance.exitance`.
    """

    points: FloatArray
    normals: FloatArray
    shape: FloatArray
    lights: FloatArray
    material: Material
    profile: DiffusionProfile
    faces: IndexArray
    mm_per_unit: float
    visibility: FloatArray | None = None
    softened: FloatArray | None = None
    progress: Progress = silent
    curvatures: PrincipalCurvatures | None = None
    detail: Detail | None = None

    @property
    def shares(self) -> FloatArray | None:
        """Share of each light that local models are given; None where nothing casts a shadow."""
        return self.visibility if self.softened is None else self.softened

    @property
    def table(self) -> PsiTable:
        """The psi table of the material and the profile, baked once."""
        return self.baked(USUAL)

    def baked(self, samples: int) -> PsiTable:
        """Return the psi table with a number of samples, baked once.

        Parameters
        ----------
        samples : int
            8 to 1024, as a dipole counts them; see `lutcore.baking.samples_parameter`.

        Returns
        -------
        PsiTable
            With as many for a dipole, more for a profile whose psi bends more.
        """
        return bake(self.material, samples * self.profile.knots // USUAL, self.profile)


@dataclass(frozen=True)
class ShadingModel(Parameters, ABC):
    """Base of every shading plug-in; `lutcore.exitance.exitance` runs one."""

    local: ClassVar[bool] = True
    """Whether the value at a vertex depends on nothing of the mesh but that vertex."""

    joint: ClassVar[bool] = False
    """Whether what it gives under several lights, or in a channel, depends on the others: it then
    gets visibility and detail and applies them itself, of a local model."""

    curved: ClassVar[bool] = False
    """Whether it needs `ShadingInputs.curvatures`, of a local model: others get them anyway."""

    growth: ClassVar[str] = "n"
    """How its time grows with the number n of vertices: n (and of lights), n log n or n^2."""

    reference: ClassVar[bool] = False
    """Whether it is what others are checked against."""

    aim: ClassVar[str] = ""
    """What it comes near to in place of the profile integrated over the surface, if it does."""

    @abstractmethod
    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface.

        Parameters
        ----------
        inputs : ShadingInputs
            Geometry, lights and material. The result must be the sum of what the lights give one
            by one. A model that is not local must multiply each light by its visibility.

        Returns
        -------
        ndarray, shape=(n, 3)
            Radiant exitance, linear RGB, before the exit Fresnel factor.
        """

    def shader_at(self, inputs: ShadingInputs) -> Callable[[AnyArray], FloatArray]:
        """Prepare a model that is not local to be asked for some vertices, as often as needed.

        Parameters
        ----------
        inputs : ShadingInputs
            Of the whole mesh.

        Returns
        -------
        callable
            From indices of m vertices to what `shade` gives there, shape (m, 3), within the model's
            own tolerance. A model may have a shorter way.
        """
        whole = self.shade(inputs)
        return lambda vertices: whole[vertices]

    def shade_channel(self, inputs: ShadingInputs, channel: int) -> FloatArray:
        """Compute what leaves the surface in one channel, for a surface that each sees otherwise.

        Parameters
        ----------
        inputs : ShadingInputs
            Geometry as light of this channel sees it.
        channel : int
            0, 1 or 2.

        Returns
        -------
        ndarray, shape=(n,)
            What `shade` gives for it, to the last bit. A model may have a shorter way.
        """
        lights = inputs.lights.copy()
        lights[:, 8:] *= np.arange(3) == channel  # models need not look the others up
        return self.shade(replace(inputs, lights=lights))[:, channel]

    def shade_detail(self, inputs: ShadingInputs, seen: Detail) -> FloatArray:
        """Compute what leaves a surface that each channel sees otherwise.

        Parameters
        ----------
        inputs : ShadingInputs
            Everything but normals and S+.
        seen : Detail
            Those of each channel.

        Returns
        -------
        ndarray, shape=(n, 3)
            What `shade` gives for each, to the last bit. A model may have a shorter way.
        """
        out = np.empty(inputs.points.shape)
        for channel, (normals, shape) in enumerate(zip(seen.normals, seen.shape, strict=True)):
            alone = replace(inputs, normals=normals, shape=shape, detail=None)
            out[:, channel] = self.shade_channel(alone, channel)
        return out

    def draft(self, inputs: ShadingInputs) -> "Draft | None":
        """Return what shades the same surface nearly as well in a fraction of the time.

        Parameters
        ----------
        inputs : ShadingInputs
            Everything but lights and visibility.

        Returns
        -------
        Draft or None
            For a light that is dragged; None where there is no such way.
        """
        return None

    def predicted_error(self, scene: "Scene") -> FloatArray | None:
        """Predict how wrong the model will be, without running it.

        Parameters
        ----------
        scene : Scene
            Curvature, its error bar, its change along the surface, and the lights.

        Returns
        -------
        ndarray, shape=(n, 3), or None
            Bound on the absolute error of the exitance against the profile integrated over the
            true surface, in R_d and the lights' unit of irradiance; see `Scene.error_of`. None
            where nothing is known: such a model is never chosen.
        """
        return None

    @classmethod
    def rungs(cls) -> tuple["ShadingModel", ...]:
        """Return the settings of the model that are worth choosing among.

        Returns
        -------
        tuple of ShadingModel
            The default if a model does not say otherwise.
        """
        return (cls(),)

    def settled(self, inputs: ShadingInputs) -> "ShadingModel":
        """Return the model that a scene is shaded with.

        Parameters
        ----------
        inputs : ShadingInputs
            The scene, with visibility where something casts a shadow.

        Returns
        -------
        ShadingModel
            The model itself but for one that chooses among others.
        """
        return self


model_registry: Registry[ShadingModel] = Registry(
    "shading model", "plugins.shading", "curvelight.shading"
)
"""The shading models by name."""


def shading_models() -> list[str]:
    """Return the names of the shading models.

    Returns
    -------
    list of str
        Sorted; built-in ones and those that other packages bring. `AUTO` is not among them: it
        stands for one of them.
    """
    return [name for name in model_registry.names() if name != AUTO]


def shading_inputs(
    mesh: TriangleMesh,
    curvatures: PrincipalCurvatures | None,
    material: Material | str,
    lights: Sequence[Light],
    mm_per_unit: float = 1.0,
    *,
    normals: ArrayLike | None = None,
    profile: DiffusionProfile | str = "jensen2001",
    progress: Progress = silent,
    visibility: ArrayLike | None = None,
    detail: Detail | None = None,
) -> ShadingInputs:
    """Return what shading models get, checked and prepared once for all of them.

    Parameters
    ----------
    mesh, material, lights, mm_per_unit
        As for `lutcore.shade`.
    curvatures : PrincipalCurvatures or None
        As for `lutcore.shade`. A local model that is not `curved` needs none where there is
        `detail`.
    normals, profile, progress, visibility, detail
        As for `lutcore.shade`.

    Returns
    -------
    ShadingInputs
        For `lutcore.exitance.exitance`.

    Raises
    ------
    ParameterError
        As `lutcore.shade`.
    """
    substance = resolved(material)
    scale = float(finite("mm_per_unit", mm_per_unit, ()))
    if scale <= 0.0:
        raise ParameterError(f"mm_per_unit = {mm_per_unit!r} must be above 0")
    count = len(mesh.vertices)
    packed = pack(lights)
    if detail is not None and detail.normals.shape[1] != count:
        raise ParameterError(
            f"detail is of a mesh with {detail.normals.shape[1]} vertices, not {count}"
        )
    if curvatures is not None:
        facing = curvatures.normals if normals is None else normals
        shape = _shape(curvatures, count, 1.0 / scale)
    elif detail is None:
        raise ParameterError("shading needs curvatures or detail; neither is given")
    else:
        facing = detail.smooth if normals is None else normals
        shape = np.broadcast_to(np.nan, (count, 6))
    return ShadingInputs(
        points=mesh.vertices,
        normals=_normals(facing, count),
        shape=shape,
        lights=packed,
        material=substance,
        profile=diffusion_profile(profile),
        faces=mesh.faces,
        mm_per_unit=scale,
        visibility=None if visibility is None else _shares(visibility, len(packed), count),
        progress=progress,
        curvatures=curvatures,
        detail=detail,
    )


def _shape(curvatures: PrincipalCurvatures, count: int, per_mm: float) -> FloatArray:
    return convex_part(
        finite("k1 of the curvatures", curvatures.k1, (count,)),
        finite("k2 of the curvatures", curvatures.k2, (count,)),
        finite("d1 of the curvatures", curvatures.d1, (count, 3)),
        finite("d2 of the curvatures", curvatures.d2, (count, 3)),
        per_mm,
    )


def _normals(given: ArrayLike, count: int) -> FloatArray:
    normals = finite("normals", given, (count, 3))
    square = np.einsum("ij,ij->i", normals, normals)
    square[square == 0.0] = 1.0
    # Unit normals are used as they are: no copy of the curvatures' own.
    if np.max(np.abs(square - 1.0), initial=0.0) > 1e-12:
        normals = normals / np.sqrt(square)[:, None]
    return normals


def _shares(given: ArrayLike, lights: int, count: int) -> FloatArray:
    shares = finite("visibility", given, (lights, count), (lights, count, 3))
    if shares.size and not 0.0 <= shares.min() <= shares.max() <= 1.0:
        raise ParameterError("visibility must be 0 to 1")
    return shares
