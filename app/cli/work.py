"""What the commands that work on a mesh have in common: run a session, write, report."""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from app import session as state
from app.cli.console import answer, note, progress
from app.pipeline import Pipeline
from app.session import Camera, Session
from app.writing import check_writable, replacing
from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from app.failing import Failing
    from app.picture import Picture


class Run:
    """One command at work on one session.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    session : Session
        What is asked for.
    """

    def __init__(self, arguments: argparse.Namespace, session: Session) -> None:
        self.arguments = arguments
        self.session = session
        self.output: Path = arguments.output
        self.pipeline = Pipeline(progress(arguments))
        self._start = time.perf_counter()

    def require(self, *suffixes: str) -> None:
        """Make sure, before any work, that the output can be written.

        Parameters
        ----------
        *suffixes : str
            Endings that the command can write.

        Raises
        ------
        ParameterError
            If the output ends otherwise.
        WriteError
            If it cannot be written there.
        """
        if self.output.suffix.lower() not in suffixes:
            name = self.output.suffix or self.output.name
            raise ParameterError.unknown("output format", name, suffixes)
        self._refuse_overwriting()
        check_writable(self.output)

    def _refuse_overwriting(self) -> None:
        """Keep a result from replacing its mesh, and the session from replacing the result."""
        mesh, saved = Path(self.session.mesh), self.arguments.save_session
        for place in (self.output, *([saved] if saved else [])):
            if place.exists() and mesh.is_file() and place.samefile(mesh):
                raise ParameterError(f"{place} is the mesh itself; choose another name")
        if saved and saved.resolve() == self.output.resolve():
            raise ParameterError(f"{saved} is also the output; choose another name for the session")

    def warn(self) -> list[str]:
        """Say what is odd about the mesh and return it.

        Returns
        -------
        list of str
            Warnings, each one line.
        """
        subject = self.pipeline.subject(self.session)
        if self.arguments.quiet and not self.arguments.json:
            return []  # nobody would read them, and a million faces take most of a second
        size = self.pipeline.mm_per_unit(self.session)
        warnings = [*subject.warnings, *subject.loaded.health.remarks(size)]
        if self.session.mm_per_unit is None and subject.sample is None:
            warnings.append("1 mesh unit is taken as 1 mm; say --mm-per-unit if it is not")
        if self.session.view != "curvature" and self.pipeline.floored(self.session):
            warnings.append(
                f"{self.pipeline.material(self.session).name} absorbs so little that its glow has "
                "no end; it is shaded with that of the least absorption that has one"
            )
        for warning in warnings:
            note(self.arguments, f"{self.session.mesh}: {warning}")
        return warnings

    def _failing(self) -> "list[Failing]":
        unheard = self.arguments.quiet and not self.arguments.json
        if self.session.view == "curvature" or unheard:
            return []
        from app.failing import failing

        comparing = self.session.view == "compare"
        models = self.session.compared if comparing else (self.session.model,)
        return failing(self.session, self.pipeline, models)

    def exitance(self, camera: Camera | None = None) -> FloatArray:
        """Return the radiant exitance that the session's model gives.

        Parameters
        ----------
        camera : Camera, optional
            The one that a picture was taken from, for lights that move with it.

        Returns
        -------
        ndarray, shape=(n, 3)
            Linear RGB.
        """
        from app.camera import axes, camera_of

        if camera is None:
            camera = camera_of(self.session.camera, self.pipeline.subject(self.session), 1.0)
        return self.pipeline.exitance(self.session, self.session.model, axes(camera))

    def draw(self) -> "Picture":
        """Make the session's picture and write it as PNG.

        Returns
        -------
        Picture
            What was written.
        """
        from PIL import Image

        from app.picture import render

        made = render(self.session, self.pipeline)

        with replacing(self.output) as beside:
            # Level 1 writes five times faster than the default for a tenth more bytes.
            Image.fromarray(made.image).save(beside, format="PNG", compress_level=1)
        return made

    def summary(self, warnings: list[str]) -> dict[str, object]:
        """Return what every command's JSON object begins with, and warn of models that fail.

        Parameters
        ----------
        warnings : list of str
            From `warn`.

        Returns
        -------
        dict
            Mesh, its digest and size, scale, output, warnings, models that fail, seconds.
        """
        subject = self.pipeline.subject(self.session)
        failing = self._failing()
        for one in failing:
            note(self.arguments, f"{self.session.mesh}: {one.sentence}")
        return {
            "mesh": self.session.mesh,
            "sha256": subject.loaded.digest,
            "vertices": len(subject.mesh.vertices),
            "faces": len(subject.mesh.faces),
            "mm_per_unit": self.pipeline.mm_per_unit(self.session),
            "output": str(self.output),
            "warnings": [*warnings, *(one.sentence for one in failing)],
            "failing": [one.as_json() for one in failing],
            "seconds": round(time.perf_counter() - self._start, 3),
        }

    def finish(self, result: dict[str, object], text: str) -> None:
        """Write the session, if asked to, and print the answer.

        Parameters
        ----------
        result : dict
            What a script reads.
        text : str
            What a person reads.
        """
        if self.arguments.save_session:
            state.write(self.session, self.arguments.save_session)
        answer(self.arguments, result, text)
