"""What the commands that work on a mesh have in common: run a session, write, report."""

import argparse
import dataclasses
import time
from pathlib import Path
from typing import TYPE_CHECKING

from app import session as state
from app.cli.console import answer, note, progress
from app.cli.remarks import remarks
from app.contestants import alone
from app.endings import check_ending
from app.pipeline import Pipeline
from app.session import Camera, Session
from app.writing import check_writable
from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from app.cli.referring import Reference
    from app.failing import Failing
    from app.picture import Picture
    from app.session import Settled


class Run:
    """One command at work on one session.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    session : Session
        What is asked for.
    pipeline : Pipeline, optional
        Where arrays come from, if some are there already.
    """

    def __init__(
        self, arguments: argparse.Namespace, session: Session, pipeline: Pipeline | None = None
    ) -> None:
        self.arguments = arguments
        self.session = session
        self.output: Path = arguments.output
        self.pipeline = pipeline or Pipeline()
        self.pipeline.progress = progress(arguments)
        self.reference: Reference | None = None
        self._camera: Camera | None = None
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
        check_ending(self.output, suffixes)
        self._refuse_overwriting()
        check_writable(self.output)
        if vars(self.arguments).get("reference"):
            from app.cli.referring import Reference

            self.reference = Reference(self.arguments, self.output)

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
        self.pipeline.subject(self.session)
        if self.arguments.quiet and not self.arguments.json:
            return []  # nobody would read them, and a million faces take most of a second
        warnings = remarks(self.session, self.pipeline)
        for warning in warnings:
            note(self.arguments, f"{self.session.mesh}: {warning}")
        return warnings

    def _failing(self) -> "list[Failing]":
        unheard = self.arguments.quiet and not self.arguments.json
        if self.session.view == "curvature" or unheard:
            return []
        from app.failing import failing

        singles = alone(self.session)
        if self.session.view == "compare" and self.session.compared_by == "model":
            return failing(self.session, self.pipeline, [one.model for one in singles])
        found = []
        for one in singles:
            if one.view == "curvature":
                continue
            name = self.pipeline.material(one).name
            several = len(singles) > 1
            for model in failing(one, self.pipeline, (one.model,)):
                label = f"{model.model} with {name}" if several else model.model
                found.append(dataclasses.replace(model, model=label))
        return found

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
        return self.pipeline.exitance(self.session, self.session.model, self._axes(camera))

    def settled(self, camera: Camera | None = None) -> "Settled":
        """Return which model that was, where `auto` leaves it open.

        Parameters
        ----------
        camera : Camera, optional
            As for `exitance`.

        Returns
        -------
        Settled
            Its name and parameters.
        """
        from app.settling import settled

        model = self.session.model
        return settled(self.pipeline.settled(self.session, model, self._axes(camera)))

    def casting(self, camera: Camera | None = None) -> bool:
        """Tell whether the surface casts shadows on itself.

        Parameters
        ----------
        camera : Camera, optional
            As for `exitance`.

        Returns
        -------
        bool
            Also where that is left to the scene.
        """
        from app.lighting import world_lights

        lights = world_lights(self.session, self._axes(camera))
        return self.pipeline.casting(self.session, lights)

    def _axes(self, camera: Camera | None) -> FloatArray:
        from app.camera import axes, camera_of

        if camera is None:
            camera = camera_of(self.session.camera, self.pipeline.subject(self.session), 1.0)
        return axes(camera)

    def draw(self) -> "Picture":
        """Make the session's picture and write it as PNG that says how it was made.

        Returns
        -------
        Picture
            What was written.
        """
        from app.picture import render
        from app.provenance import write_picture
        from app.record import record_of

        made = render(self.session, self.pipeline)
        self._camera = made.camera
        record = record_of(self.session, self.pipeline, made)
        write_picture(self.output, made.image, record)
        if self.reference is not None:
            self.reference.compare(made.image, record)
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

    def finish(self, result: dict[str, object], text: str) -> int:
        """Write the session, if asked to, and print the answer.

        Parameters
        ----------
        result : dict
            What a script reads.
        text : str
            What a person reads.

        Returns
        -------
        int
            Exit code: 6 if the picture differs from its reference.
        """
        if self.arguments.save_session:
            from app.settling import recorded

            kept = recorded(self.session, self.pipeline, self._axes(self._camera))
            state.write(kept, self.arguments.save_session)
        if self.reference is None:
            answer(self.arguments, result, text)
            return 0
        result |= {"reference": self.reference.as_json()}
        answer(self.arguments, result, f"{text}\n{self.reference.sentence}")
        return self.reference.exit_code
