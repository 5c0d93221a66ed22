"""The mesh of a session: loaded, extracted or repaired."""

import dataclasses
from collections.abc import Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from app.loading import LoadedMesh
from app.samples import PREFIX, Sample, sample
from app.session import Repair, Session, Volume
from app.steps.kept import Kept, key_of
from app.volume import load_surface, source_of
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, silent


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
        return self.loaded.digest, key_of((self.volume, self.repairs))

    @property
    def mm_per_unit(self) -> float | None:
        """Size of a mesh unit, where the sample or the file says it."""
        return self.sample.mm_per_unit if self.sample else self.loaded.mm_per_unit

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user must know of the file."""
        remark = self.sample.remark if self.sample else ""
        return (*self.loaded.warnings, *([remark] if remark else []))


class Subjects(Kept):
    """Loads meshes."""

    def __init__(self, progress: Progress = silent) -> None:
        super().__init__(progress)
        self._read: dict[Hashable, Subject] | None = None

    @contextmanager
    def still(self) -> Iterator[None]:
        """Take files as they are when first asked for: a picture asks for them dozens of times."""
        if self._read is not None:
            yield
            return
        self._read = {}
        try:
            yield
        finally:
            self._read = None

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
        read, name = self._read, (session.mesh, key_of(session.volume))
        loaded = None if read is None else read.get(name)
        if loaded is None:
            loaded = self._loaded(session)
            if read is not None:
                read[name] = loaded
        return self._repaired(loaded, session.repairs)

    def _loaded(self, session: Session) -> Subject:
        found = None
        if session.mesh.startswith(PREFIX):
            found = self.once(("sample", session.mesh), lambda: sample(session.mesh))
        source = source_of(found.path if found else Path(session.mesh))
        volume = session.volume
        key = ("subject", *((str(one), _stamp(one)) for one in source.files), key_of(volume))
        return self.once(
            key, lambda: Subject(load_surface(source, volume, self.progress), found, volume)
        )

    def _repaired(self, subject: Subject, repairs: tuple[Repair, ...]) -> Subject:
        """Do repairs in order, each once: one more, or one less, is not to begin anew."""
        if not repairs:
            return subject

        def mend() -> Subject:
            from app.repairing import repaired

            before = self._repaired(subject, repairs[:-1])
            made = repaired(before.loaded, repairs[-1], self.progress)
            return dataclasses.replace(subject, loaded=made, repairs=repairs)

        return self.once(("repaired", subject.key, key_of(repairs)), mend)

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


def _stamp(path: Path) -> tuple[int, int] | None:
    """Tell one state of a file from another; None where the loader will say what is wrong."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size
