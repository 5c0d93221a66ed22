"""Damage to the surface itself: rims, holes, a spike, sheets that are no surface."""

import numpy as np

from lutcore.analytic import Exact
from lutcore.arrays import AnyArray, BoolArray, FloatArray
from lutcore.gallery.case import Pair, Subject, part, subject, within
from lutcore.gallery.surfaces import ball, ring, sheet
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.topology import edges

# How far harm is looked for, in spacings of the mesh. One-ring methods spoil one of them; a
# method that averages over a length can carry a defect that far.
_RIM, _AROUND = 2.0, 6.0
_SPIKE = 0.25  # four edges: a flying point of a scanner
_FIN = 0.15
_HOLES, _SPECKS = 40, 40


def border(seed: int) -> Pair:
    """Cut a sphere in half.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Hemisphere and sphere, judged along the cut.
    """
    heights = ball().mesh.vertices[:, 2]
    upper = np.asarray((heights[ball().mesh.faces] > 0.0).all(axis=1))
    mesh, used = part(ball(), upper)
    return _cut(ball(), mesh, used)


def patch(seed: int) -> Pair:
    """Cut a square patch out of a saddle.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        The patch and the whole saddle, judged along the cut.
    """
    whole = sheet("saddle")
    inside = np.abs(whole.mesh.vertices[:, :2]).max(axis=1) < 0.6
    mesh, used = part(whole, inside[whole.mesh.faces].all(axis=1))
    return _cut(whole, mesh, used)


def holes(seed: int) -> Pair:
    """Take single faces that do not touch out of a closed surface.

    Parameters
    ----------
    seed : int
        Which ones.

    Returns
    -------
    Pair
        Judged at the corners of the missing faces.
    """
    exact = ring()
    gone: list[int] = []
    judged = np.zeros(len(exact.mesh.vertices), dtype=bool)
    for face in np.random.default_rng(seed).permutation(len(exact.mesh.faces)):
        if len(gone) < _HOLES and not judged[exact.mesh.faces[face]].any():
            gone.append(face)
            judged[exact.mesh.faces[face]] = True
    mesh = TriangleMesh(exact.mesh.vertices, np.delete(exact.mesh.faces, gone, axis=0))
    return subject(exact, judged, mesh), subject(exact, judged)


def spike(seed: int) -> Pair:
    """Move one vertex far out.

    Parameters
    ----------
    seed : int
        Which one.

    Returns
    -------
    Pair
        Judged around the spike, itself and its neighbours left out: they are its flanks.
    """
    exact = ring()
    points, faces = exact.mesh.vertices.copy(), exact.mesh.faces
    tip = int(np.random.default_rng(seed).integers(len(points)))
    flanks = _marked(len(points), faces[(faces == tip).any(axis=1)].ravel())
    judged = _around(points, points[[tip]]) & ~flanks
    points[tip] += _SPIKE * exact.truth.normals[tip]
    return subject(exact, judged, TriangleMesh(points, faces)), subject(exact, judged)


def fin(seed: int) -> Pair:
    """Set a strip upright on a line of edges.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Judged around the strip's foot, the foot left out: three faces meet there.
    """
    exact = ring()
    points, faces = exact.mesh.vertices, exact.mesh.faces
    outermost = np.flatnonzero(np.hypot(points[:, 0], points[:, 1]) > 1.35 - 1e-9)
    angle = np.arctan2(points[outermost, 1], points[outermost, 0])
    foot = outermost[np.argsort(angle)][:20]
    top = len(points) + np.arange(len(foot))
    strip = np.concatenate(
        [
            np.stack([foot[:-1], foot[1:], top[1:]], axis=1),
            np.stack([foot[:-1], top[1:], top[:-1]], axis=1),
        ]
    )
    mesh = TriangleMesh(
        np.concatenate([points, points[foot] + _FIN * exact.truth.normals[foot]]),
        np.concatenate([faces, strip]),
    )
    judged = _around(points, points[foot]) & ~_marked(len(points), foot)
    return _widened(subject(exact, judged), mesh), subject(exact, judged)


