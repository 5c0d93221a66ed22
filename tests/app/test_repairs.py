"""Repairs are part of the session: done in order, each once, in another process."""

import numpy as np
import pytest

from app.cli.main import main
from app.loading import load_mesh
from app.pipeline import Pipeline
from app.repairs import KINDS
from app.session import Repair, Session, from_json, to_json
from lutcore.errors import CancelledError, MeshError
from lutcore.health import inspect


def _obj(path, vertices, faces, colors=None) -> str:
    rows = vertices if colors is None else np.hstack([vertices, colors])
    lines = ["v " + " ".join(f"{x:.9g}" for x in row) for row in rows]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def _sphere():
    mesh = load_mesh("sample_meshes/sphere.ply").mesh
    return mesh.vertices.copy(), mesh.faces.copy()


def _repaired(mesh: str, *repairs: Repair):
    return Pipeline().subject(Session(mesh=mesh, repairs=repairs))


def test_a_hole_is_filled_and_only_one_of_no_more_edges(tmp_path) -> None:
    vertices, faces = _sphere()
    mesh = _obj(tmp_path / "open.obj", vertices, faces[(faces != 17).all(axis=1)])
    edges = inspect(_repaired(mesh).mesh).boundary_edges
    assert edges > 3
    assert _repaired(mesh, Repair("holes", edges)).loaded.health.watertight
    assert _repaired(mesh, Repair("holes", edges - 1)).loaded.health.boundary_edges == edges


def test_small_parts_are_dropped_in_a_file_that_repeats_its_vertices(tmp_path) -> None:
    vertices, faces = _sphere()
    speck = 0.01 * vertices + 3.0 * np.ptp(vertices, axis=0)
    soup = np.concatenate([vertices[faces].reshape(-1, 3), speck[faces].reshape(-1, 3)])
    mesh = _obj(tmp_path / "soup.obj", soup, np.arange(len(soup)).reshape(-1, 3))
    assert _repaired(mesh).loaded.health.islands == 2
    left = _repaired(mesh, Repair("islands", 5.0))
    assert left.loaded.health.islands == 1
    assert len(left.mesh.faces) == len(faces)
    assert np.ptp(left.mesh.vertices, axis=0) == pytest.approx(np.ptp(vertices, axis=0), rel=1e-6)


def test_close_vertices_are_merged_up_to_the_distance(tmp_path) -> None:
    vertices, faces = _sphere()
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    # Two halves that do not quite meet.
    upper = vertices[faces].mean(axis=1)[:, 2] > 0.0
    apart = vertices + [0.0, 0.0, 1e-4 * diagonal]
    both = np.concatenate([vertices, apart])
    mesh = _obj(
        tmp_path / "halves.obj", both, np.concatenate([faces[~upper], faces[upper] + len(vertices)])
    )
    assert _repaired(mesh, Repair("merge", 1e-3)).loaded.health.boundary_edges > 0
    assert _repaired(mesh, Repair("merge", 0.05)).loaded.health.watertight


def test_faces_are_turned_outwards_and_alike(tmp_path) -> None:
    vertices, faces = _sphere()
    faces[::3] = faces[::3, ::-1]
    for name, turned in (("some", faces), ("all", _sphere()[1][:, ::-1])):
        mesh = _obj(tmp_path / f"{name}.obj", vertices, turned)
        before = _repaired(mesh).loaded.health
        assert before.flipped_edges + before.inside_out_islands > 0
        after = _repaired(mesh, Repair("orient")).loaded.health
        assert after.watertight
        assert after.inside_out_islands == 0


def test_a_third_face_at_an_edge_is_dropped(tmp_path) -> None:
    vertices, faces = _sphere()
    fin = np.concatenate([vertices, 1.2 * vertices[:1]])
    faces = np.concatenate([faces, [[faces[0, 0], faces[0, 1], len(vertices)]]])
    mesh = _obj(tmp_path / "fin.obj", fin, faces)
    assert _repaired(mesh).loaded.health.nonmanifold_edges == 1
    assert _repaired(mesh, Repair("manifold")).loaded.health.nonmanifold_edges == 0


