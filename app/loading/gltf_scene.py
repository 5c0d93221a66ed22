"""Where the nodes of a glTF scene put their meshes."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import FloatArray

# No drawn scene has more; a damaged file that names one mesh again and again stops here.
_MOST_PLACES = 100_000


def placed_primitives(document: dict[str, Any]) -> list[tuple[dict[str, Any], FloatArray]]:
    """List the primitives of the default scene's meshes, each as often as it is placed.

    Parameters
    ----------
    document : dict
        The file's JSON.

    Returns
    -------
    list of (dict, ndarray, shape=(4, 4))
        The primitives' JSON and their transforms to world coordinates, parents before children.

    Raises
    ------
    BadContentError
        If a node is its own ancestor, or more is placed than any scene has.
    """
    placed: list[tuple[dict[str, Any], FloatArray]] = []
    for mesh, matrix in _placed_meshes(document):
        primitives = document["meshes"][mesh]["primitives"]
        if len(placed) + len(primitives) > _MOST_PLACES:
            raise BadContentError(
                f"its scene places more than {_MOST_PLACES} parts", "join its parts to one mesh"
            )
        placed += [(primitive, matrix) for primitive in primitives]
    return placed


def _placed_meshes(document: dict[str, Any]) -> Iterator[tuple[int, FloatArray]]:
    nodes = document.get("nodes", [])
    # A node has one parent (glTF 2.0, section 3.5.2): more places than nodes means a cycle.
    most = min(len(nodes), _MOST_PLACES)
    roots = _roots(document, nodes)
    places = len(roots)
    waiting = [(root, np.eye(4)) for root in reversed(roots[:most])]
    while waiting and places <= most:
        index, parent = waiting.pop()
        if not isinstance(index, int) or not 0 <= index < len(nodes):
            raise BadContentError(f"it refers to number {index} of its {len(nodes)} nodes")
        node = nodes[index]
        matrix = parent @ _local(node)
        mesh = node.get("mesh")
        if mesh is not None:
            if not isinstance(mesh, int) or not 0 <= mesh < len(document.get("meshes", [])):
                raise BadContentError(f"node {index} uses mesh {mesh}, which does not exist")
            yield mesh, matrix
        children = node.get("children", [])
        places += len(children)
        if places <= most:
            waiting.extend((child, matrix) for child in reversed(children))
    if places > most:
        raise BadContentError("its nodes do not form a tree")


def _roots(document: dict[str, Any], nodes: list[dict[str, Any]]) -> list[int]:
    scenes = document.get("scenes", [])
    if scenes:
        which = document.get("scene", 0)
        if not isinstance(which, int) or not 0 <= which < len(scenes):
            raise BadContentError(f"it refers to number {which} of its {len(scenes)} scenes")
        return list(scenes[which].get("nodes", []))
    children = {child for node in nodes for child in node.get("children", [])}
    return [index for index in range(len(nodes)) if index not in children]


def _local(node: dict[str, Any]) -> FloatArray:
    if "matrix" in node:
        # Stored column by column.
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0.0, 0.0, 0.0, 1.0]), dtype=np.float64)
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", [1.0, 1.0, 1.0]), dtype=np.float64)
    matrix[:3, 3] = node.get("translation", [0.0, 0.0, 0.0])
    return matrix
