"""Which lights reach which vertices."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.session import Session
from app.steps.curvature import Measurements
from lutcore.arrays import FloatArray

if TYPE_CHECKING:
    from lutcore.lights import Light
    from lutcore.visibility import ShadowForecast


class Visibility(Measurements):
    """Casts shadows."""

    def casting(self, session: Session, lights: "Sequence[Light]") -> bool:
        """Tell whether the surface casts shadows.

        Parameters
        ----------
        session : Session
            Its `casts` and, for `auto`, its mesh and curvature are used.
        lights : sequence of DirectionalLight, PointLight or ConeLight
            The lights, in world axes.

        Returns
        -------
        bool
            Always false without lights.
        """
        if session.casts != "auto" or not lights:
            return session.casts == "on" and bool(lights)
        return self.forecast(session, lights).needed

    def forecast(self, session: Session, lights: "Sequence[Light]") -> "ShadowForecast":
        """Return what cast shadows would change, by which `auto` casts them.

        Parameters
        ----------
        session : Session
            Its mesh and what it is shaded by are used.
        lights : sequence of DirectionalLight, PointLight or ConeLight
            The lights, in world axes; one or more.

        Returns
        -------
        ShadowForecast
            The same for all models.
        """
        from lutcore.lights import pack
        from lutcore.visibility import forecast

        packed = pack(lights)
        return self.once(
            ("forecast", *self.surface_key(session), packed.tobytes()),
            lambda: forecast(self.subject(session).mesh, self.facing(session), packed),
        )

    def visibility(
        self, session: Session, local: bool, lights: "Sequence[Light]"
    ) -> FloatArray | None:
        """Return which lights reach which vertices, as a model needs it.

        Parameters
        ----------
        session : Session
            Its mesh, `casts`, material, profile and, for `auto`, its curvature are used.
        local : bool
            Whether for a local model, which gets shadows that are softened as light spreads.
        lights : sequence of DirectionalLight, PointLight or ConeLight
            The lights, in world axes.

        Returns
        -------
        ndarray, shape=(l, n) or (l, n, 3), or None
            Shares from 0 to 1; None where the session casts no shadows.
        """
        if not self.casting(session, lights):
            return None
        from lutcore.lights import pack
        from lutcore.visibility import softened, visibility

        subject = self.subject(session)
        packed = pack(lights)
        key = ("visibility", subject.key, packed.tobytes())
        seen = self.once(key, lambda: visibility(subject.mesh, packed, self.progress))
        if not local:
            return seen
        table, size = self.table(session), self.mm_per_unit(session)
        glow = table.mean_free_path * table.psi[:, 0] / size
        return self.once(
            (*key, glow.tobytes()), lambda: softened(seen, subject.mesh, glow, self.progress)
        )