def bow_tie(seed: int) -> Pair:
    """Let two spheres share one vertex.

    Parameters
    ----------
    seed : int
        Which one.

    Returns
    -------
    Pair
        Two spheres that touch, and the same apart; judged around the shared vertex, itself left
        out: it has two normals.
    """
    points, faces = ball().mesh.vertices, ball().mesh.faces
    count = len(points)
    shared = int(np.random.default_rng(seed).integers(count))
    # Point reflection at the vertex gives the sphere on the other side, inside out: turn it back.
    other = 2.0 * points[shared] - points
    turned = faces[:, ::-1] + np.int32(count)
    number = np.arange(2 * count)
    number[count + shared + 1 :] -= 1
    number[count + shared] = shared
    broken = TriangleMesh(
        np.concatenate([points, np.delete(other, shared, axis=0)]),
        np.concatenate([faces, number[turned]]),
    )
    sound = TriangleMesh(
        np.concatenate([points, other + points[shared]]), np.concatenate([faces, turned])
    )
    judged = _around(broken.vertices, points[[shared]])
    judged[shared] = False
    ones = np.ones(2 * count)
    return (
        Subject(broken, ones[1:], ones[1:], judged),
        Subject(sound, ones, ones, np.insert(judged, count + shared, False)),
    )


def double_sided(seed: int) -> Pair:
    """Repeat a patch of faces turned over: four faces meet at each of its edges.

    Parameters
    ----------
    seed : int
        Where.

    Returns
    -------
    Pair
        Judged around the patch, itself left out: it has no outside.
    """
    exact = ring()
    points, faces = exact.mesh.vertices, exact.mesh.faces
    centre = points[[int(np.random.default_rng(seed).integers(len(points)))]]
    doubled = within(points, centre, 5.0 * typical_spacing(exact.mesh))[faces].all(axis=1)
    inner = _marked(len(points), faces[doubled].ravel())
    judged = _around(points, points[inner]) & ~inner
    mesh = TriangleMesh(points, np.concatenate([faces, faces[doubled][:, ::-1]]))
    return subject(exact, judged, mesh), subject(exact, judged)


def debris(seed: int) -> Pair:
    """Scatter triangles and tetrahedra of an edge's size around a surface.

    Parameters
    ----------
    seed : int
        Where.

    Returns
    -------
    Pair
        Judged on the surface.
    """
    exact = ring()
    generator = np.random.default_rng(seed)
    size = typical_spacing(exact.mesh)
    points, faces = [exact.mesh.vertices], [exact.mesh.faces]
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * size
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], dtype=np.int32)
    total = len(exact.mesh.vertices)
    for speck, place in enumerate(generator.choice(total, _SPECKS, replace=False)):
        away = 4.0 * size * exact.truth.normals[place]
        closed = speck % 2 == 0
        points.append(exact.mesh.vertices[place] + away + corners[: 4 if closed else 3])
        faces.append((tetrahedron if closed else tetrahedron[:1]) + np.int32(total))
        total += len(points[-1])
    mesh = TriangleMesh(np.concatenate(points), np.concatenate(faces))
    return _widened(subject(exact), mesh), subject(exact)


def _cut(whole: Exact, mesh: TriangleMesh, used: BoolArray) -> Pair:
    """Return a part and its whole, judged near the part's rim."""
    table = edges(mesh.faces, len(mesh.vertices))
    rim = mesh.vertices[np.unique(table.ends[table.boundary])]
    near = within(mesh.vertices, rim, _RIM * typical_spacing(mesh))
    judged = np.zeros(len(used), dtype=bool)
    judged[used] = near
    truth = whole.truth
    return Subject(mesh, truth.k1[used], truth.k2[used], near), subject(whole, judged)


def _widened(sound: Subject, mesh: TriangleMesh) -> Subject:
    """Return a subject whose mesh has further vertices, of which nothing is known."""
    more = len(mesh.vertices) - len(sound.judged)
    k1, k2 = (np.concatenate([k, np.zeros(more)]) for k in (sound.k1, sound.k2))
    return Subject(mesh, k1, k2, np.concatenate([sound.judged, np.zeros(more, dtype=bool)]))


def _around(points: FloatArray, centres: FloatArray) -> BoolArray:
    return within(points, centres, _AROUND * typical_spacing(ring().mesh))


def _marked(count: int, index: AnyArray) -> BoolArray:
    mask = np.zeros(count, dtype=bool)
    mask[index] = True
    return mask
