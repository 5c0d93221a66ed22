"""From a session to per-vertex arrays, each computed once and kept."""

from collections import OrderedDict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar, cast

import msgspec
from msgspec.structs import replace

from app.lighting import world_lights
from app.loading import LoadedMesh, load_mesh
from app.samples import PREFIX, Sample, sample
from app.session import Method, Session, Substance
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import MeshError
from lutcore.lights import Light
from lutcore.materials import Material, material
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, silent

if TYPE_CHECKING:
    from app.consultation import Consultation
    from lutcore.detail import Detail
    from lutcore.diffusion import DiffusionProfile
    from lutcore.lut import PsiTable
    from lutcore.shading import ShadingInputs

T = TypeVar("T")
_KEPT = 8


@dataclass(frozen=True, eq=False)
class Subject:
    """The mesh of a session with what is known of it beside its geometry.

    Parameters
    ----------
    loaded : LoadedMesh
        The mesh, its colours, its warnings.
    sample : Sample or None
        The sample it came from.
    """

    loaded: LoadedMesh
    sample: Sample | None

    @property
    def mesh(self) -> TriangleMesh:
        """The triangle mesh, vertex count and order as in the file."""
        return self.loaded.mesh

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user must know of the file."""
        remark = self.sample.remark if self.sample else ""
        return (*self.loaded.warnings, *([remark] if remark else []))


class Pipeline:
    """Computes what sessions ask for, and keeps the last few results of each step.

    Parameters
    ----------
    progress : callable
        Told where long work stands; see `lutcore.progress`.
    """

    def __init__(self, progress: Progress = silent) -> None:
        self.progress = progress
        self._kept: OrderedDict[Hashable, object] = OrderedDict()

    def subject(self, session: Session) -> Subject:
        """Return the session's mesh.

        Parameters
        ----------
        session : Session
            Its `mesh` is used.

        Returns
        -------
        Subject
            The loaded mesh.

        Raises
        ------
        MeshError
            If it cannot be read or holds no surface.
        ParameterError
            If it names a sample that does not exist.
        """
        found = sample(session.mesh) if session.mesh.startswith(PREFIX) else None
        path = found.path if found else Path(session.mesh)
        stamp = _stamp(path)
        return self._once(("subject", str(path), stamp), lambda: Subject(load_mesh(path), found))

    def mm_per_unit(self, session: Session) -> float:
        """Return the size of a mesh unit.

        Parameters
        ----------
        session : Session
            Says it, or leaves it to the sample; else it is 1.

        Returns
        -------
        float
            Millimetres.
        """
        if session.mm_per_unit is not None:
            return session.mm_per_unit
        found = self.subject(session).sample
        return found.mm_per_unit if found else 1.0

    def curvatures(self, session: Session) -> PrincipalCurvatures:
        """Return the curvature that the session shows or shades with.

        Parameters
        ----------
        session : Session
            Its mesh, estimator and scale are used; see `scale` for a scale that is left open.

        Returns
        -------
        PrincipalCurvatures
            In 1/mesh unit.

        Raises
        ------
        MeshError
            If no face has an area.
        """
        found = self._once(
            ("curvatures", *self._curvature_key(session)),
            lambda: self._estimate(session, self.progress),
        )
        if not found.estimated.any():
            raise MeshError(
                f"{session.mesh}: none of its {len(self.subject(session).mesh.faces)} "
                "faces has an area, so there is no surface; choose another file"
            )
        return found

    def consult(self, session: Session) -> "Consultation":
        """Return how far the session's `peers` are apart.

        One that cannot estimate the curvature of this mesh is left out, with its reason.

        Parameters
        ----------
        session : Session
            Its mesh, scale and `peers` are used; a scale that is left open is each one's own
            choice.

        Returns
        -------
        Consultation
            Their disagreement.

        Raises
        ------
        ParameterError
            If a name does not exist or comes twice, or fewer than three are left.
        CancelledError
            If `progress` asked to stop.
        """
        from app.consultation import consult

        sessions = [replace(session, estimator=peer) for peer in session.peers]

        def estimate(one: Session, progress: Progress) -> PrincipalCurvatures:
            # Not kept but for the session's own: they would push out everything else.
            own = one.estimator == session.estimator
            return self.curvatures(one) if own else self._estimate(one, progress)

        key = ("peers", *(self._curvature_key(one) for one in sessions))
        return self._once(key, lambda: consult(sessions, estimate, self.progress))

    def _estimate(self, session: Session, progress: Progress) -> PrincipalCurvatures:
        from lutcore.estimation import principal_curvatures

        return principal_curvatures(
            self.subject(session).mesh,
            method=session.estimator.name,
            scale=self.scale(session),
            progress=progress,
            **session.estimator.parameters,
        )

    def scale(self, session: Session) -> float | None:
        """Return the length that curvature is averaged over.

        Where a session shades and leaves the scale to `auto`, it follows from the mesh's spacing
        and the material's glow; where it only measures, `auto` finds the most accurate one.

        Parameters
        ----------
        session : Session
            Its scale, estimator and view are used, and its mesh and material where it shades.

        Returns
        -------
        float or None
            Mesh units; None leaves it to the estimator.
        """
        if session.scale is not None or session.estimator.name != "auto":
            return session.scale
        if session.view == "curvature":
            return None
        from lutcore.scale import shading_scale

        subject = self.subject(session)
        glow = self.glow(session)
        return self._once(
            ("scale", subject.loaded.digest, glow), lambda: shading_scale(subject.mesh, glow)
        )

    def glow(self, session: Session) -> float:
        """Return how far light carries the edge of a shadow, in the channel where it is most.

        Parameters
        ----------
        session : Session
            Its material, profile and size of a mesh unit are used.

        Returns
        -------
        float
            Largest l_u psi(0), mesh units.
        """
        return self._table(session).glow / self.mm_per_unit(session)

    def floored(self, session: Session) -> bool:
        """Tell whether the material absorbs too little for a glow that ends.

        Parameters
        ----------
        session : Session
            Its material and profile are used.

        Returns
        -------
        bool
            True if some channel is shaded with the least absorption instead of its own.
        """
        return bool(self._table(session).floored.any())

    def _table(self, session: Session) -> "PsiTable":
        from lutcore.baking import bake

        return bake(self.material(session), profile=self.profile(session))

    def profile(self, session: Session) -> "DiffusionProfile":
        """Return the session's diffusion profile.

        Parameters
        ----------
        session : Session
            Its `profile` is used.

        Returns
        -------
        DiffusionProfile
            How light spreads under a flat surface.

        Raises
        ------
        ParameterError
            If a name does not exist, or a parameter is out of range.
        """
        from lutcore.diffusion import diffusion_profile

        return diffusion_profile(session.profile.name, **session.profile.parameters)

    def material(self, session: Session) -> Material:
        """Return the session's material.

        Parameters
        ----------
        session : Session
            Its `material` is used.

        Returns
        -------
        Material
            By name or by coefficients.

        Raises
        ------
        ParameterError
            If the name does not exist, or a coefficient is out of range.
        """
        chosen = session.material
        if isinstance(chosen, Substance):
            return Material(chosen.name, chosen.scattering, chosen.absorption, chosen.eta)
        return material(chosen)

    def exitance(self, session: Session, model: Method, axes: FloatArray) -> FloatArray:
        """Return the radiant exitance under a shading model.

        Parameters
        ----------
        session : Session
            Everything but its own model is used.
        model : Method
            The shading model.
        axes : ndarray, shape=(3, 3)
            The camera's axes, for lights that move with it.

        Returns
        -------
        ndarray, shape=(n, 3)
            Linear RGB; see `lutcore.shade`.
        """
        from lutcore.lights import pack

        lights = world_lights(session, axes)
        key = (
            "exitance",
            *self._curvature_key(session),
            # A scale that is given is one for all channels, one that is found is not.
            session.scale is None,
            _key((session.material, session.profile, model, self.mm_per_unit(session))),
            session.shadows,
            pack(lights).tobytes(),
        )
        return self._once(key, lambda: self._shade(session, model, axes))

    def _shade(self, session: Session, model: Method, axes: FloatArray) -> FloatArray:
        from dataclasses import replace

        from lutcore.parameters import create
        from lutcore.shading import AUTO, exitance, model_registry

        if model.name == AUTO:
            from app.costs import measured

            measured(self.progress)  # once on this machine, not in each process
        inputs = self.inputs(session, axes)
        plugin = model_registry.get(model.name)
        chosen = create(plugin, f"shading model {model.name!r}", dict(model.parameters))
        settled = chosen.settled(inputs)
        shares = self.visibility(session, settled.local, world_lights(session, axes))
        return exitance(settled, replace(inputs, visibility=shares))

    def inputs(self, session: Session, axes: FloatArray) -> "ShadingInputs":
        """Return what shading models get, without cast shadows.

        Parameters
        ----------
        session : Session
            Everything but its model and shadows is used.
        axes : ndarray, shape=(3, 3)
            The camera's axes, for lights that move with it.

        Returns
        -------
        ShadingInputs
            See `lutcore.shading`.
        """
        from lutcore.shading import shading_inputs

        return shading_inputs(
            self.subject(session).mesh,
            self.curvatures(session),
            self.material(session),
            world_lights(session, axes),
            self.mm_per_unit(session),
            profile=self.profile(session),
            progress=self.progress,
            detail=self.detail(session),
        )

    def detail(self, session: Session) -> "Detail | None":
        """Return the surface as the light of each channel sees it.

        Parameters
        ----------
        session : Session
            Its mesh, size of a mesh unit, material, profile, estimator and scale are used.

        Returns
        -------
        Detail or None
            None where the session names an estimator or a scale: then that is what all channels
            see.
        """
        if session.scale is not None or session.estimator.name != "auto":
            return None
        from lutcore.detail import detail_seen

        subject, size = self.subject(session), self.mm_per_unit(session)
        key = ("detail", subject.loaded.digest, _key((session.material, session.profile, size)))
        return self._once(
            key,
            lambda: detail_seen(
                subject.mesh,
                self.material(session),
                size,
                profile=self.profile(session),
                progress=self.progress,
            ),
        )

    def visibility(
        self, session: Session, local: bool, lights: Sequence[Light]
    ) -> FloatArray | None:
        """Return which lights reach which vertices, as a model needs it.

        Parameters
        ----------
        session : Session
            Its mesh, `shadows`, material, profile and, for `auto`, its curvature are used.
        local : bool
            Whether for a local model, which gets shadows that are softened as light spreads.
        lights : sequence of DirectionalLight, PointLight or ConeLight
            The lights, in world axes.

        Returns
        -------
        ndarray, shape=(l, n) or (l, n, 3), or None
            Shares from 0 to 1; None where the session casts no shadows.
        """
        if session.shadows == "off" or not lights:
            return None
        from lutcore.lights import pack
        from lutcore.visibility import forecast, softened, visibility

        subject = self.subject(session)
        packed = pack(lights)
        if session.shadows == "auto":
            normals = self.curvatures(session).normals
            if not forecast(subject.mesh, normals, packed).needed:
                return None
        key = ("visibility", subject.loaded.digest, packed.tobytes())
        seen = self._once(key, lambda: visibility(subject.mesh, packed, self.progress))
        if not local:
            return seen
        table, size = self._table(session), self.mm_per_unit(session)
        glow = table.mean_free_path * table.psi[:, 0] / size
        return self._once(
            (*key, glow.tobytes()), lambda: softened(seen, subject.mesh, glow, self.progress)
        )

    def _curvature_key(self, session: Session) -> tuple[Hashable, ...]:
        digest = self.subject(session).loaded.digest
        return digest, _key((session.estimator, self.scale(session)))

    def _once(self, key: Hashable, compute: Callable[[], T]) -> T:
        if key not in self._kept:
            self._kept[key] = compute()
            while len(self._kept) > _KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return cast(T, self._kept[key])


def _stamp(path: Path) -> tuple[int, int] | None:
    """Tell one state of a file from another; None where the loader will say what is wrong."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size


def _key(part: object) -> bytes:
    return msgspec.json.encode(part, order="sorted")
