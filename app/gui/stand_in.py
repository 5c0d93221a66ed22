"""The coarse mesh in the place of the fine one, in the same renderers."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from app.gui.coarse import Coarse
from app.render import Drawn
from app.scene import ColorScale, Surface, actor_of, recolor, shape_of
from app.session import Vector
from lutcore.arrays import AnyArray

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkActor


class StandIn:
    """Draws coarse meshes beside the fine ones, of which one or the other is visible."""

    def __init__(self) -> None:
        self.coarse: Coarse | None = None
        """What is drawn instead; None where there is nothing to gain."""
        self.shown = False
        self._actors: list[vtkActor | None] = []

    def fill(self, drawn: Sequence[Drawn], origin: Vector) -> None:
        """Put coarse meshes into renderers that have fine ones.

        Parameters
        ----------
        drawn : sequence of Drawn
            What the view holds.
        origin : tuple of 3 floats
            What the geometry is drawn relative to.
        """
        self._remove(drawn)
        self.shown = False
        found = self.coarse
        if found is None:
            return
        shape = shape_of(found.mesh, origin)
        for one in drawn:
            actor, content = None, one.panel.content
            # It may have come before the picture of its mesh, while another is still shown.
            own = content if isinstance(content, Surface) and content.mesh is found.fine else None
            if own is not None and one.actor is not None:
                actor = actor_of(_part(own, found), shape)
                actor.SetProperty(one.actor.GetProperty())
                actor.SetVisibility(False)
                one.renderer.AddActor(actor)
            self._actors.append(actor)

    def of(self, index: int) -> "tuple[vtkActor, AnyArray] | None":
        """Return the coarse mesh of a panel.

        Parameters
        ----------
        index : int
            Which one, as in `fill`.

        Returns
        -------
        (vtkActor, ndarray of int) or None
            It, and which of the fine mesh's vertices it has.
        """
        actor = self._actors[index] if self._actors else None
        return None if actor is None or self.coarse is None else (actor, self.coarse.vertices)

    def recolor(self, contents: Sequence[Surface | ColorScale]) -> None:
        """Follow the colours of the fine meshes.

        Parameters
        ----------
        contents : sequence of Surface or ColorScale
            Of the panels.
        """
        if self.coarse is None:
            return
        for actor, content in zip(self._actors, contents, strict=True):
            if actor is not None and isinstance(content, Surface):
                recolor(actor, _part(content, self.coarse))

    def show(self, drawn: Sequence[Drawn], on: bool) -> None:
        """Show the coarse meshes, or the fine ones.

        Parameters
        ----------
        drawn : sequence of Drawn
            What the view holds.
        on : bool
            Whether the coarse ones.
        """
        if not self._actors or on == self.shown:
            return
        self.shown = on
        for one, actor in zip(drawn, self._actors, strict=True):
            if actor is not None and one.actor is not None:
                actor.SetVisibility(on)
                one.actor.SetVisibility(not on)

    def _remove(self, drawn: Sequence[Drawn]) -> None:
        if len(self._actors) == len(drawn):
            self.show(drawn, False)
        for one in drawn:
            for actor in self._actors:
                if actor is not None and one.renderer.HasViewProp(actor):
                    one.renderer.RemoveActor(actor)
        self._actors = []


def _part(surface: Surface, found: Coarse) -> Surface:
    at, wipe = found.vertices, surface.wipe
    return replace(
        surface,
        mesh=found.mesh,
        normals=surface.normals[at],
        rgb=None if surface.rgb is None else surface.rgb[at],
        values=None if surface.values is None else surface.values[at],
        coat=None,
        wipe=None if wipe is None else replace(wipe, surface=_part(wipe.surface, found)),
    )
