"""The surface as the light of each channel sees it."""

from typing import TYPE_CHECKING

from app.session import Session
from app.steps.kept import key_of
from app.steps.substance import Substances

if TYPE_CHECKING:
    from lutcore.detail import Detail


class Details(Substances):
    """Smooths a surface as far as light spreads in it."""

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
        key = ("detail", subject.key, key_of((session.material, session.profile, size)))
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
