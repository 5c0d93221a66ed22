"""What stands for the truth on a mesh whose true curvature nobody knows.

How little an estimate changes under noise says nothing of how right it is: a constant does not
change at all. So its distance from what the others see is counted too. Of each estimator the
finest setting that noise hardly moves has a vote: anything finer is noise, anything coarser has
smoothed more than it must. The reference of an estimator is the median of the others' votes,
vertex by vertex, its own left out, so that nobody is near the reference for having made it.

What this cannot tell: a bias that most of the votes share, and the mesh's own noise from detail.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray

STEADY = 0.1
"""Root mean square change under noise, over the median curvedness, that votes are below."""


@dataclass(frozen=True, eq=False)
class Seen:
    """What one contestant saw.

    Parameters
    ----------
    name : str
        Of the estimator.
    scale : float
        Length it averaged over, mesh units; 0 for one-ring methods.
    values : ndarray, shape=(n, 2)
        k1 and k2 on the mesh as it is, 1/mesh unit.
    change : float
        Root mean square by which they change under noise, 1/mesh unit.
    """

    name: str
    scale: float
    values: FloatArray
    change: float


def distance(one: FloatArray, other: FloatArray) -> float:
    """Return by how much curvatures differ.

    Parameters
    ----------
    one, other : ndarray, shape=(n, 2)
        k1 and k2, 1/mesh unit.

    Returns
    -------
    float
        Root mean square over both and over the vertices.
    """
    return float(np.sqrt(np.mean(np.square(one - other))))


def size(values: FloatArray) -> float:
    """Return how much a surface is curved.

    Parameters
    ----------
    values : ndarray, shape=(n, 2)
        k1 and k2, 1/mesh unit.

    Returns
    -------
    float
        Median of the curvedness, 1/mesh unit.
    """
    return float(np.median(np.sqrt(np.square(values).mean(axis=1))))


def votes(seen: Sequence[Seen]) -> dict[str, Seen]:
    """Return the finest steady setting of each estimator.

    Parameters
    ----------
    seen : sequence of Seen
        All contestants.

    Returns
    -------
    dict of str to Seen
        By estimator; those with no steady setting are left out.
    """
    found: dict[str, Seen] = {}
    for one in seen:
        if not one.change <= STEADY * size(one.values):
            continue
        if one.name not in found or one.scale < found[one.name].scale:
            found[one.name] = one
    return found


def biases(seen: Sequence[Seen]) -> tuple[list[float], float] | None:
    """Return how far each contestant is from what the others see.

    Parameters
    ----------
    seen : sequence of Seen
        All contestants; the same vertices of each.

    Returns
    -------
    biases : list of float
        Distance from the median of the others' votes, 1/mesh unit; from its own vote where there
        is no other.
    size : float
        Median curvedness of the median of all votes, 1/mesh unit.
    None
        If no setting of any estimator is steady, or most of those that are see no curvature:
        nothing stands for the truth.
    """
    voting = votes(seen)
    if not voting:
        return None
    references: dict[str, FloatArray] = {}
    for name in {one.name for one in seen}:
        others = [vote.values for voter, vote in voting.items() if voter != name]
        references[name] = _middle(others or [voting[name].values])
    whole = size(_middle([vote.values for vote in voting.values()]))
    if whole == 0.0:
        return None
    return [distance(one.values, references[one.name]) for one in seen], whole


def _middle(fields: Sequence[FloatArray]) -> FloatArray:
    return fields[0] if len(fields) == 1 else np.median(np.stack(fields), axis=0)
