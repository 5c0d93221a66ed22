"""From a session to per-vertex arrays, each computed once and kept."""

import dataclasses
from collections import OrderedDict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar, cast

import msgspec
from msgspec.structs import replace

from app.lighting import world_lights
from app.loading import LoadedMesh
from app.samples import PREFIX, Sample, sample
from app.session import Method, Repair, Session, Substance, Volume
from app.volume import load_surface, source_of
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import MeshError
from lutcore.materials import Material, material
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, silent

if TYPE_CHECKING:
    from app.consultation import Consultation
    from app.strokes import Strokes
    from lutcore.detail import Detail
    from lutcore.diffusion import DiffusionProfile
    from lutcore.lights import Light
    from lutcore.lut import PsiTable
    from lutcore.shading import ShadingInputs, ShadingModel

T = TypeVar("T")
# Of each kind of step, the last few results; a light that is dragged pushes out nothing else.
_KEPT = 6
_KEPT_OF = {"exitance": 8, "light": 8}


@dataclass(frozen=True, eq=False)
class Subject:
    """The mesh of a session with what is known of it beside its geometry.

    Parameters
    ----------
    loaded : LoadedMesh
        The mesh, its colours, its warnings.
    sample : Sample or None
        The sample it came from.
    volume : Volume
        How it became a surface, if it was a volume.
    repairs : tuple of Repair
        What was done to it since.
    """

    loaded: LoadedMesh
    sample: Sample | None
    volume: Volume
    repairs: tuple[Repair, ...] = ()

    @property
    def mesh(self) -> TriangleMesh:
        """The triangle mesh, vertex count and order as in the file, if nothing is repaired."""
        return self.loaded.mesh

    @property
    def key(self) -> Hashable:
        """What tells this surface from others: its files' content, and what was made of it."""
        return self.loaded.digest, _key((self.volume, self.repairs))

    @property
    def mm_per_unit(self) -> float | None:
        """Size of a mesh unit, where the sample or the file says it."""
        return self.sample.mm_per_unit if self.sample else self.loaded.mm_per_unit

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
        self._kept: dict[str, OrderedDict[Hashable, object]] = {}

    def subject(self, session: Session) -> Subject:
        """Return the session's mesh.

        Parameters
        ----------
        session : Session
            Its `mesh`, `volume` and `repairs` are used.

        Returns
        -------
        Subject
            The loaded mesh, or the surface of the volume, repaired.

        Raises
        ------
        MeshError
            If it cannot be read or holds no surface, or a repair is not possible.
        ParameterError
            If it names a sample that does not exist.
        """
        found = None
        if session.mesh.startswith(PREFIX):
            found = self.once(("sample", session.mesh), lambda: sample(session.mesh))
        source = source_of(found.path if found else Path(session.mesh))
        volume = session.volume
        key = ("subject", *((str(one), _stamp(one)) for one in source.files), _key(volume))
        loaded = self.once(
            key, lambda: Subject(load_surface(source, volume, self.progress), found, volume)
        )
        return self._repaired(loaded, session.repairs)

    def _repaired(self, subject: Subject, repairs: tuple[Repair, ...]) -> Subject:
        """Do repairs in order, each once: one more, or one less, is not to begin anew."""
        if not repairs:
            return subject

        def mend() -> Subject:
            from app.repairing import repaired

            before = self._repaired(subject, repairs[:-1])
            made = repaired(before.loaded, repairs[-1], self.progress)
            return dataclasses.replace(subject, loaded=made, repairs=repairs)

        return self.once(("repaired", subject.key, _key(repairs)), mend)

    def mm_per_unit(self, session: Session) -> float:
        """Return the size of a mesh unit.

        Parameters
        ----------
        session : Session
            Says it, or leaves it to the sample or the file; else it is 1.

        Returns
        -------
        float
            Millimetres.
        """
        if session.mm_per_unit is not None:
            return session.mm_per_unit
        return self.subject(session).mm_per_unit or 1.0

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
        found = self.once(
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
        return self.once(key, lambda: consult(sessions, estimate, self.progress))

    def _estimate(self, session: Session, progress: Progress) -> PrincipalCurvatures:
        from lutcore.estimation import principal_curvatures

        return principal_curvatures(
            self.subject(session).mesh,
            method=session.estimator.name,
            scale=self.scale(session),
            progress=progress,
            **session.estimator.parameters,
        )

    def strokes(self, session: Session) -> "Strokes | None":
        """Return the principal directions as strokes on the surface.

        Parameters
        ----------
        session : Session
            Its mesh, estimator and scale are used.

        Returns
        -------
        Strokes or None
            None where the estimator gives no directions.
        """
        from app.strokes import strokes_of

        found = self.curvatures(session)
        if not found.directed:
            return None
        key = ("strokes", *self._curvature_key(session))
        return self.once(key, lambda: strokes_of(self.subject(session).mesh, found))

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
        glow, most = self.glow(session), subject.mesh.diagonal
        # Of a mesh of few faces the spacing alone may ask for more than there is.
        return self.once(
            ("scale", subject.key, glow), lambda: min(shading_scale(subject.mesh, glow), most)
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
        key = ("exitance", session.shadows, *self._scene_key(session, model, axes))
        return self.once(key, lambda: self._shade(session, model, axes))

    def _shade(self, session: Session, model: Method, axes: FloatArray) -> FloatArray:
        from dataclasses import replace

        from lutcore.shading import exitance

        settled = self.settled(session, model, axes)
        inputs = self.inputs(session, axes)
        shares = self.visibility(session, settled.local, world_lights(session, axes))
        if not settled.local or len(inputs.lights) == 0:
            return exitance(settled, replace(inputs, visibility=shares))

        surface = self._surface_key(session)

        def lit(light: int) -> FloatArray:
            key = (*surface, settled, inputs.lights[light].tobytes())
            alone = replace(
                inputs,
                lights=inputs.lights[light : light + 1],
                visibility=None if shares is None else shares[light : light + 1],
            )
            return self.once(("light", shares is None, *key), lambda: exitance(settled, alone))

        # Light by light, so that where one is moved the others are there already.
        first, *others = (lit(light) for light in range(len(inputs.lights)))
        total = first
        for other in others:
            total = total + other
        return total

    def settled(self, session: Session, model: Method, axes: FloatArray) -> "ShadingModel":
        """Return the model that a scene is shaded with, where `auto` leaves it open.

        Parameters
        ----------
        session : Session
            Everything but its own model and shadows is used.
        model : Method
            The shading model.
        axes : ndarray, shape=(3, 3)
            The camera's axes, for lights that move with it.

        Returns
        -------
        ShadingModel
            The model itself but for `auto`; see `app.settling` for its name.
        """
        from lutcore.parameters import create
        from lutcore.shading import AUTO, ShadingModel, model_registry

        plugin = model_registry.get(model.name)
        chosen = create(plugin, f"shading model {model.name!r}", dict(model.parameters))
        if plugin.settled is ShadingModel.settled:
            return chosen
        if model.name != AUTO:
            return chosen.settled(self.inputs(session, axes))
        from app.costs import measured

        measured(self.progress)  # once on this machine, not in each process
        key = ("settled", *self._scene_key(session, model, axes))
        return self.once(key, lambda: chosen.settled(self.inputs(session, axes)))

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
        from dataclasses import replace

        from lutcore.lights import pack
        from lutcore.shading import shading_inputs

        unlit = self.once(
            ("inputs", *self._surface_key(session)),
            lambda: shading_inputs(
                self.subject(session).mesh,
                self.curvatures(session),
                self.material(session),
                (),
                self.mm_per_unit(session),
                profile=self.profile(session),
                detail=self.detail(session),
            ),
        )
        return replace(unlit, lights=pack(world_lights(session, axes)), progress=self.progress)

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
        key = ("detail", subject.key, _key((session.material, session.profile, size)))
        return self.once(
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
        self, session: Session, local: bool, lights: "Sequence[Light]"
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
        key = ("visibility", subject.key, packed.tobytes())
        seen = self.once(key, lambda: visibility(subject.mesh, packed, self.progress))
        if not local:
            return seen
        table, size = self._table(session), self.mm_per_unit(session)
        glow = table.mean_free_path * table.psi[:, 0] / size
        return self.once(
            (*key, glow.tobytes()), lambda: softened(seen, subject.mesh, glow, self.progress)
        )

    def _scene_key(self, session: Session, model: Method, axes: FloatArray) -> tuple[Hashable, ...]:
        from lutcore.lights import pack

        lights = pack(world_lights(session, axes)).tobytes()
        return *self._surface_key(session), _key(model), lights

    def _surface_key(self, session: Session) -> tuple[Hashable, ...]:
        return (
            *self._curvature_key(session),
            # A scale that is given is one for all channels, one that is found is not.
            session.scale is None,
            _key((session.material, session.profile, self.mm_per_unit(session))),
        )

    def _curvature_key(self, session: Session) -> tuple[Hashable, ...]:
        return self.subject(session).key, _key((session.estimator, self.scale(session)))

    def once(self, key: tuple[Hashable, ...], compute: Callable[[], T]) -> T:
        """Return what a step gave, computed at most once while it is kept.

        Parameters
        ----------
        key : tuple
            The step's name, and all that its result depends on.
        compute : callable
            Gives the result.

        Returns
        -------
        object
            The result.
        """
        step = str(key[0])
        kept = self._kept.setdefault(step, OrderedDict())
        if key not in kept:
            kept[key] = compute()
            while len(kept) > _KEPT_OF.get(step, _KEPT):
                kept.popitem(last=False)
        kept.move_to_end(key)
        return cast(T, kept[key])


def _stamp(path: Path) -> tuple[int, int] | None:
    """Tell one state of a file from another; None where the loader will say what is wrong."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size


def _key(part: object) -> bytes:
    return msgspec.json.encode(part, order="sorted")
