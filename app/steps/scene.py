"""The surface and the lights as shading models get them."""

from collections.abc import Hashable
from typing import TYPE_CHECKING

from app.lighting import world_lights
from app.session import Method, Session
from app.steps.kept import key_of
from app.steps.visibility import Visibility
from lutcore.arrays import FloatArray

if TYPE_CHECKING:
    from lutcore.shading import ShadingInputs


class Scenes(Visibility):
    """Prepares what is shaded."""

    def inputs(self, session: Session, axes: FloatArray, curved: bool = True) -> "ShadingInputs":
        """Return what shading models get, without cast shadows.

        Parameters
        ----------
        session : Session
            Everything but its model and shadows is used.
        axes : ndarray, shape=(3, 3)
            The camera's axes, for lights that move with it.
        curved : bool
            Whether with curvature at one scale, for predictions and for models that say so, also
            where `detail` says what each channel sees.

        Returns
        -------
        ShadingInputs
            See `lutcore.shading`.
        """
        from dataclasses import replace

        from lutcore.lights import pack
        from lutcore.shading import shading_inputs

        seen = self.detail(session)
        curved = curved or seen is None
        unlit = self.once(
            ("inputs", curved, *self.surface_key(session)),
            lambda: shading_inputs(
                self.subject(session).mesh,
                self.curvatures(session) if curved else None,
                self.material(session),
                (),
                self.mm_per_unit(session),
                profile=self.profile(session),
                normals=None if curved else self.facing(session),
                detail=seen,
            ),
        )
        return replace(unlit, lights=pack(world_lights(session, axes)), progress=self.progress)

    def shadowed(self, session: Session, axes: FloatArray) -> "ShadingInputs":
        """Return what models are chosen by, with cast shadows where the session has them.

        Parameters
        ----------
        session : Session
            Everything but its model is used.
        axes : ndarray, shape=(3, 3)
            The camera's axes, for lights that move with it.

        Returns
        -------
        ShadingInputs
            With shares of visibility as pictures have them, for local models and for others.
        """
        from dataclasses import replace

        inputs, lights = self.inputs(session, axes), world_lights(session, axes)
        seen, softened = (self.visibility(session, local, lights) for local in (False, True))
        return replace(inputs, visibility=seen, softened=softened)

    def scene_key(self, session: Session, model: Method, axes: FloatArray) -> tuple[Hashable, ...]:
        """Return all that light on the surface depends on, but for shadows.

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
        tuple
            For `once`.
        """
        from lutcore.lights import pack

        lights = pack(world_lights(session, axes)).tobytes()
        return *self.surface_key(session), key_of(model), lights