def test_faces_are_reduced_and_colours_stay(tmp_path) -> None:
    vertices, faces = _sphere()
    red = (vertices[:, :1] > 0.0).astype(float)
    mesh = _obj(tmp_path / "two.obj", vertices, faces, np.hstack([red, 1.0 - red, 0.0 * red]))
    left = _repaired(mesh, Repair("decimate", 1000))
    assert 900 <= len(left.mesh.faces) <= 1000
    radius = np.linalg.norm(vertices, axis=1).mean()
    # An octagon's sagitta for edges of this length is 1.5 % of the radius.
    assert np.linalg.norm(left.mesh.vertices, axis=1) == pytest.approx(radius, rel=0.02)
    far = np.abs(left.mesh.vertices[:, 0]) > 0.3 * radius
    expected = (left.mesh.vertices[far, 0] > 0.0).astype(float)
    assert left.loaded.colors is not None
    assert left.loaded.colors[far, 0] == pytest.approx(expected, abs=0.02)


def test_each_repair_is_done_once_and_tells_surfaces_apart(monkeypatch) -> None:
    import app.repairing

    done = []
    real = app.repairing.repaired

    def counted(loaded, repair, progress):
        done.append(repair.kind)
        return real(loaded, repair, progress)

    monkeypatch.setattr(app.repairing, "repaired", counted)
    pipeline, session = Pipeline(), Session(mesh="sample:sphere")
    one, two = Repair("merge"), Repair("decimate", 2000)
    subjects = [
        pipeline.subject(Session(mesh=session.mesh, repairs=repairs))
        for repairs in ((), (one,), (one, two), (one,), (one, two))
    ]
    assert done == ["merge", "decimate"]
    assert len({subject.key for subject in subjects}) == 3
    assert subjects[2] is subjects[4]
    # The file is the same, and what a record says of it.
    assert len({subject.loaded.digest for subject in subjects}) == 1
    assert "2,000 faces" in subjects[2].warnings[-1]


def test_a_saved_session_brings_the_same_mesh(tmp_path, capsys) -> None:
    saved, first, second = (tmp_path / name for name in ("s.json", "a.csv", "b.csv"))
    words = ["curvature", "sample:sphere", "--repair", "decimate=1500", "--repair", "merge=0.02"]
    assert main([*words, "-o", str(first), "--save-session", str(saved), "--quiet"]) == 0
    assert main(["curvature", "--session", str(saved), "-o", str(second), "--quiet"]) == 0
    assert first.read_bytes() == second.read_bytes()
    assert len(first.read_text().splitlines()) < 1000
    session = from_json(saved.read_bytes())
    assert session.repairs == (Repair("decimate", 1500.0), Repair("merge", 0.02))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("mend", "unknown repair"),
        ("orient=3", "takes no number"),
        ("decimate=3", "outside its range 100 to"),
        ("merge=x", "not numbers"),
    ],
)
def test_a_wrong_repair_is_refused_with_its_reason(text, words, tmp_path, capsys) -> None:
    words_given = ["curvature", "sample:sphere", "-o", str(tmp_path / "a.csv"), "--repair", text]
    assert main(words_given) == 2
    assert words in capsys.readouterr().err


def test_a_repair_that_leaves_nothing_says_so(tmp_path) -> None:
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [2e3, 0, 0], [2e3 + 1, 0, 0], [2e3, 1, 0]]
    mesh = _obj(tmp_path / "two.obj", np.array(vertices, float), [[0, 1, 2], [3, 4, 5]])
    with pytest.raises(MeshError, match=r"two\.obj.*drop small parts.*leaves no face"):
        _repaired(mesh, Repair("islands", 50.0))


def test_repairs_can_be_cancelled() -> None:
    pipeline = Pipeline(lambda share, step: "MeshLab" not in step)
    with pytest.raises(CancelledError):
        pipeline.subject(Session(mesh="sample:marble-face-raw", repairs=(Repair("decimate"),)))


def test_sessions_check_repairs_and_come_back() -> None:
    session = Session(repairs=tuple(Repair(kind) for kind in KINDS))
    assert from_json(to_json(session)) == session
    with pytest.raises(ValueError, match="unknown repair 'mend'"):
        Repair("mend")
