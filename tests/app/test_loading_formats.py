import hashlib

import numpy as np
import pytest

from app.loading import load_mesh
from app.samples import sample
from tests import mesh_files

VERTICES, FACES = mesh_files.grid()
COLORS = mesh_files.rainbow(len(VERTICES))
FILES = mesh_files.one_of_each()


def load(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content)
    return load_mesh(path)


@pytest.mark.parametrize("name", [name for name in FILES if not name.endswith(".stl")])
def test_every_format_keeps_vertices_and_faces_in_order(tmp_path, name):
    loaded = load(tmp_path, name, FILES[name])
    assert np.array_equal(loaded.mesh.vertices, VERTICES)
    assert np.array_equal(loaded.mesh.faces, FACES)
    assert loaded.warnings == ()


@pytest.mark.parametrize("name", ["binary.stl", "text.stl"])
def test_stl_keeps_three_vertices_for_each_triangle(tmp_path, name):
    loaded = load(tmp_path, name, FILES[name])
    assert np.array_equal(loaded.mesh.vertices, VERTICES[FACES].reshape(-1, 3))
    assert np.array_equal(loaded.mesh.faces.ravel(), np.arange(3 * len(FACES)))
    # The soup counts as the sheet it makes: one part, with the sheet's 16 outer edges.
    assert (loaded.health.islands, loaded.health.boundary_edges) == (1, 16)


@pytest.mark.parametrize(
    "name", ["text.ply", "little.ply", "big.ply", "color.off", "plain.obj", "plain.vtp"]
)
def test_colours_are_kept_as_stored(tmp_path, name):
    colors = load(tmp_path, name, FILES[name]).colors
    # Text holds nine digits.
    np.testing.assert_allclose(colors, COLORS / 255.0, atol=1e-9, rtol=0)


def test_a_file_without_colours_has_none(tmp_path):
    assert load(tmp_path, "plain.off", FILES["plain.off"]).colors is None


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_float_colours_of_ply_are_kept(tmp_path, order):
    stored = (COLORS / 255.0).astype(np.float32)
    loaded = load(tmp_path, "a.ply", mesh_files.ply(VERTICES, FACES, stored, order))
    np.testing.assert_allclose(loaded.colors, stored, atol=1e-9, rtol=0)


def test_glb_colours_are_linear_and_come_back_encoded(tmp_path):
    linear = np.full((len(VERTICES), 3), [0.0, 0.001, 0.21404114])
    loaded = load(tmp_path, "a.glb", mesh_files.simple_glb(VERTICES, FACES, linear))
    # IEC 61966-2-1: 0.21404114 is the linear light of 0.5; 12.92 is the slope at zero. The file
    # holds float32.
    np.testing.assert_allclose(loaded.colors[0], [0.0, 0.01292, 0.5], atol=1e-7)


def test_colours_that_cannot_be_colours_are_dropped_aloud(tmp_path):
    stored = np.full((len(VERTICES), 3), -0.5, np.float32)
    loaded = load(tmp_path, "a.ply", mesh_files.ply(VERTICES, FACES, stored, "<"))
    assert loaded.colors is None
    assert "colours" in loaded.warnings[0]


def test_the_digest_is_that_of_the_file(tmp_path):
    loaded = load(tmp_path, "a.off", FILES["plain.off"])
    assert loaded.digest == hashlib.sha256(FILES["plain.off"]).hexdigest()
    assert loaded.path == tmp_path / "a.off"


@pytest.mark.parametrize("name", FILES)
def test_a_wrong_ending_is_read_by_content_with_a_warning(tmp_path, name):
    ending = "ply" if not name.endswith(".ply") else "obj"
    loaded = load(tmp_path, f"wrong.{ending}", FILES[name])
    assert len(loaded.mesh.faces) == len(FACES)
    assert f"is called .{ending}" in loaded.warnings[0]


def test_an_unknown_ending_is_read_by_content_with_a_warning(tmp_path):
    loaded = load(tmp_path, "mesh.bin", FILES["little.ply"])
    assert "unknown ending" in loaded.warnings[0]


