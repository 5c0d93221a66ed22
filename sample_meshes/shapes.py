"""Makes the analytic shapes and their exact curvature: ``python -m sample_meshes.shapes``.

Each is NAME.ply with NAME.npz beside it: k1 and k2 in 1/mm, d1, d2 and normals, at its vertices.
"""

from pathlib import Path

import numpy as np

from lutcore.analytic import Exact, cylinder, ellipsoid, saddle, sphere, torus
from lutcore.mesh import TriangleMesh
from sample_meshes.ply import write_ply

_VERTICES = 4_000


def _shapes() -> dict[str, tuple[Exact, float]]:
    """Each shape and the factor that brings it to millimetres."""
    return {
        "sphere": (sphere(_VERTICES), 10.0),
        "cylinder": (cylinder(_VERTICES), 5.0),
        "torus": (torus(_VERTICES), 10.0),
        "saddle": (saddle(_VERTICES, k=(-1.0, 1.0)), 10.0),
        "ellipsoid": (ellipsoid(_VERTICES, irregular=True, axes=(1.2, 0.8, 0.5)), 10.0),
    }


def make() -> None:
    """Write all shapes beside this file."""
    for name, (shape, factor) in _shapes().items():
        mesh = TriangleMesh(shape.mesh.vertices * factor, shape.mesh.faces)
        truth = shape.truth
        path = Path(__file__).with_name(f"{name}.ply")
        write_ply(path, mesh.vertices, mesh.faces)
        np.savez_compressed(
            path.with_suffix(".npz"),
            allow_pickle=False,
            k1=truth.k1 / factor,
            k2=truth.k2 / factor,
            d1=truth.d1.astype(np.float32),
            d2=truth.d2.astype(np.float32),
            normals=truth.normals.astype(np.float32),
        )


if __name__ == "__main__":
    make()
