"""The cases by name: what is broken in each, and why that is hard."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from lutcore.errors import ParameterError
from lutcore.gallery import damage, listing, sampling, surfaces
from lutcore.gallery.case import Case, Pair


class _Entry(NamedTuple):
    title: str
    why: str
    build: Callable[[int], Pair]


def _noise(percent: int) -> _Entry:
    if percent == 0:
        why = "Nothing is broken: the torus that most of the damage is done to."
    else:
        why = (
            f"Every vertex is off by {percent} % of the mean edge along its normal, each for "
            "itself: second differences multiply that by one over the edge squared."
        )
    return _Entry(f"noise, {percent} %", why, partial(sampling.white_noise, percent / 100.0))


def _resolution(count: int) -> _Entry:
    why = (
        f"{count} vertices of an ellipsoid with a noise that is the same, in mesh units, at every "
        "density: too few hide the shape, many raise the noise per edge."
    )
    return _Entry(f"{count} vertices", why, partial(sampling.resolution, count))


_ENTRIES = {
    "border": _Entry(
        "border: hemisphere",
        "The rim's vertices have neighbours on one side only, along a jagged cut.",
        damage.border,
    ),
    "patch": _Entry(
        "border: saddle patch",
        "A cut along the grid: vertices of the rim and its corners see a half or a quarter of "
        "their neighbours.",
        damage.patch,
    ),
    "holes": _Entry(
        "pinholes",
        "Single faces are missing, so that angles around their corners are no full turn.",
        damage.holes,
    ),
    "spike": _Entry(
        "spike",
        "One vertex flies four edges out, and whoever averages over it carries it along.",
        damage.spike,
    ),
    "fin": _Entry(
        "fin: edges of 3 faces",
        "A strip stands upright on the surface, so that edges have three faces and normals a "
        "sideways part.",
        damage.fin,
    ),
    "bow-tie": _Entry(
        "bow-tie: shared vertex",
        "Two spheres share a vertex: its star is two fans with opposite normals.",
        damage.bow_tie,
    ),
    "double-sided": _Entry(
        "doubled patch: edges of 4",
        "A patch is present twice, once for each side, so that normals cancel and edges have four "
        "faces.",
        damage.double_sided,
    ),
    "debris": _Entry(
        "debris",
        "Triangles and tetrahedra float around the surface, near enough to be taken for it.",
        damage.debris,
    ),
    "flipped-all": _Entry(
        "all faces flipped",
        "The faces' order turns inside out, and every sign must turn with it.",
        listing.flipped_all,
    ),
    "flipped-half": _Entry(
        "one half flipped",
        "Signs must turn in one half and stay in the other, up to the seam's surroundings.",
        listing.flipped_half,
    ),
    "flipped-some": _Entry(
        "1 face in 20 flipped",
        "Single faces disagree with all around them about where outside is.",
        listing.flipped_some,
    ),
    "soup": _Entry(
        "unmerged soup (STL)",
        "No two faces share a vertex: without joining there are no neighbours at all.",
        listing.soup,
    ),
    "cracked-soup": _Entry(
        "soup with cracks",
        "Corners that should meet are a millionth of an edge apart: joining equal positions does "
        "not help.",
        listing.cracked_soup,
    ),
    "repeated-faces": _Entry(
        "repeated and empty faces",
        "1 face in 20 is listed twice and as many have no area: edges get three faces, divisions "
        "zeros.",
        listing.repeated_faces,
    ),
    "isolated": _Entry(
        "vertices without a face",
        "1 vertex in 20 has no face, half of them far away; all need a value and their place.",
        listing.isolated,
    ),
    "random-order": _Entry(
        "random order",
        "Vertices and faces are shuffled; the answer must not depend on their order.",
        listing.random_order,
    ),
    "saddle": _Entry(
        "saddle",
        "k1 and k2 have opposite signs and a mean near 0, where a bowl has one sign.",
        surfaces.saddle,
    ),
    "monkey-saddle": _Entry(
        "monkey saddle",
        "Flat at one point where the directions turn three times: no scale fits there.",
        surfaces.monkey_saddle,
    ),
    "umbilic": _Entry(
        "umbilic: sphere",
        "k1 = k2 everywhere: the directions mean nothing, and a root of H² - K turns any error up.",
        surfaces.umbilic,
    ),
    "thin": _Entry(
        "thin tube",
        "A tube with 14 vertices around it: detail as small as the length that noise asks for.",
        surfaces.thin,
    ),
    "irregular": _Entry(
        "random triangles",
        "Vertices at random places: angles and areas of a star say little about the surface.",
        sampling.irregular,
    ),
    "slivers-8": _Entry(
        "slivers 8:1",
        "Triangles eight times longer than wide: a ring of them is no round neighbourhood.",
        partial(sampling.slivers, 8.0),
    ),
    "slivers-32": _Entry(
        "slivers 32:1",
        "Triangles 32 times longer than wide, a third of the radius: some of them fold over.",
        partial(sampling.slivers, 32.0),
    ),
    **{f"noise-{percent}": _noise(percent) for percent in (0, 1, 2, 5, 10, 20)},
    "correlated-noise": _Entry(
        "correlated noise, 10 %",
        "Neighbours are off together over two edges, so that averaging helps less than it seems; "
        "beside white noise of the same size.",
        sampling.correlated_noise,
    ),
    **{f"resolution-{count}": _resolution(count) for count in (250, 1000, 4000, 16000)},
    "metres": _Entry(
        "metres for millimetres",
        "A thousand times smaller, so that a tolerance in mesh units swallows it.",
        partial(sampling.scaled, 1e-3),
    ),
    "micrometres": _Entry(
        "a million times larger",
        "Squares of areas reach 1e20, where a tolerance in mesh units lets everything through.",
        partial(sampling.scaled, 1e6),
    ),
    "far": _Entry(
        "1e3 diagonals away, float32",
        "Positions keep few digits for the shape: steps are 1/240 of an edge.",
        partial(sampling.far, 1e3),
    ),
    "farther": _Entry(
        "1e5 diagonals away, float32",
        "Steps of the positions are half an edge: what was stored is a staircase.",
        partial(sampling.far, 1e5),
    ),
}


def names() -> list[str]:
    """Return the names of the cases.

    Returns
    -------
    list of str
        In the gallery's order.
    """
    return list(_ENTRIES)


def build(name: str, seed: int = 0) -> Case:
    """Make a case.

    Parameters
    ----------
    name : str
        One of `names`.
    seed : int
        Of everything random in it, 0 or more.

    Returns
    -------
    Case
        The same arrays for the same seed, always.

    Raises
    ------
    ParameterError
        If there is no such case, or the seed is negative.
    """
    if name not in _ENTRIES:
        raise ParameterError.unknown("case", name, _ENTRIES)
    if seed < 0:
        raise ParameterError(f"seed = {seed} is negative; give a whole number from 0")
    entry = _ENTRIES[name]
    broken, sound = entry.build(seed)
    return Case(name, entry.title, entry.why, broken, sound)