@pytest.mark.parametrize("name", ["text.ply", "plain.obj", "plain.off", "text.stl"])
@pytest.mark.parametrize("end", [b"\r\n", b"\r"])
def test_text_formats_take_other_line_ends(tmp_path, name, end):
    loaded = load(tmp_path, name, FILES[name].replace(b"\n", end))
    assert len(loaded.mesh.faces) == len(FACES)


@pytest.mark.parametrize("name", [name for name in FILES if name != "plain.glb"])
def test_a_byte_order_mark_is_passed_over_and_counts_for_the_digest(tmp_path, name):
    plain = load(tmp_path, name, FILES[name])
    if name == "binary.stl":
        # Its header is free, and may begin with the mark.
        content = mesh_files.stl_binary(VERTICES, FACES, b"\xef\xbb\xbfsolid facet")
    else:
        content = b"\xef\xbb\xbf" + FILES[name]
    marked = load(tmp_path, name, content)
    assert np.array_equal(marked.mesh.vertices, plain.mesh.vertices)
    assert np.array_equal(marked.mesh.faces, plain.mesh.faces)
    assert marked.warnings == ()
    assert marked.digest == hashlib.sha256(content).hexdigest()


def test_a_byte_order_mark_does_not_cost_an_obj_its_first_vertex(tmp_path):
    loaded = load(tmp_path, "a.obj", b"\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    assert loaded.mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]


def stl_with(attribute, header=b"by hand"):
    content = bytearray(mesh_files.stl_binary(VERTICES, FACES, header))
    content[84 + 48 : 84 + 50] = attribute.to_bytes(2, "little")
    return bytes(content)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            b"property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            b"property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
            b"0 0 0\n1 0 0\n1 1 0\n3 0 1 2 255 0 0\n",
        ),
        ("a.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 255 0 0\n"),
        ("a.stl", stl_with(0x801F)),
        ("b.stl", stl_with(0, b"COLOR=\1\2\3\4")),
        (
            "a.vtp",
            FILES["plain.vtp"].replace(
                b"<Points>",
                b'<CellData>\n<DataArray type="UInt8" Name="RGB" NumberOfComponents="3" '
                b'format="ascii">' + b"255 0 0 " * len(FACES) + b"</DataArray>\n</CellData>\n"
                b"<Points>",
            ),
        ),
    ],
)
def test_colours_of_faces_are_left_out_aloud(tmp_path, name, content):
    loaded = load(tmp_path, name, content)
    assert loaded.warnings == (
        "the faces have colours of their own: not used, only those of vertices are",
    )
    assert (loaded.colors is not None) == (name == "a.vtp")


def test_an_attribute_that_is_no_colour_is_passed_over(tmp_path):
    assert load(tmp_path, "a.stl", stl_with(0x001F)).warnings == ()


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("counter", ["uchar", "int"])
def test_binary_ply_mixes_polygons(tmp_path, order, counter):
    polygons = [[0, 1, 6, 5], [1, 2, 6], [2, 7, 6], [2, 3, 8, 7]]
    content = mesh_files.ply(VERTICES, polygons, None, order, counter)
    loaded = load(tmp_path, "a.ply", content)
    assert len(loaded.mesh.faces) == 6
    assert loaded.mesh.faces[2:4].tolist() == [[1, 2, 6], [2, 7, 6]]


def test_ply_passes_over_what_it_does_not_need(tmp_path):
    text = (
        "ply\nformat ascii 1.0\nobj_info scanned\nelement camera 1\nproperty float focus\n"
        "element vertex 4\nproperty double x\nproperty float quality\nproperty double y\n"
        "property double z\nelement face 2\nproperty uchar flags\n"
        "property list uchar uint vertex_index\nproperty list uchar float texcoord\nend_header\n"
        "50\n0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0\n7 3 0 1 2 6 0 0 1 0 1 1\n7 3 0 2 3 0\n"
    )
    loaded = load(tmp_path, "a.ply", text.encode())
    assert loaded.mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert loaded.mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_ply_takes_triangle_strips_apart(tmp_path):
    text = (
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n8 0 1 2 3 -1 2 3 4\n"
    )
    loaded = load(tmp_path, "a.ply", text.encode())
    assert loaded.mesh.faces.tolist() == [[0, 1, 2], [2, 1, 3], [2, 3, 4]]


