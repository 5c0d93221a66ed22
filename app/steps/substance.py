"""What the surface is made of, and how light spreads in it."""

from typing import TYPE_CHECKING

from app.session import Session, Substance
from app.steps.subject import Subjects
from lutcore.materials import Material, material

if TYPE_CHECKING:
    from lutcore.diffusion import DiffusionProfile
    from lutcore.lut import PsiTable


class Substances(Subjects):
    """Finds materials, diffusion profiles and their tables."""

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
        return material_of(session.material)

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

    def table(self, session: Session) -> "PsiTable":
        """Return the psi table of the session's material and profile.

        Parameters
        ----------
        session : Session
            Its material and profile are used.

        Returns
        -------
        PsiTable
            Baked once.

        Raises
        ------
        ParameterError
            If a name does not exist, or a value is out of range.
        """
        from lutcore.baking import bake

        return bake(self.material(session), profile=self.profile(session))

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
        return self.table(session).glow / self.mm_per_unit(session)

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
        return bool(self.table(session).floored.any())


def material_of(chosen: str | Substance) -> Material:
    """Return the material that a session names or spells out.

    Parameters
    ----------
    chosen : str or Substance
        `Session.material`.

    Returns
    -------
    Material
        The same.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    if isinstance(chosen, str):
        return material(chosen)
    return Material(chosen.name, chosen.scattering, chosen.absorption, chosen.eta)
