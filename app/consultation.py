"""Several estimators asked about one mesh."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from app.session import Session
from lutcore.curvature import PrincipalCurvatures
from lutcore.disagreement import FEWEST, Disagreement, disagreement
from lutcore.errors import CancelledError, CurvelightError, ParameterError
from lutcore.estimation import estimator_registry
from lutcore.progress import Progress, part

Estimate = Callable[[Session, Progress], PrincipalCurvatures]


@dataclass(frozen=True, eq=False)
class Consultation:
    """What several estimators said of one mesh.

    Parameters
    ----------
    names : tuple of str
        Those that have an estimate, in the disagreement's order.
    disagreement : Disagreement
        How far they are apart.
    refused : dict of str to str
        Those that have none, with the reason.
    """

    names: tuple[str, ...]
    disagreement: Disagreement
    refused: dict[str, str]


def consult(sessions: Sequence[Session], estimate: Estimate, progress: Progress) -> Consultation:
    """Ask each session's estimator, and put what they say together.

    Parameters
    ----------
    sessions : sequence of Session
        One for each estimator.
    estimate : callable
        Estimates the curvature that a session asks for.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Consultation
        Without those that cannot estimate the curvature of this mesh.

    Raises
    ------
    ParameterError
        If a name does not exist or comes twice, or fewer than three are left.
    CancelledError
        If `progress` asked to stop.
    """
    _check(sessions)
    found: dict[str, PrincipalCurvatures] = {}
    refused: dict[str, str] = {}
    for index, session in enumerate(sessions):
        share = part(progress, index / len(sessions), (index + 1) / len(sessions))
        label = session.estimator.label
        try:
            estimated = estimate(session, share)
        except CancelledError:
            raise
        except CurvelightError as error:
            refused[label] = str(error).removeprefix(f"{label}: ")
            continue
        if estimated.estimated.any():
            found[label] = estimated
        else:
            refused[label] = "it has no estimate at any vertex"
    if len(found) < FEWEST:
        reasons = "".join(f"; {label}: {reason}" for label, reason in refused.items())
        raise ParameterError(
            f"a disagreement takes {FEWEST} estimators or more, and {len(found)} of the "
            f"{len(sessions)} named can be used{reasons}; name others with --disagree"
        )
    return Consultation(tuple(found), disagreement(list(found.values())), refused)


def _check(sessions: Sequence[Session]) -> None:
    known = estimator_registry.names()
    methods = [session.estimator for session in sessions]
    for method in methods:
        if method.name not in known:
            raise ParameterError.unknown(estimator_registry.kind, method.name, known)
        if methods.count(method) > 1:
            raise ParameterError(f"{method.label} is named twice; name each estimator once")
    if len(methods) < FEWEST:
        # Before any work, and in words of what was asked for.
        named = ", ".join(method.label for method in methods)
        raise ParameterError(
            f"a disagreement takes {FEWEST} estimators or more, not {len(methods)} ({named}); of "
            "two that differ nobody knows which one errs"
        )
