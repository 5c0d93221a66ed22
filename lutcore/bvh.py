"""A hierarchy of boxes over triangles, and the question whether anything stops a ray.

Nodes are stored in the order of a depth-first walk, each with the node that follows its whole
subtree: a ray walks the arrays from front to back and needs no stack.
"""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import BoolArray, FloatArray, IndexArray, finite
from lutcore.compiled import compiled
from lutcore.errors import ParameterError
from lutcore.mesh import TriangleMesh

_LEAF = 4
_BINS = 16
# Splits that leave almost everything on one side are taken at this depth at the latest, so that
# the stack of the build has an end: a median split halves, and 2^31 triangles take 31 halvings.
_MEDIAN_BELOW = 64
_STACK = 2 * (_MEDIAN_BELOW + 32)
# Box distances are off by 3 roundings, so that a box is left only where it is surely missed.
_WIDER = 1.0 + 8.0 * 2.0**-53
# A triangle seen edge on, to this share of its extent squared, is missed: its neighbours are hit.
_EDGE_ON = 1e-14
_HUGE = 1e300


class Bvh(NamedTuple):
    """Boxes over the triangles of a mesh.

    Parameters
    ----------
    box : ndarray, shape=(k, 6)
        Lower and upper corner of each node, mesh units.
    skip : ndarray of int32, shape=(k,)
        The node that follows the node's subtree in a depth-first walk; k after the last.
    first : ndarray of int32, shape=(k,)
        Where the triangles of a leaf begin in `triangle`; -1 for a node that is no leaf.
    triangle : ndarray of int32, shape=(m,)
        Triangles, those of a leaf together: a leaf's end where the next leaf's begin.
    vertices : ndarray, shape=(n, 3)
        Positions.
    faces : ndarray of int32, shape=(m, 3)
        Corners of each triangle of the mesh, in the order of `triangle`.
    """

    box: FloatArray
    skip: IndexArray
    first: IndexArray
    triangle: IndexArray
    vertices: FloatArray
    faces: IndexArray


def bvh(mesh: TriangleMesh) -> Bvh:
    """Build the hierarchy of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        Any triangles, also some without area: no ray meets those.

    Returns
    -------
    Bvh
        Binned by the surface area heuristic, at most 4 triangles in a leaf; about 110 bytes a
        triangle.

    References
    ----------
    I. Wald, On fast construction of SAH-based bounding volume hierarchies, IEEE Symposium on
    Interactive Ray Tracing, 2007.
    """
    low, high = _bounds(mesh.vertices, mesh.faces)
    order, box, skip, first = _build(low, high)
    return Bvh(box, skip, first, order, mesh.vertices, mesh.faces[order])


def any_hit(
    tree: Bvh, origins: FloatArray, directions: FloatArray, far: float = np.inf
) -> BoolArray:
    """Tell which rays meet a triangle, on either side of it.

    Parameters
    ----------
    tree : Bvh
        The triangles.
    origins : ndarray, shape=(r, 3)
        Where the rays begin, mesh units.
    directions : ndarray, shape=(r, 3)
        Their directions, of any length but 0.
    far : float
        Where they end, in lengths of the direction.

    Returns
    -------
    ndarray of bool, shape=(r,)
        True for a ray that meets one beyond 0 and before `far`. A ray through an edge or a corner
        that triangles share meets one of them.

    Raises
    ------
    ParameterError
        If an array is of another shape or not finite, or a direction is 0.
    """
    starts = finite("origins", origins)
    if starts.ndim != 2 or starts.shape[1] != 3:
        raise ParameterError(f"origins has shape {starts.shape}, expected (r, 3)")
    ways = finite("directions", directions, starts.shape)
    if (ways == 0.0).all(axis=1).any():
        raise ParameterError("directions holds one that is 0")
    found: BoolArray = _any_hit(*tree, starts, ways, far)
    return found


@compiled(parallel=True)
def _any_hit(
    box: FloatArray,
    skip: IndexArray,
    first: IndexArray,
    triangle: IndexArray,
    vertices: FloatArray,
    faces: IndexArray,
    origins: FloatArray,
    directions: FloatArray,
    far: float,
) -> BoolArray:
    hit = np.empty(len(origins), np.bool_)
    for ray in prange(len(origins)):
        hit[ray] = stopped(
            box, skip, first, vertices, faces, origins[ray], directions[ray], 0.0, 0.0, far, -1
        )
    return hit


