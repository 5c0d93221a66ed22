"""The curvature of a session, and what is drawn of it."""

from collections.abc import Hashable
from typing import TYPE_CHECKING

from msgspec.structs import replace

from app.session import Session
from app.steps.detail import Details
from app.steps.kept import key_of
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import MeshError
from lutcore.isolated import IsolatedError
from lutcore.progress import Progress

if TYPE_CHECKING:
    from app.consultation import Consultation
    from app.strokes import Strokes


class Measurements(Details):
    """Estimates curvature, at a scale that fits what it is for."""

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
        IsolatedError
            If another package's estimator fails on it.
        """
        try:
            found = self.once(
                ("curvatures", *self.curvature_key(session)),
                lambda: self._estimate(session, self.progress),
            )
        except IsolatedError as error:
            raise IsolatedError(
                f"{session.mesh}: {session.estimator.name}: {error}; choose another estimator, "
                "or repair the mesh"
            ) from error
        if not found.estimated.any():
            raise self._no_surface(session)
        return found

    def facing(self, session: Session) -> FloatArray:
        """Return the normals of a session that shades, for all that has no channels.

        Parameters
        ----------
        session : Session
            As for `curvatures`, whose normals they are: less is computed where only they are
            needed.

        Returns
        -------
        ndarray, shape=(n, 3)
            Outward unit normals; zero where a vertex has no face.

        Raises
        ------
        MeshError
            If no face has an area.
        """
        seen = self.detail(session)
        if seen is None or session.view == "curvature":
            return self.curvatures(session).normals
        if not seen.faced:
            raise self._no_surface(session)
        return seen.smooth

    def _no_surface(self, session: Session) -> MeshError:
        return MeshError(
            f"{session.mesh}: none of its {len(self.subject(session).mesh.faces)} "
            "faces has an area, so there is no surface; choose another file"
        )

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

        key = ("peers", *(self.curvature_key(one) for one in sessions))
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
        key = ("strokes", *self.curvature_key(session))
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
        seen = None if session.view == "curvature" else self.detail(session)
        return None if seen is None else seen.scale

    def curvature_key(self, session: Session) -> tuple[Hashable, ...]:
        """Return all that the curvature depends on.

        Parameters
        ----------
        session : Session
            Its mesh, estimator and scale are used.

        Returns
        -------
        tuple
            For `once`.
        """
        return self.subject(session).key, key_of((session.estimator, self.scale(session)))

    def surface_key(self, session: Session) -> tuple[Hashable, ...]:
        """Return all that a surface depends on as it is shaded.

        Parameters
        ----------
        session : Session
            Everything but its model, lights and shadows is used.

        Returns
        -------
        tuple
            For `once`.
        """
        return (
            *self.curvature_key(session),
            # A scale that is given is one for all channels, one that is found is not.
            session.scale is None,
            key_of((session.material, session.profile, self.mm_per_unit(session))),
        )
