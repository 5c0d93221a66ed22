import json
import struct
import tracemalloc

import numpy as np
import pytest

from app.loading import UnreadableFileError, load_mesh
from lutcore.errors import MeshError
from tests import mesh_files

VERTICES, FACES = mesh_files.grid(3)


def load(tmp_path, content):
    path = tmp_path / "a.glb"
    path.write_bytes(content)
    return load_mesh(path)


def document_of(content):
    (length,) = struct.unpack_from("<I", content, 12)
    return json.loads(content[20 : 20 + length]), content[28 + length :]


def test_two_nodes_place_one_mesh_twice(tmp_path):
    half = np.sqrt(0.5)
    nodes = [
        {"mesh": 0, "translation": [10, 0, 0], "scale": [2, 2, 2]},
        {"mesh": 0, "rotation": [0, 0, half, half]},
    ]
    loaded = load(tmp_path, mesh_files.simple_glb(VERTICES, FACES, None, nodes))
    count = len(VERTICES)
    np.testing.assert_array_equal(loaded.mesh.vertices[:count], 2 * VERTICES + [10, 0, 0])
    # A quarter turn about z takes (x, y) to (-y, x); the quaternion is exact to 1e-16.
    turned = np.column_stack((-VERTICES[:, 1], VERTICES[:, 0], VERTICES[:, 2]))
    np.testing.assert_allclose(loaded.mesh.vertices[count:], turned, atol=1e-14)
    assert np.array_equal(loaded.mesh.faces[len(FACES) :], FACES + count)


def test_transforms_of_parents_are_concatenated(tmp_path):
    document, binary = document_of(mesh_files.simple_glb(VERTICES, FACES))
    document["nodes"] = [
        {"children": [1], "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
        {"mesh": 0, "translation": [1, 0, 0]},
    ]
    document["scenes"] = [{"nodes": [0]}]
    loaded = load(tmp_path, mesh_files.glb(document, binary))
    x, y, z = VERTICES.T
    np.testing.assert_array_equal(loaded.mesh.vertices, np.column_stack((5 - y, 1 + x, z)))


def test_a_mirrored_node_keeps_its_faces_outward(tmp_path):
    nodes = [{"mesh": 0, "scale": [-1, 1, 1]}]
    loaded = load(tmp_path, mesh_files.simple_glb(VERTICES, FACES, None, nodes))
    a, b, c = (loaded.mesh.vertices[loaded.mesh.faces[:, i]] for i in range(3))
    # The sheet faces up, and mirroring x does not change that.
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_nodes_outside_the_scene_are_not_read(tmp_path):
    document, binary = document_of(mesh_files.simple_glb(VERTICES, FACES))
    document["nodes"] = [{"mesh": 0}, {"mesh": 0}]
    loaded = load(tmp_path, mesh_files.glb(document, binary))
    assert len(loaded.mesh.faces) == len(FACES)


def with_indices(indices, mode):
    document, _ = document_of(mesh_files.simple_glb(VERTICES, FACES))
    corners = np.array(indices, "<u4").tobytes()
    points = VERTICES.astype("<f4").tobytes()
    document["accessors"][1]["count"] = len(indices)
    document["bufferViews"][1]["byteLength"] = len(corners)
    document["buffers"] = [{"byteLength": len(points + corners)}]
    document["meshes"][0]["primitives"][0]["mode"] = mode
    return mesh_files.glb(document, points + corners)


@pytest.mark.parametrize(
    ("mode", "indices", "faces"),
    [
        (5, [0, 1, 3, 4, 4, 6, 7], [[0, 1, 3], [3, 1, 4]]),
        (6, [4, 0, 1, 2], [[4, 0, 1], [4, 1, 2]]),
    ],
)
def test_strips_and_fans_are_taken_apart(tmp_path, mode, indices, faces):
    loaded = load(tmp_path, with_indices(indices, mode))
    # A repeated vertex joins pieces of a strip: (3,4,4) and (4,4,6) are no triangles.
    assert loaded.mesh.faces[: len(faces)].tolist() == faces
    assert len(loaded.mesh.faces) == (3 if mode == 5 else 2)


def test_quantised_strided_and_sparse_positions_are_read(tmp_path):
    raw = np.zeros(4, [("at", "<i2", 3), ("pad", "<i2")])
    raw["at"] = [[0, 0, 0], [32767, 0, 0], [32767, 32767, 0], [7, 7, 7]]
    fourth = np.array([[-32768, 32767, 0]], "<i2")
    parts = [raw.tobytes(), struct.pack("<H", 3) + b"\0\0", fourth.tobytes()]
    starts = np.cumsum([0, *map(len, parts)]).tolist()
    document = {
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5122,
                "normalized": True,
                "count": 4,
                "type": "VEC3",
                "sparse": {
                    "count": 1,
                    "indices": {"bufferView": 1, "componentType": 5123},
                    "values": {"bufferView": 2},
                },
            }
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": starts[0], "byteLength": 32, "byteStride": 8},
            {"buffer": 0, "byteOffset": starts[1], "byteLength": 2},
            {"buffer": 0, "byteOffset": starts[2], "byteLength": 6},
        ],
        "buffers": [{"byteLength": starts[-1]}],
    }
    loaded = load(tmp_path, mesh_files.glb(document, b"".join(parts)))
    assert loaded.mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 1, 0]]


