"""Vertices within a length along the surface, for compiled loops."""

import numpy as np

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled

BLOCK = 1 << 16
"""Vertices between two looks at the caller's wish to stop."""


@compiled()
def gather_ball(
    centre: int,
    radius: float,
    least: int,
    vertices: FloatArray,
    start: IndexArray,
    neighbour: IndexArray,
    seen: IndexArray,
    ball: IndexArray,
) -> int:
    """Collect the vertices within a radius that edges inside the ball reach from its centre.

    Parameters
    ----------
    centre : int
        Vertex in the middle.
    radius : float
        Radius, mesh units.
    least : int
        Number of vertices that whole rings are added for, even from outside the ball.
    vertices : ndarray, shape=(n, 3)
        Positions.
    start, neighbour : ndarray of int32
        The neighbours of each vertex.
    seen : ndarray of int32, shape=(n,)
        Scratch; each centre marks with its own number + 1, so it is cleared once for all.
    ball : ndarray of int32, shape=(n,)
        Receives the vertices, nearest rings first, the centre before all.

    Returns
    -------
    int
        Their number.
    """
    mark = np.int32(centre + 1)
    ball[0] = centre
    seen[centre] = mark
    count, at, ring, hungry = 1, 0, 1, least > 1
    x, y, z = vertices[centre, 0], vertices[centre, 1], vertices[centre, 2]
    while at < count:
        if at == ring:  # a whole ring or none of it: the order of neighbours must not matter
            ring, hungry = count, count < least
        member = ball[at]
        at += 1
        for slot in range(start[member], start[member + 1]):
            other = neighbour[slot]
            if seen[other] == mark:
                continue
            dx, dy, dz = vertices[other, 0] - x, vertices[other, 1] - y, vertices[other, 2] - z
            if hungry or dx * dx + dy * dy + dz * dz <= radius * radius:
                seen[other] = mark
                ball[count] = other
                count += 1
    return count