@compiled()
def stopped(
    box: FloatArray,
    skip: IndexArray,
    first: IndexArray,
    vertices: FloatArray,
    faces: IndexArray,
    origin: FloatArray,
    direction: FloatArray,
    near_front: float,
    near_back: float,
    far: float,
    without: int,
) -> bool:
    """Tell whether a ray meets a triangle (for compiled loops).

    Parameters
    ----------
    box, skip, first, vertices, faces : ndarray
        Those of `Bvh`.
    origin, direction : ndarray, shape=(3,)
        The ray; the direction of any length but 0.
    near_front, near_back : float
        Triangles met from their front, and from their back, are ignored up to there; in lengths
        of the direction.
    far : float
        All are ignored from there on.
    without : int
        Triangles with this corner are ignored; -1 ignores none.

    Returns
    -------
    bool
        True if some triangle is met.

    References
    ----------
    S. Woop, C. Benthin and I. Wald, Watertight ray/triangle intersection, Journal of Computer
    Graphics Techniques 2 (1), 2013: the same products decide on both sides of an edge.
    """
    ox, oy, oz = origin[0], origin[1], origin[2]
    ix, iy, iz = _inverse(direction[0]), _inverse(direction[1]), _inverse(direction[2])
    # The largest component becomes the ray's axis; a swap keeps the triangles' sense of rotation.
    z = 0
    if abs(direction[1]) > abs(direction[z]):
        z = 1
    if abs(direction[2]) > abs(direction[z]):
        z = 2
    x, y = (z + 1) % 3, (z + 2) % 3
    if direction[z] < 0.0:
        x, y = y, x
    scale = 1.0 / direction[z]
    along_x, along_y = direction[x] * scale, direction[y] * scale
    node, last = 0, len(skip)
    while node < last:
        if not _reaches(box, node, ox, oy, oz, ix, iy, iz, far):
            node = skip[node]
            continue
        if first[node] >= 0:
            end = len(faces)
            if skip[node] < last:
                following = skip[node]
                while first[following] < 0:
                    following += 1
                end = first[following]
            for at in range(first[node], end):
                a, b, c = faces[at, 0], faces[at, 1], faces[at, 2]
                if a == without or b == without or c == without:
                    continue
                az = vertices[a, z] - origin[z]
                bz = vertices[b, z] - origin[z]
                cz = vertices[c, z] - origin[z]
                ax = vertices[a, x] - origin[x] - along_x * az
                ay = vertices[a, y] - origin[y] - along_y * az
                bx = vertices[b, x] - origin[x] - along_x * bz
                by = vertices[b, y] - origin[y] - along_y * bz
                cx = vertices[c, x] - origin[x] - along_x * cz
                cy = vertices[c, y] - origin[y] - along_y * cz
                u, v, w = cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax
                if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
                    continue
                twice_area = u + v + w
                extent = max(abs(ax), abs(ay), abs(bx), abs(by), abs(cx), abs(cy))
                if abs(twice_area) <= _EDGE_ON * extent * extent:
                    continue
                t = (u * az + v * bz + w * cz) * scale / twice_area
                near = near_front if twice_area > 0.0 else near_back
                if near < t < far:
                    return True
        node += 1
    return False


@compiled()
def _inverse(component: float) -> float:
    # Of a ray along a face of the box: finite, so that 0 times it is not NaN.
    return 1.0 / component if abs(component) > 1.0 / _HUGE else np.copysign(_HUGE, component)


@compiled()
def _reaches(
    box: FloatArray,
    node: int,
    ox: float,
    oy: float,
    oz: float,
    ix: float,
    iy: float,
    iz: float,
    far: float,
) -> bool:
    x0, x1 = (box[node, 0] - ox) * ix, (box[node, 3] - ox) * ix
    y0, y1 = (box[node, 1] - oy) * iy, (box[node, 4] - oy) * iy
    z0, z1 = (box[node, 2] - oz) * iz, (box[node, 5] - oz) * iz
    enter = max(min(x0, x1), min(y0, y1), min(z0, z1), 0.0)
    leave = min(max(x0, x1), max(y0, y1), max(z0, z1), far)
    return enter <= leave * _WIDER


@compiled(parallel=True)
def _bounds(vertices: FloatArray, faces: IndexArray) -> tuple[FloatArray, FloatArray]:
    low, high = np.empty((len(faces), 3)), np.empty((len(faces), 3))
    for face in prange(len(faces)):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        for axis in range(3):
            low[face, axis] = min(vertices[a, axis], vertices[b, axis], vertices[c, axis])
            high[face, axis] = max(vertices[a, axis], vertices[b, axis], vertices[c, axis])
    return low, high