def test_obj_ignores_texture_and_normal_indices(tmp_path):
    text = (
        "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n"
        "usemtl a\nf 1/1/1 2/2/1 3/1/1\nusemtl b\nf 1//1 3//1 4//1 # the other half\n"
    )
    loaded = load(tmp_path, "a.obj", text.encode())
    assert len(loaded.mesh.vertices) == 4
    assert loaded.mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_obj_counts_negative_indices_from_the_face_line(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 6 1 0\nf -3/-1 -2/-1 -1/-1\n"
    loaded = load(tmp_path, "a.obj", text.encode())
    assert loaded.mesh.faces.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_obj_keeps_unreferenced_vertices(tmp_path):
    loaded = load(tmp_path, "a.obj", b"v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 2 3 4\n")
    assert len(loaded.mesh.vertices) == 4
    assert loaded.health.unreferenced_vertices == 1


def test_obj_with_some_colours_reads_positions_aloud(tmp_path):
    loaded = load(tmp_path, "a.obj", b"v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    assert loaded.colors is None
    assert "only some vertices" in loaded.warnings[0]


@pytest.mark.parametrize(
    ("keyword", "row"),
    [("NOFF", "0 0 1"), ("CNOFF", "0 0 1 51 102 204 255"), ("STCNOFF", "0 0 1 51 102 204 255 0 1")],
)
def test_off_headers_place_normals_and_colours(tmp_path, keyword, row):
    points = ("0 0 0", "1 0 0", "1 1 0")
    text = (
        f"{keyword} 3 1 0\n" + "".join(f"{point} {row}\n" for point in points) + "3 0 1 2 9 9 9\n"
    )
    loaded = load(tmp_path, "a.off", text.encode())
    assert loaded.mesh.vertices[2].tolist() == [1, 1, 0]
    if keyword == "NOFF":
        assert loaded.colors is None
    else:
        np.testing.assert_array_equal(loaded.colors[0], np.array([51, 102, 204]) / 255.0)


def test_binary_stl_may_say_solid_and_have_a_tail(tmp_path):
    content = mesh_files.stl_binary(VERTICES, FACES, b"solid facet") + b"tail"
    loaded = load(tmp_path, "a.stl", content)
    assert len(loaded.mesh.faces) == len(FACES)
    assert loaded.warnings == ("4 bytes after the last triangle ignored",)


def test_text_stl_joins_solids(tmp_path):
    content = FILES["text.stl"]
    loaded = load(tmp_path, "a.stl", content + content)
    assert len(loaded.mesh.faces) == 2 * len(FACES)


def test_vtp_reads_compressed_appended_data_and_strips(tmp_path):
    from vtkmodules.vtkFiltersCore import vtkStripper, vtkTriangleFilter
    from vtkmodules.vtkFiltersSources import vtkSphereSource
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    sphere, triangles, stripper = vtkSphereSource(), vtkTriangleFilter(), vtkStripper()
    triangles.SetInputConnection(sphere.GetOutputPort())
    stripper.SetInputConnection(triangles.GetOutputPort())
    writer = vtkXMLPolyDataWriter()
    writer.SetInputConnection(stripper.GetOutputPort())
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToZLib()
    writer.Write()
    loaded = load_mesh(tmp_path / "a.vtp")
    assert len(loaded.mesh.faces) == triangles.GetOutput().GetNumberOfPolys()
    assert loaded.health.watertight
    assert loaded.health.inside_out_islands == 0


def test_the_scanned_face_loads_whole():
    import trimesh

    path = sample("marble-face-raw").path
    loaded = load_mesh(path)
    assert (len(loaded.mesh.vertices), len(loaded.mesh.faces)) == (85_849, 166_259)
    peer = trimesh.load(path, process=False)
    assert np.array_equal(peer.vertices, loaded.mesh.vertices)
    assert np.array_equal(peer.faces, loaded.mesh.faces)
