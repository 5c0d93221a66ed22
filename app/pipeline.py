"""From a session to per-vertex arrays, each computed once and kept."""

from typing import TYPE_CHECKING

from app.lighting import world_lights
from app.session import Method, Session
from app.steps.kept import key_of
from app.steps.scene import Scenes
from lutcore.arrays import FloatArray

if TYPE_CHECKING:
    from lutcore.draft import Draft
    from lutcore.shading import ShadingModel


class Pipeline(Scenes):
    """Computes what sessions ask for, and keeps the last few results of each step.

    The steps before shading are in `app.steps`, each upon the ones before.

    Parameters
    ----------
    progress : callable
        Told where long work stands; see `lutcore.progress`.
    """

    def exitance(
        self, session: Session, model: Method, axes: FloatArray, drafted: bool = False
    ) -> FloatArray:
        """Return the radiant exitance under a shading model.

        Parameters
        ----------
        session : Session
            Everything but its own model is used.
        model : Method
            The shading model.
        axes : ndarray, shape=(3, 3)
            The camera's axes, for lights that move with it.
        drafted : bool
            Whether nearly is enough, where a model has a quicker way and nothing casts a shadow.

        Returns
        -------
        ndarray, shape=(n, 3)
            Linear RGB; see `lutcore.shade`.
        """
        from app.settling import taken

        said = key_of(taken(session, self, model, axes))
        key = ("exitance", drafted, session.casts, said, *self.scene_key(session, model, axes))
        return self.once(key, lambda: self._shade(session, model, axes, drafted))

    def _shade(
        self, session: Session, model: Method, axes: FloatArray, drafted: bool
    ) -> FloatArray:
        from dataclasses import replace

        from lutcore.exitance import exitance

        settled = self.settled(session, model, axes)
        curved = settled.curved or not settled.local
        inputs = self.inputs(session, axes, curved)
        shares = self.visibility(session, settled.local, world_lights(session, axes))
        if not settled.local or settled.joint or len(inputs.lights) == 0:
            return exitance(settled, replace(inputs, visibility=shares))

        surface = self.surface_key(session)
        draft = self.draft(session, settled, axes) if drafted and shares is None else None

        def lit(light: int) -> FloatArray:
            key = ("light", shares is None, draft is None, *surface, settled)
            lights = inputs.lights[light : light + 1]
            share = None if shares is None else shares[light : light + 1]
            alone = replace(inputs, lights=lights, visibility=share)
            return self.once(
                (*key, lights.tobytes()),
                lambda: exitance(settled, alone) if draft is None else draft.exitance(lights),
            )

        # Light by light, so that where one is moved the others are there already.
        first, *others = (lit(light) for light in range(len(inputs.lights)))
        total = first
        for other in others:
            total = total + other
        return total

    def draft(self, session: Session, settled: "ShadingModel", axes: FloatArray) -> "Draft | None":
        """Return what shades a session nearly under other lights, where its model has such a way.

        Parameters
        ----------
        session : Session
            Everything but its model, lights and shadows is used.
        settled : ShadingModel
            What it is shaded with.
        axes : ndarray, shape=(3, 3)
            Of any camera.

        Returns
        -------
        Draft or None
            See `lutcore.shading.ShadingModel.draft`.
        """
        key = ("draft", *self.surface_key(session), settled)
        return self.once(key, lambda: settled.draft(self.inputs(session, axes, settled.curved)))

    def settled(self, session: Session, model: Method, axes: FloatArray) -> "ShadingModel":
        """Return the model that a scene is shaded with, where `auto` leaves it open.

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
        ShadingModel
            The model itself but for `auto`, which is what the session says that it came to in this
            scene, or is chosen; see `app.settling` for its name.

        Raises
        ------
        ParameterError
            If the session names a model, or a parameter, that does not exist.
        """
        from lutcore.parameters import create
        from lutcore.shading import AUTO, ShadingModel, model_registry

        plugin = model_registry.get(model.name)
        chosen = create(plugin, f"shading model {model.name!r}", dict(model.parameters))
        if plugin.settled is ShadingModel.settled:
            return chosen
        if model.name != AUTO:
            return chosen.settled(self.shadowed(session, axes))
        from app.costs import measured
        from app.settling import model_of, taken

        said = taken(session, self, model, axes)
        if said is not None:
            return model_of(said)
        measured(self.progress)  # once on this machine, not in each process
        key = ("settled", session.casts, *self.scene_key(session, model, axes))
        return self.once(key, lambda: chosen.settled(self.shadowed(session, axes)))
