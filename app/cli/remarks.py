"""What is odd about a session's mesh and its size, and what its material cannot have."""

from typing import TYPE_CHECKING

from app.contestants import alone
from app.pipeline import Pipeline
from app.session import Session

if TYPE_CHECKING:
    from lutcore.health import MeshHealth


def remarks(session: Session, pipeline: Pipeline) -> list[str]:
    """Return what a user should know before trusting a result.

    Parameters
    ----------
    session : Session
        The session.
    pipeline : Pipeline
        Where its arrays come from.

    Returns
    -------
    list of str
        Warnings, each one line.

    Raises
    ------
    MeshError, ParameterError
        As the pipeline.
    """
    subject, size = pipeline.subject(session), pipeline.mm_per_unit(session)
    warnings = [*subject.warnings, *subject.loaded.health.remarks(size)]
    done = {repair.kind for repair in session.repairs}
    wanted = [kind for kind in _wanted(subject.loaded.health) if kind not in done]
    if wanted:
        flags = " ".join(f"--repair {kind}" for kind in wanted)
        warnings.append(f"it can be repaired first: {flags}")
    if session.mm_per_unit is None and subject.mm_per_unit is None:
        warnings.append("1 mesh unit is taken as 1 mm; say --mm-per-unit if it is not")
    shaded = [one for one in alone(session) if one.view != "curvature"]
    floored = [one for one in shaded if pipeline.floored(one)]
    names = dict.fromkeys(pipeline.material(one).name for one in floored)
    return warnings + [
        f"{name} absorbs so little that its glow has no end; it is shaded with that of the "
        "least absorption that has one"
        for name in names
    ]


def _wanted(health: "MeshHealth") -> list[str]:
    """Return the repairs, in order, of what makes curvature wrong rather than less certain."""
    defects = {
        # Less than two faces hang together: a soup whose corners do not quite meet.
        "merge": health.islands > 1 and 2 * health.islands > health.faces,
        "manifold": health.nonmanifold_edges,
        "orient": health.flipped_edges or health.inside_out_islands,
    }
    return [kind for kind, count in defects.items() if count]
