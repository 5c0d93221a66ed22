"""Whether a picture is what its own record makes, and if not, why."""

from dataclasses import dataclass
from pathlib import Path

from msgspec.structs import replace

from app.likeness import THRESHOLD, Likeness, likeness
from app.picture import render
from app.pipeline import Pipeline
from app.provenance import read_pixels, read_record
from app.record import Record, elsewhere, pixels_digest, record_of
from app.redrawing import redrawing
from app.render import Image
from app.versions import MAKER

_SHOWN = 12


@dataclass(frozen=True, eq=False)
class Verdict:
    """What became of redrawing a picture.

    Parameters
    ----------
    then : Record
        What the picture says of itself.
    now : Record
        What the redrawn one would say.
    edited : bool
        Whether its metadata are not those that were written.
    repainted : bool
        Whether its pixels are not those that were written.
    likeness : Likeness
        The picture beside the redrawn one.
    expected, redrawn : ndarray of uint8, shape=(height, width, 3 or 4)
        Both.
    """

    then: Record
    now: Record
    edited: bool
    repainted: bool
    likeness: Likeness
    expected: Image
    redrawn: Image

    @property
    def same(self) -> bool:
        """Whether the picture is what its record makes, and neither was touched.

        Of another mesh only the same bits will do: what is within limits may be what was changed.
        """
        if self.mesh_changed and not self.untouched:
            return False
        return self.alike and not self.edited and not self.repainted

    @property
    def alike(self) -> bool:
        """Whether it is as like the redrawn one as it must be."""
        return self.likeness.alike

    @property
    def untouched(self) -> bool:
        """Whether not a bit differs."""
        return not self.likeness.pixels

    @property
    def mesh_changed(self) -> bool:
        """Whether the mesh is not the one that was drawn."""
        return self.then.mesh.sha256 != self.now.mesh.sha256

    @property
    def versions(self) -> dict[str, tuple[str, str]]:
        """By package, its version then and now, where they differ; empty for none."""
        then, now = self.then.versions, self.now.versions
        pairs = {name: (then.get(name, ""), now.get(name, "")) for name in then | now}
        return {name: (one, other) for name, (one, other) in pairs.items() if one != other}

    @property
    def elsewhere(self) -> str:
        """What drew it, if that is not what draws here; see `app.record.elsewhere`."""
        return elsewhere(self.then, self.now)

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was found, in words: the verdict, then its reasons."""
        found = [f"{self._heading}: {self._measure}"]
        if self.edited:
            found.append(
                "its metadata were edited after it was written: they do not fit their own digest, "
                "so what they say of session, mesh and versions cannot be trusted"
            )
        if self.repainted:
            again = self.now.pixels == self.then.pixels
            found.append(
                "its pixels were changed after it was written"
                + ("; the redrawn picture is the one that was written" if again else "")
            )
        if self.mesh_changed:
            found.append(
                f"the mesh {self.then.session.mesh} is not the one that was drawn "
                f"({self.then.mesh.vertices:,} vertices, SHA-256 "
                f"{self.then.mesh.sha256[:_SHOWN]}...): it was changed or replaced since"
            )
        if self.versions:
            found.append(self._other_versions())
        then, now = self.then.resolved.model, self.now.resolved.model
        if then != now:
            found.append(
                f"the model auto took {then} then and {now} here, for models cost otherwise here: "
                "name a model for pictures that others shall reproduce"
            )
        if self.elsewhere:
            found.append(f"{self.elsewhere}, so pictures are compared as eyes see them")
        if len(found) == 1 and not self.same:
            found.append(
                "mesh, metadata, versions and driver are those that made it: run it again, and "
                "report it if it still differs"
            )
        return tuple(found)

    @property
    def _measure(self) -> str:
        return self.likeness.sentence

    @property
    def _heading(self) -> str:
        if not self.alike:
            return "not reproduced"
        if self.edited or self.repainted:
            return "touched, though it can be redrawn"
        if not self.same:
            return "within limits, but of another mesh"
        return "reproduced bit for bit" if self.untouched else "reproduced within limits"

    def _other_versions(self) -> str:
        maker = self.versions.get(MAKER)
        others = ", ".join(
            f"{name} {then or 'none'} (here {now or 'none'})"
            for name, (then, now) in self.versions.items()
            if name != MAKER
        )
        made = f"made by Curvelight {maker[0]}, this is {maker[1]}" if maker else "made"
        made += f" with {others}" if others else ""
        advice = f"; install Curvelight {maker[0]} to make the same picture" if maker else ""
        return made + ("" if self.alike else advice)

    def as_json(self) -> dict[str, object]:
        """Return the verdict as plain data.

        Returns
        -------
        dict
            With the measures of `Likeness.as_json`.
        """
        return {
            "same": self.same,
            "metadata_edited": self.edited,
            "pixels_edited": self.repainted,
            "mesh_changed": self.mesh_changed,
            "versions": {name: list(pair) for name, pair in self.versions.items()},
            "elsewhere": self.elsewhere or None,
            "likeness": self.likeness.as_json(),
            "findings": list(self.sentences),
        }


def verify(
    path: Path, pipeline: Pipeline, mesh: str | None = None, threshold: float | None = None
) -> Verdict:
    """Redraw a picture from what it says of itself, and compare.

    Parameters
    ----------
    path : Path
        A PNG file that Curvelight wrote.
    pipeline : Pipeline
        Where arrays come from.
    mesh : str, optional
        Where the mesh is now, if not where the picture says.
    threshold : float, optional
        Largest local CIEDE2000 (see `app.likeness.likeness`). Without one, every bit counts if the
        same driver, VTK and kind of processor drew it, else `THRESHOLD` is used.

    Returns
    -------
    Verdict
        Same or not, and why.

    Raises
    ------
    PictureError
        If the picture cannot be read, has no record, or cannot be redrawn here.
    MeshError, DrawingError
        If the mesh or the machine does not allow it.
    """
    stored, expected = read_record(path), read_pixels(path)
    then = stored.record
    if mesh is not None:
        then = replace(then, session=replace(then.session, mesh=mesh))
    with redrawing(path, then, stored.edited):
        made = render(then.session, pipeline)
    now = record_of(then.session, pipeline, made)
    if threshold is None and elsewhere(then, now):
        threshold = THRESHOLD
    return Verdict(
        then,
        now,
        stored.edited,
        pixels_digest(expected) != then.pixels,
        likeness(expected, made.image, threshold),
        expected,
        made.image,
    )
