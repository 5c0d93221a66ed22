"""Small binary PLY files: single-precision positions and 32-bit indices."""

from pathlib import Path

import numpy as np

from lutcore.arrays import AnyArray


def write_ply(path: Path, vertices: AnyArray, faces: AnyArray) -> None:
    """Write a triangle mesh.

    Parameters
    ----------
    path : Path
        The file.
    vertices : ndarray, shape=(n, 3)
        Positions.
    faces : ndarray of int, shape=(m, 3)
        Vertex indices.
    """
    records = np.empty(len(faces), dtype=[("count", "u1"), ("indices", "<i4", (3,))])
    records["count"], records["indices"] = 3, faces
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with path.open("wb") as stream:
        stream.write(header.encode())
        stream.write(vertices.astype("<f4").tobytes())
        stream.write(records.tobytes())
