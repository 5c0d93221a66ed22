"""What is said of one mesh beside its pictures: curvature in numbers, chosen models, failures."""

from typing import TYPE_CHECKING

from app.quantities import QUANTITIES, raw
from app.session import Session
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import CurvelightError, MeshError, ParameterError
from lutcore.statistics import percentiles

if TYPE_CHECKING:
    from app.picture import Picture
    from app.pipeline import Pipeline

REASONS = {2: "parameter", 3: "unreadable", 4: "no surface"}
"""Why a mesh failed, by the exit code that a single command would end with."""
FAULT = "fault"


def measured(curvatures: PrincipalCurvatures) -> dict[str, dict[str, float | None]]:
    """Return percentiles of curvature.

    Parameters
    ----------
    curvatures : PrincipalCurvatures
        In 1/mesh unit.

    Returns
    -------
    dict of str to dict
        By quantity over the vertices with an estimate, in mesh units.
    """
    seen = curvatures.estimated
    return {
        name: percentiles(raw(name, curvatures)[seen])
        for name in QUANTITIES
        if name != "disagreement"
    }


def chosen(session: Session, pipeline: "Pipeline", made: "Picture") -> str:
    """Return which model a picture was shaded with in the end.

    Parameters
    ----------
    session : Session
        What was drawn.
    pipeline : Pipeline
        Where arrays come from.
    made : Picture
        The picture: lights may move with its camera.

    Returns
    -------
    str
        The model itself, or for `auto` what it came to.
    """
    from app.camera import axes
    from app.settling import settled

    return settled(pipeline.settled(session, session.model, axes(made.camera))).label


def failure(error: BaseException) -> dict[str, object]:
    """Say why a result could not be made.

    Parameters
    ----------
    error : BaseException
        What was raised.

    Returns
    -------
    dict
        ``reason`` in a word, and the ``message``.
    """
    if isinstance(error, MemoryError):
        return {"reason": "memory", "message": "not enough memory; decimate the mesh"}
    if not isinstance(error, CurvelightError):
        return {
            "reason": FAULT,
            "message": f"fault in the program: {type(error).__name__}: {error}",
        }
    reason = FAULT
    if isinstance(error, MeshError | ParameterError):
        from app.cli.main import exit_code

        reason = REASONS[exit_code(error)]
    return {"reason": reason, "message": str(error)}
