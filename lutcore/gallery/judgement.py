"""What an estimate is worth where the truth is known."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import CurvelightError
from lutcore.gallery.case import Subject
from lutcore.isolated import IsolatedError

SURVIVES_BELOW, DEGRADED_BELOW = 0.1, 0.5
# A vertex has a side that its mean curvature must tell if that is this share of the RMS.
_CLEAR = 0.25


class Verdict(StrEnum):
    """What became of an estimator on a case."""

    SURVIVES = "survives"
    DEGRADED = "degraded"
    WRONG = "wrong"
    REFUSED = "refused"
    DIED = "died"


REASONS = {
    Verdict.SURVIVES: f"error up to {SURVIVES_BELOW:g} of the RMS curvature: 99 % of the squared "
    "curvature is explained, the values can be read as numbers",
    Verdict.DEGRADED: f"error up to {DEGRADED_BELOW:g}: three quarters are explained, enough to "
    "tell large from small and convex from concave, not for numbers",
    Verdict.WRONG: f"error above {DEGRADED_BELOW:g} (calling everything flat has 1), values that "
    "are not finite, too few or out of order, or the wrong sign at most vertices",
    Verdict.REFUSED: "no values, and a message that says why",
    Verdict.DIED: "crashed, or was stopped for its time or memory",
}
"""What each verdict means, with its threshold and the reason for it."""


@dataclass(frozen=True)
class Score:
    """Errors of an estimate at the vertices that are judged.

    Parameters
    ----------
    error : float
        RMS of |(k1, k2) - exact| over the RMS curvature; infinite if a value is not finite.
    worst : float
        99th percentile of |(k1, k2) - exact| over the RMS curvature.
    turned : float
        Share of the vertices with a clear side whose mean curvature has the wrong sign.
    missing : float
        Share that the estimator itself says it could not estimate.
    within_1, within_2 : float or None
        Share of k1 and k2 that are within one and two of their own error bars; None without any.
    fault : str
        What no estimate may do, in words; empty if it does not.
    """

    error: float
    worst: float
    turned: float
    missing: float
    within_1: float | None
    within_2: float | None
    fault: str

    @property
    def verdict(self) -> Verdict:
        """The class that the errors fall into."""
        if self.fault or not self.error <= DEGRADED_BELOW:
            return Verdict.WRONG
        return Verdict.SURVIVES if self.error <= SURVIVES_BELOW else Verdict.DEGRADED


def score(found: PrincipalCurvatures, subject: Subject) -> Score:
    """Compare an estimate with the truth.

    Parameters
    ----------
    found : PrincipalCurvatures
        What the estimator said of the subject's mesh.
    subject : Subject
        Mesh and truth.

    Returns
    -------
    Score
        The errors.
    """
    arrays = (found.k1, found.k2, found.error)
    count = len(subject.mesh.vertices)
    if any(array.shape != (count,) for array in arrays):
        return _failed(f"gave {len(found.k1)} values for {count} vertices")
    finite = np.isfinite(found.k1) & np.isfinite(found.k2) & ~np.isnan(found.error)
    if not finite.all():
        return _failed(f"{np.count_nonzero(~finite)} of {count} vertices are not finite")
    judged = subject.judged
    exact = np.stack([subject.k1[judged], subject.k2[judged]])
    given = np.stack([found.k1[judged], found.k2[judged]])
    size = float(np.sqrt(np.square(exact).sum(axis=0).mean()))
    # Relative before squaring: a wild value must not overflow.
    off = np.abs(given / size - exact / size)
    distance = np.hypot(off[0], off[1])
    scale = max(float(distance.max()), 1.0)
    turned = _turned(given.mean(axis=0), exact.mean(axis=0), size)
    bar = found.error[judged] / size
    known = np.isfinite(bar)
    return Score(
        error=scale * float(np.sqrt(np.square(distance / scale).mean())),
        worst=float(np.percentile(distance, 99.0)),
        turned=turned,
        missing=float(np.mean(~known)),
        within_1=_within(off[:, known], bar[known]),
        within_2=_within(off[:, known], 2.0 * bar[known]),
        fault=_fault(found, turned),
    )


def verdict_of(error: CurvelightError) -> Verdict:
    """Tell whether an estimator that raised refused or died.

    Parameters
    ----------
    error : CurvelightError
        What it raised.

    Returns
    -------
    Verdict
        Refused or died.
    """
    # A package in a child process refuses by an exception of its own, which arrives in these
    # words; all else that happens to a child is a crash or a limit.
    said = not isinstance(error, IsolatedError) or (
        "failed on it (" in str(error) and not str(error).endswith("(no reason given)")
    )
    return Verdict.REFUSED if said else Verdict.DIED


def _turned(given: FloatArray, exact: FloatArray, size: float) -> float:
    clear = np.abs(exact) > _CLEAR * size
    if not clear.any():
        return 0.0
    return float(np.mean(np.sign(given[clear]) == -np.sign(exact[clear])))


def _within(off: FloatArray, bar: FloatArray) -> float | None:
    return float(np.mean(off <= bar)) if bar.size else None


def _fault(found: PrincipalCurvatures, turned: float) -> str:
    if (found.k1 < found.k2).any():
        return f"k1 < k2 at {np.count_nonzero(found.k1 < found.k2)} vertices"
    if turned > 0.5:
        return f"wrong sign at {turned:.0%} of the vertices"
    return ""


def _failed(fault: str) -> Score:
    return Score(np.inf, np.inf, 0.0, 0.0, None, None, fault)
