import numpy as np
import pytest

from app.loading import UnreadableFileError, guard, load_mesh
from app.loading.formats import FORMATS, KNOWN, MESHIO, MESHLAB
from app.loading.vtk_guarded import read as read_vtk
from lutcore.errors import MeshError
from tests import mesh_files, more_files

VERTICES, FACES = mesh_files.grid()
IN_CHILD = more_files.in_child()
# One file of each package and of each of VTK's readers: each costs the start of a child process.
SAMPLED = (
    "packed.vtp",
    "plain.vtu",
    "text.vtk",
    "binary.vtk",
    "plain.mesh",
    "plain.bdf",
    "plain.wrl",
    "plain.ctm",
)


def load(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    return load_mesh(tmp_path / name)


@pytest.mark.parametrize("name", SAMPLED)
def test_the_sheet_comes_back_as_it_was(tmp_path, name):
    loaded = load(tmp_path, name, IN_CHILD[name])
    # Nastran's numbers have eight letters.
    np.testing.assert_allclose(loaded.mesh.vertices, VERTICES, atol=1e-6)
    assert np.array_equal(loaded.mesh.faces, FACES)
    if name.rsplit(".", 1)[1] in MESHLAB:
        assert "order of its vertices may differ" in loaded.warnings[0]
    else:
        assert loaded.warnings == ()


@pytest.mark.parametrize("name", [n for n in IN_CHILD if n.rsplit(".", 1)[1] in MESHIO])
def test_meshio_keeps_points_and_triangles_in_order(tmp_path, name):
    from app.loading.meshio_child import read

    (tmp_path / name).write_bytes(IN_CHILD[name])
    surface = read(tmp_path / name)
    np.testing.assert_allclose(surface.vertices, VERTICES, atol=1e-6)
    assert np.array_equal(surface.corners.reshape(-1, 3), FACES)


def test_every_format_has_a_file_that_was_read_or_a_twin_of_its_reader():
    read = {name.rsplit(".", 1)[1] for name in IN_CHILD}
    # Nastran and Permas go by several endings; SU2 is read below.
    assert set(MESHLAB) | set(MESHIO) - {"fem", "nas", "dato", "dat", "su2"} <= read
    assert set(FORMATS) == {*KNOWN, *MESHIO, *MESHLAB}


def test_meshio_takes_faces_of_all_kinds_and_leaves_volumes_out(tmp_path):
    import meshio

    from app.loading.meshio_child import read

    points = np.concatenate((VERTICES, [[0, 0, 9]]))
    cells = [
        ("triangle", [[0, 1, 6]]),
        ("tetra", [[0, 1, 6, 25]]),
        ("quad", [[1, 2, 7, 6]]),
        ("line", [[0, 1]]),
        ("triangle6", [[0, 2, 12, 1, 7, 6]]),
    ]
    meshio.write(tmp_path / "a.msh", meshio.Mesh(points, cells), file_format="gmsh22")
    surface = read(tmp_path / "a.msh")
    assert surface.corners.tolist() == [0, 1, 6, 1, 2, 7, 6, 0, 2, 12]
    assert surface.counts.tolist() == [3, 4, 3]
    assert "1 cells that are no flat faces" in surface.warnings[0]
    assert "curved faces" in surface.warnings[1]
    meshio.write(tmp_path / "b.msh", meshio.Mesh(points, cells[1:2]), file_format="gmsh22")
    with pytest.raises(MeshError, match="1 cells are volumes"):
        read(tmp_path / "b.msh")


def test_flat_points_lie_at_height_zero(tmp_path):
    from app.loading.meshio_child import read

    text = "NDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\n"
    (tmp_path / "a.su2").write_text(text)
    assert read(tmp_path / "a.su2").vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("name", "words"),
    [("a.msh", "meshio cannot read it as Gmsh or Ansys"), ("a.dae", "MeshLab cannot read it as")],
)
def test_what_a_package_cannot_read_is_refused_in_one_line(tmp_path, name, words):
    with pytest.raises(UnreadableFileError, match=words) as caught:
        load(tmp_path, name, b"Dear reader,\nthis is a letter.\n")
    assert "\n" not in str(caught.value)


def test_a_file_without_faces_says_so(tmp_path):
    tetra = more_files.vtu(VERTICES, FACES).replace(
        b"5 " * (len(FACES) - 1) + b"5<", b"10 " * (len(FACES) - 1) + b"10<"
    )
    with pytest.raises(MeshError, match="32 cells are volumes") as caught:
        load(tmp_path, "a.vtu", tetra)
    assert not isinstance(caught.value, UnreadableFileError)


def test_vtk_takes_polygons_pixels_and_strips_of_grids():
    from app.loading.vtp_vtk import read

    text = (
        "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        "POINTS 7 float\n0 0 0 1 0 0 0 1 0 1 1 0 2 0 0 2 1 0 3 0 0\n"
        "CELLS 4 19\n4 0 1 2 3\n5 1 4 6 5 3\n2 0 1\n4 0 1 3 5\n"
        "CELL_TYPES 4\n8\n7\n3\n10\n"
    )
    surface = read(text.encode())
    assert surface.corners.tolist() == [0, 1, 3, 2, 1, 4, 6, 5, 3]
    assert surface.counts.tolist() == [4, 5]
    assert surface.warnings == ["1 cells that are no flat faces: left out"]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (more_files.vtk_legacy(VERTICES, FACES).replace(b"S 25 f", b"S 9999999 f"), "POINTS 999"),
        (
            IN_CHILD["plain.vtu"].replace(b'Cells="32"', b'Cells="' + b"9" * 30 + b'"'),
            "NumberOfCells",
        ),
        (IN_CHILD["packed.vtp"].replace(b'Points="25"', b'Points="99999999999"'), "NumberOfPoints"),
    ],
)
def test_counts_of_vtk_are_held_against_the_file_before_it_is_read(monkeypatch, content, words):
    def never(*arguments):
        raise AssertionError

    monkeypatch.setattr("app.loading.vtk_guarded.read_guarded", never)
    with pytest.raises(Exception, match=f"at byte .*{words}.* bytes can hold"):
        read_vtk(content)


def test_nothing_is_left_behind(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "scratch"))
    (tmp_path / "scratch").mkdir()
    monkeypatch.setattr(guard, "_SLOWNESS", 0)
    with pytest.raises(UnreadableFileError, match="took more than"):
        load(tmp_path, "a.mesh", IN_CHILD["plain.mesh"])
    assert list((tmp_path / "scratch").iterdir()) == []


def test_lines_of_other_formats_that_begin_with_a_v_are_no_obj(tmp_path):
    with pytest.raises(UnreadableFileError, match="meshio cannot read it"):
        load(tmp_path, "a.mesh", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