def test_points_and_lines_are_left_out_aloud(tmp_path):
    document, binary = document_of(mesh_files.simple_glb(VERTICES, FACES))
    primitive = document["meshes"][0]["primitives"][0]
    document["meshes"][0]["primitives"].append({**primitive, "mode": 1})
    loaded = load(tmp_path, mesh_files.glb(document, binary))
    assert loaded.warnings == ("1 parts made of points or lines are left out",)
    primitive["mode"] = 0
    with pytest.raises(MeshError, match="no vertices"):
        load(tmp_path, mesh_files.glb(document, binary))


def test_colours_are_shares_however_large_and_complained_of_once(tmp_path):
    linear = np.ones((len(VERTICES), 3))
    linear[0] = [40.0, 0.0, 1.0]
    nodes = [{"mesh": 0}, {"mesh": 0}]
    loaded = load(tmp_path, mesh_files.simple_glb(VERTICES, FACES, linear, nodes))
    # 0 and 1 encode to themselves, within one rounding of 1.055 - 0.055.
    np.testing.assert_allclose(loaded.colors[:2], [[1, 0, 1], [1, 1, 1]], atol=2**-52)
    assert loaded.warnings == ("some vertex colours are not between 0 and 1: clipped",)


def test_a_mesh_placed_often_within_reason_is_read(tmp_path):
    nodes = [{"mesh": 0, "translation": [index, 0, 0]} for index in range(1000)]
    loaded = load(tmp_path, mesh_files.simple_glb(VERTICES, FACES, None, nodes))
    assert len(loaded.mesh.faces) == 1000 * len(FACES)


def test_a_scene_far_larger_than_its_file_is_refused_before_it_is_built(tmp_path):
    # 3.5 MB that ask for 20 000 times 90 000 vertices: 43 GB for their positions alone.
    vertices, faces = mesh_files.grid(300)
    content = mesh_files.simple_glb(vertices, faces, None, [{"mesh": 0}] * 20_000)
    tracemalloc.start()
    try:
        with pytest.raises(UnreadableFileError, match="1800000000 vertices"):
            load(tmp_path, content)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    # The file thrice over, and some kB of Python objects for each node.
    assert peak < 3 * len(content) + 20_000 * 4096


def test_face_corners_count_as_well(tmp_path):
    document, binary = document_of(mesh_files.simple_glb(*mesh_files.grid(100)))
    document["meshes"][0]["primitives"] *= 300
    # 99 x 99 squares of six corners each, 300 times: 141 MB, and the vertices alone take 72 MB.
    with pytest.raises(UnreadableFileError, match="17641800 face corners"):
        load(tmp_path, mesh_files.glb(document, binary))


def test_more_parts_than_any_scene_has_are_refused(tmp_path):
    document, binary = document_of(mesh_files.simple_glb(VERTICES, FACES))
    document["nodes"] = [{"mesh": 0}] * 1000
    document["scenes"] = [{"nodes": list(range(1000))}]
    document["meshes"][0]["primitives"] *= 1000
    with pytest.raises(UnreadableFileError, match="more than 100000 parts"):
        load(tmp_path, mesh_files.glb(document, binary))


def broken(change):
    document, binary = document_of(mesh_files.simple_glb(VERTICES, FACES))
    change(document)
    return mesh_files.glb(document, binary)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d["accessors"][0].update(count=10**5), "bytes, "),
        (lambda d: d["accessors"][0].update(count=-1), "'count' is -1"),
        (lambda d: d["accessors"][0].pop("bufferView"), "no data"),
        (lambda d: d["bufferViews"][0].update(byteOffset=10**9), "bytes of data"),
        (lambda d: d["bufferViews"][0].update(buffer=3), "number 3 of its 1 buffers"),
        (lambda d: d["buffers"][0].update(uri="a.bin"), ".a.bin., which is not there"),
        (lambda d: d["nodes"][0].update(mesh=9), "mesh 9, which does not exist"),
        (lambda d: d["nodes"][0].update(children=[0]), "do not form a tree"),
        (lambda d: d["nodes"][0].update(matrix=[1, 2]), "not valid glTF"),
        (lambda d: d.update(nodes="what"), "not valid glTF"),
        (lambda d: d.update(scene=4), "number 4 of its 1 scenes"),
        (lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]), "compressed"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path, change, words):
    with pytest.raises(UnreadableFileError, match=words):
        load(tmp_path, broken(change))


def test_indices_out_of_range_of_one_part_never_reach_the_next(tmp_path):
    content = with_indices([0, 1, len(VERTICES)], 4)
    document, binary = document_of(content)
    document["nodes"] = [{"mesh": 0}, {"mesh": 0}]
    document["scenes"] = [{"nodes": [0, 1]}]
    with pytest.raises(UnreadableFileError, match="vertex 9 of 9"):
        load(tmp_path, mesh_files.glb(document, binary))