@compiled()
def _build(
    low: FloatArray, high: FloatArray
) -> tuple[IndexArray, FloatArray, IndexArray, IndexArray]:
    count = len(low)
    order = np.arange(count).astype(np.int32)
    box = np.empty((2 * count, 6))
    first = np.empty(2 * count, np.int32)
    second = np.empty(2 * count, np.int32)  # child of each inner node
    begin, end = np.empty(_STACK, np.int32), np.empty(_STACK, np.int32)
    depth, parent = np.empty(_STACK, np.int32), np.empty(_STACK, np.int32)
    begin[0], end[0], depth[0], parent[0] = 0, count, 0, -1
    waiting, nodes = 1, 0
    while waiting > 0:
        waiting -= 1
        lo, hi, deep = begin[waiting], end[waiting], depth[waiting]
        if parent[waiting] >= 0:
            second[parent[waiting]] = nodes
        node, nodes = nodes, nodes + 1
        _enclose(low, high, order, lo, hi, box[node])
        if hi - lo <= _LEAF:
            first[node] = lo
            continue
        first[node] = -1
        middle = (lo + hi) // 2
        if deep < _MEDIAN_BELOW:
            middle = _split(low, high, order, lo, hi)
        begin[waiting], end[waiting], depth[waiting] = middle, hi, deep + 1
        parent[waiting] = node
        begin[waiting + 1], end[waiting + 1], depth[waiting + 1] = lo, middle, deep + 1
        parent[waiting + 1] = -1
        waiting += 2
    skip = np.empty(nodes, np.int32)
    for node in range(nodes - 1, -1, -1):
        skip[node] = node + 1 if first[node] >= 0 else skip[second[node]]
    return order, box[:nodes].copy(), skip, first[:nodes].copy()


@compiled()
def _enclose(
    low: FloatArray, high: FloatArray, order: IndexArray, lo: int, hi: int, box: FloatArray
) -> None:
    for axis in range(3):
        least, most = np.inf, -np.inf
        for at in range(lo, hi):
            least = min(least, low[order[at], axis])
            most = max(most, high[order[at], axis])
        box[axis], box[axis + 3] = least, most


@compiled()
def _split(low: FloatArray, high: FloatArray, order: IndexArray, lo: int, hi: int) -> int:
    """Reorder the triangles of a node and return where its second child begins."""
    axis, start, extent = 0, 0.0, 0.0
    for candidate in range(3):
        least, most = np.inf, -np.inf
        for at in range(lo, hi):
            middle = low[order[at], candidate] + high[order[at], candidate]
            least, most = min(least, middle), max(most, middle)
        if most - least > extent:
            axis, start, extent = candidate, least, most - least
    if not extent > 1.0 / _HUGE:
        return (lo + hi) // 2  # all at one place
    to_bin = _BINS / extent
    number = np.zeros(_BINS, np.int64)
    boxes = np.empty((_BINS, 6))
    boxes[:, :3], boxes[:, 3:] = np.inf, -np.inf
    for at in range(lo, hi):
        one = order[at]
        slot = min(int((low[one, axis] + high[one, axis] - start) * to_bin), _BINS - 1)
        number[slot] += 1
        for k in range(3):
            boxes[slot, k] = min(boxes[slot, k], low[one, k])
            boxes[slot, k + 3] = max(boxes[slot, k + 3], high[one, k])
    best = _cheapest(number, boxes)
    middle = lo
    for at in range(lo, hi):
        one = order[at]
        if min(int((low[one, axis] + high[one, axis] - start) * to_bin), _BINS - 1) <= best:
            order[at], order[middle] = order[middle], one
            middle += 1
    return middle


@compiled()
def _cheapest(number: NDArray[np.int64], boxes: FloatArray) -> int:
    """Return the last bin of the first child, by area times triangles of both children."""
    after = np.zeros(_BINS)
    running = np.empty(6)
    running[:3], running[3:] = np.inf, -np.inf
    total = 0
    for slot in range(_BINS - 1, 0, -1):
        total += number[slot]
        _widen(running, boxes[slot])
        after[slot - 1] = total * _area(running)
    running[:3], running[3:] = np.inf, -np.inf
    total = 0
    best, least = 0, np.inf
    for slot in range(_BINS - 1):
        total += number[slot]
        _widen(running, boxes[slot])
        cost = total * _area(running) + after[slot]
        if cost < least:
            best, least = slot, cost
    return best


@compiled()
def _widen(box: FloatArray, other: FloatArray) -> None:
    for k in range(3):
        box[k], box[k + 3] = min(box[k], other[k]), max(box[k + 3], other[k + 3])


@compiled()
def _area(box: FloatArray) -> float:
    x, y, z = box[3] - box[0], box[4] - box[1], box[5] - box[2]
    return x * y + y * z + z * x if x >= 0.0 else 0.0
