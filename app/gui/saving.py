"""What the window writes: pictures and data, the same as the commands. Knows no Qt."""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeVar

from msgspec.structs import replace

from app.session import Session, View, from_json, to_json
from lutcore.errors import ParameterError
from lutcore.progress import Progress, tell

if TYPE_CHECKING:
    from app.gui.controller import Controller
    from app.picture import Picture
    from app.pipeline import Pipeline

T = TypeVar("T")
Data = Literal["curvature", "shading"]
# As `curvelight curvature` and `curvelight shade` write them.
SUFFIXES: dict[Data, tuple[str, ...]] = {
    "curvature": (".vtp", ".ply", ".npz", ".csv"),
    "shading": (".vtp", ".ply", ".npz"),
}
_LOOK = 0.1


def save_picture(
    controller: "Controller", path: Path, done: Callable[["Picture"], None] | None = None
) -> None:
    """Write the session's picture, as the command line does with the session saved.

    Parameters
    ----------
    controller : Controller
        Its session says the size and the camera.
    path : Path
        A PNG file.
    done : callable, optional
        Gets the picture when it is written.
    """
    session = _as_read(controller.session)

    def job(progress: Progress) -> "Picture":
        from app.provenance import write_picture
        from app.record import record_of

        made = _drawn(controller, session, progress)
        write_picture(path, made.image, record_of(session, controller.pipeline, made))
        return made

    def written(made: "Picture") -> None:
        controller.noted.emit(f"wrote {path}")
        if done is not None:
            done(made)

    controller.run(f"save {path}", job, written)


def make_picture(
    controller: "Controller", size: tuple[int, int], done: Callable[["Picture"], None]
) -> None:
    """Make the session's picture in a size, for whoever asks.

    Parameters
    ----------
    controller : Controller
        Its session is drawn.
    size : tuple of 2 ints
        Width and height, pixels.
    done : callable
        Gets the picture, on the window's thread.
    """
    session = replace(_as_read(controller.session), size=size)
    controller.run("make picture", lambda progress: _drawn(controller, session, progress), done)


def save_data(
    controller: "Controller", path: Path, kind: Data, done: Callable[[], None] | None = None
) -> None:
    """Write the values at the vertices, as ``curvelight curvature`` or ``shade`` does.

    Parameters
    ----------
    controller : Controller
        Its session says what is measured, or shaded.
    path : Path
        Its ending, one of `SUFFIXES`, says the format.
    kind : str
        What is written.
    done : callable, optional
        Called when it is written.
    """
    # How much curvature is smoothed follows from what it is for.
    view: View = "curvature" if kind == "curvature" else "shade"
    session = replace(_as_read(controller.session), view=view)

    def job(_: Progress) -> None:
        _check(path, session, kind)
        write = _write_curvature if kind == "curvature" else _write_shading
        write(path, session, controller.pipeline)

    def written(_: None) -> None:
        controller.noted.emit(f"wrote {path}")
        if done is not None:
            done()

    controller.run(f"save {path}", job, written)


def _as_read(session: Session) -> Session:
    """Return the session as its file says it: 1 and 1.0 are one number there."""
    return from_json(to_json(session))


def _drawn(controller: "Controller", session: Session, progress: Progress) -> "Picture":
    """Compute here, in the worker's thread, and draw on the window's.

    VTK draws letters with tools that all windows of a process share and nothing guards, so two
    threads must not draw.
    """
    from app.picture import compose, picture_of

    made = compose(session, controller.pipeline)
    return _there(controller, lambda: picture_of(made), progress)


def _there(controller: "Controller", call: Callable[[], T], progress: Progress) -> T:
    """Call on the window's thread and wait, unless one is cancelled or the window closes."""
    results: list[T] = []
    problems: list[Exception] = []
    ended = threading.Event()

    def run() -> None:
        try:
            results.append(call())
        except Exception as error:
            problems.append(error)
        ended.set()

    controller.worker.post(run)
    while not ended.wait(_LOOK):
        tell(progress, 0.95, "drawing")
    if problems:
        raise problems[0]
    return results[0]


def _check(path: Path, session: Session, kind: Data) -> None:
    if path.suffix.lower() not in SUFFIXES[kind]:
        name = path.suffix or path.name
        raise ParameterError.unknown(f"format of {kind} data", name, SUFFIXES[kind])
    mesh = Path(session.mesh)
    if path.exists() and mesh.is_file() and path.samefile(mesh):
        raise ParameterError(f"{path} is the mesh itself; choose another name")


def _write_curvature(path: Path, session: Session, pipeline: "Pipeline") -> None:
    from app import export

    spread = pipeline.consult(session).disagreement.spread if session.peers else None
    arrays = export.curvature_arrays(pipeline.curvatures(session), spread)
    export.save(path, pipeline.subject(session).mesh, arrays)


def _write_shading(path: Path, session: Session, pipeline: "Pipeline") -> None:
    from app import export
    from app.camera import axes, camera_of
    from lutcore.color import auto_exposure

    subject = pipeline.subject(session)
    # Of a square picture, as the command has it: lights may move with the camera.
    camera = camera_of(session.camera, subject, 1.0)
    exitance = pipeline.exitance(session, session.model, axes(camera))
    exposure = session.exposure or auto_exposure(exitance)
    export.save(path, subject.mesh, export.shading_arrays(exitance, exposure))
