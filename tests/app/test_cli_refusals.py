import subprocess
import sys

import numpy as np
import pytest

from app.cli.main import main

SMALL = ["--size", "160x120"]
FAST = ["--method", "rusinkiewicz2004"]


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.png"


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["any.ply", "--scale", "2mm"], "say how many of them a mesh unit has: --mm-per-unit N"),
        (["any.ply", "--scale", "2mm", "--mm-per-unit", "0"], "mm_per_unit = 0.0"),
        (["any.ply", "--scale", "mm"], "scale = 'mm' is neither auto nor a length"),
        (["any.ply", "--scale", "0"], "scale = 0.0: expected a number > 0"),
    ],
)
def test_a_scale_that_is_no_length_is_refused(flags, message, capsys):
    assert main(["curvature", *flags, "-o", "x.png"]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("faces", "hint"),
    [
        ([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], None),
        ([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], "--repair orient"),
        ([[0, 1, 2], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "--repair orient"),
        ([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3], [1, 0, 4]], "--repair manifold"),
    ],
)
def test_what_makes_curvature_wrong_comes_with_its_repair(faces, hint, tmp_path, capsys):
    points = [[0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30], [-30, -30, 0]]
    lines = [f"v {x} {y} {z}" for x, y, z in points[: np.max(faces) + 1]]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    path = tmp_path / "a.obj"
    path.write_text("\n".join(lines))
    words = ["curvature", str(path), "-o", str(tmp_path / "a.csv"), *FAST]
    assert main(words) == 0
    said = capsys.readouterr().err
    if hint is None:
        assert "--repair" not in said
        return
    assert f"it can be repaired first: {hint}" in said
    assert main([*words, *hint.split()]) == 0
    assert "--repair" not in capsys.readouterr().err


def test_corners_that_do_not_quite_meet_are_to_be_merged(tmp_path, capsys):
    path = tmp_path / "a.obj"
    corners = [(0, 0), (30, 0), (0, 30), (30.001, 0), (30, 30), (0, 30.001)]
    lines = [f"v {x} {y} 0" for x, y in corners]
    path.write_text("\n".join([*lines, "f 1 2 3", "f 4 5 6"]))
    words = ["curvature", str(path), "-o", str(tmp_path / "a.csv"), *FAST]
    assert main(words) == 0
    assert "it can be repaired first: --repair merge" in capsys.readouterr().err
    assert main([*words, "--repair", "merge"]) == 0
    said = capsys.readouterr().err
    assert "separate parts" not in said
    assert "repaired first" not in said


def test_a_foreign_estimator_that_fails_is_one_line_with_file_and_remedy(tmp_path, capsys):
    path = tmp_path / "fin.off"  # a tetrahedron with a third face at an edge
    path.write_text(
        "OFF\n5 5 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n-9 -9 0\n"
        "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 1 0 4\n"
    )
    result = tmp_path / "a.csv"
    words = ["curvature", str(path), "-o", str(result), "--method", "meshlab-quadric"]
    assert main([*words, "--quiet"]) == 1
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith(f"curvelight: {path}: meshlab-quadric: pymeshlab failed on it (")
    assert "2-manifold" in said
    assert said.endswith("; choose another estimator, or repair the mesh")
    assert not result.exists()


def test_a_report_as_pdf_is_refused_with_the_way_to_it(capsys):
    assert main(["curvature", "sample:torus", "-o", "x.pdf"]) == 2
    assert "write -o x.html and print that from a browser" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "advice"),
    [
        ("curvature sample:torus -o x.png --radius 5", "give --method libigl"),
        ("shade sample:torus -o x.png --width 0.3", "shading model: give --model wrap"),
        ("shade sample:torus -o x.png --source x", "give --profile burley2015"),
        ("shade sample:torus -o x.png --matrial marble", "did you mean --material?"),
        ("materials --width 0.3", "unrecognized arguments: --width 0.3\n"),
    ],
)
def test_an_unknown_flag_is_told_where_it_belongs(words, advice, capsys):
    assert main(words.split()) == 2
    assert advice in capsys.readouterr().err


BAD_INPUT = {
    "empty.ply": (b"", 3),
    "text.ply": (b"Dear all, the meeting is moved to Thursday.\n", 3),
    "truncated.stl": (b"\0" * 80 + (1000).to_bytes(4, "little") + b"\0" * 70, 3),
    "huge.ply": (
        b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
        b"property float y\nproperty float z\nelement face 1\n"
        b"property list uchar int vertex_indices\nend_header\n\0\0\0\0",
        3,
    ),
    "nan.obj": (b"v nan nan nan\nv nan nan nan\nv nan nan nan\nf 1 2 3\n", 4),
    "index.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n", 3),
    "points.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", 4),
    "unknown.xyz": (b"1 2 3\n4 5 6\n", 3),
}


@pytest.mark.parametrize("name", BAD_INPUT)
def test_a_bad_file_gets_one_clear_line_and_its_exit_code(name, tmp_path, out, capfd):
    content, code = BAD_INPUT[name]
    (tmp_path / name).write_bytes(content)
    found = main(["shade", str(tmp_path / name), "-o", str(out)])
    captured = capfd.readouterr()
    assert found in (3, 4)
    assert found == code
    assert captured.out == ""
    assert len(captured.err.splitlines()) == 1
    assert name in captured.err
    assert not out.exists()


@pytest.mark.parametrize("place", ["missing.ply", "."])
def test_a_path_that_is_no_file_exits_3(place, tmp_path, out, capsys):
    assert main(["shade", str(tmp_path / place), "-o", str(out)]) == 3
    assert len(capsys.readouterr().err.splitlines()) == 1


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["shade"],
        ["shade", "sample:torus"],
        ["shade", "sample:nothing", "-o", "x.png"],
        ["shade", "sample:torus", "-o", "x.docx"],
        ["shade", "sample:torus", "-o", "x.png", "--model", "phong"],
        ["shade", "sample:torus", "-o", "x.png", "--material", "granite"],
        ["shade", "sample:torus", "-o", "x.png", "--light", "1,2"],
        ["shade", "sample:torus", "-o", "x.png", "--light", "0,0,0"],
        ["shade", "sample:torus", "-o", "x.png", "--size", "huge"],
        ["shade", "sample:torus", "-o", "x.png", "--camera", "behind"],
        ["curvature", "sample:torus", "-o", "x.png", "--scale", "wide"],
        ["curvature", "sample:torus", "-o", "x.png", "--scale", "-1"],
        ["curvature", "sample:torus", "-o", "x.png", "--range", "3,1"],
        ["compare", "sample:torus", "-o", "x.png"],
        ["compare", "sample:torus", "-o", "x.png", "--models", "lambert"],
        ["lut", "granite", "-o", "x.npz"],
    ],
)
def test_wrong_usage_exits_2_and_writes_nothing(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_place_that_cannot_be_written_is_found_before_the_work(tmp_path, capsys):
    gone = tmp_path / "no" / "such" / "folder" / "x.png"
    assert main(["shade", "sample:torus", "-o", str(gone)]) == 1
    assert "make the folder first" in capsys.readouterr().err


def test_a_full_disk_leaves_the_old_file_and_no_other(tmp_path):
    pytest.importorskip("resource")  # limits on the size of a file are POSIX
    out = tmp_path / "x.ply"
    out.write_bytes(b"old")
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "from app.cli.main import main;"
        "import app.cli.shade, lutcore.shading, lutcore.estimation;"
        f"main(['shade', 'sample:torus', '-o', {str(tmp_path / 'warm.npz')!r}]);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000));"
        f"sys.exit(main(['shade', 'sample:torus', '-o', {str(out)!r}]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    assert "cannot be written" in done.stderr
    assert out.read_bytes() == b"old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["warm.npz", "x.ply"]


def test_an_interrupt_leaves_nothing_half_written(out, tmp_path, monkeypatch, capsys):
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("PIL.Image.Image.save", stop)
    assert main(["shade", "sample:torus", "-o", str(out), *SMALL, *FAST]) == 130
    assert "interrupted" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_fault_of_ours_is_one_line_and_a_traceback_only_when_asked(out, monkeypatch, capsys):
    def fault(*_: object) -> None:
        raise RuntimeError("boom")

    monkeypatch.setattr("app.picture.render", fault)
    arguments = ["shade", "sample:torus", "-o", str(out), *FAST, "--quiet"]
    assert main(arguments) == 1
    errors = capsys.readouterr().err
    assert "boom" in errors
    assert "Traceback" not in errors
    assert main([*arguments, "--verbose"]) == 1
    assert "Traceback" in capsys.readouterr().err


def test_a_reader_that_leaves_early_is_no_fault():
    code = "import sys; from app.cli.main import main; sys.exit(main(['materials']))"
    writer = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    writer.stdout.close()
    _, errors = writer.communicate()
    assert writer.returncode == 0, errors


def test_a_result_never_replaces_its_mesh_nor_the_session_the_result(tmp_path, capsys):
    path = tmp_path / "m.ply"
    assert main(["curvature", "sample:torus", "-o", str(path), "--quiet", *FAST]) == 0
    before = path.read_bytes()
    assert main(["curvature", str(path), "-o", str(path), *FAST]) == 2
    assert "is the mesh itself" in capsys.readouterr().err
    other = str(tmp_path / "x.npz")
    assert main(["curvature", str(path), "-o", other, "--save-session", str(path), *FAST]) == 2
    assert main(["curvature", str(path), "-o", other, "--save-session", other, *FAST]) == 2
    assert path.read_bytes() == before


@pytest.mark.parametrize("name", ["x.png", "x.exr", "x.npz"])
def test_a_full_disk_is_told_of_by_every_table_format(name, tmp_path):
    pytest.importorskip("resource")
    out = tmp_path / name
    out.write_bytes(b"old")
    assert _limited(["lut", "skin1", "-o", str(out), "--plane", "64"], tmp_path) == 1
    assert out.read_bytes() == b"old"


@pytest.mark.parametrize("name", ["x.png", "x.vtp", "x.csv", "x.npz"])
def test_a_full_disk_is_told_of_by_every_data_format(name, tmp_path):
    pytest.importorskip("resource")
    out = tmp_path / name
    out.write_bytes(b"old")
    arguments = ["curvature", "sample:torus", "-o", str(out), *FAST, "--size", "900x900"]
    assert _limited(arguments, tmp_path) == 1
    assert out.read_bytes() == b"old"


def _limited(arguments, folder):
    """Run in a process that may write no file above 4 kB, and look for leavings."""
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "from app.cli.main import main;"
        "import lutcore.estimation, lutcore.diagnostics, lutcore.baking, app.picture;"
        "import plugins.curvature.rusinkiewicz2004;"
        f"main(['curvature', 'sample:torus', '-o', {str(folder / 'w.npz')!r}, *{FAST!r}]);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096));"
        f"sys.exit(main({arguments!r}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "cannot be written" in done.stderr
    assert len(list(folder.iterdir())) == 2
    return done.returncode


def test_a_mesh_without_any_area_exits_4(tmp_path, capsys):
    path = tmp_path / "line.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    assert main(["curvature", str(path), "-o", str(tmp_path / "x.png")]) == 4
    assert "none of its 1 faces has an area" in capsys.readouterr().err


def test_a_mesh_in_metres_is_shaded_and_warned_of(tmp_path, capsys):
    from lutcore.analytic import sphere
    from sample_meshes.ply import write_ply

    ball = sphere(2000, radius=0.01).mesh
    write_ply(tmp_path / "m.ply", ball.vertices, ball.faces)
    out = str(tmp_path / "x.png")
    assert main(["shade", str(tmp_path / "m.ply"), "-o", out, *SMALL]) == 0
    assert "metres" in capsys.readouterr().err
    known = ["--mm-per-unit", "1000"]
    assert main(["shade", str(tmp_path / "m.ply"), "-o", out, *SMALL, *known]) == 0
    assert "metres" not in capsys.readouterr().err


@pytest.mark.parametrize(
    "flags",
    [
        ["--exposure", "inf"],
        ["--range", "0,inf"],
        ["--mm-per-unit", "nan"],
        ["--camera", "0,0,0,0,0,0,0,0,1"],
        ["--scale", "1e300"],
        ["--size", "80x1000"],
    ],
)
def test_numbers_that_make_no_picture_exit_2(flags, out, capsys):
    arguments = ["figure", "sample:torus", "-o", str(out), "--method", "co-smoothing", *flags]
    assert main(arguments) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not out.exists()
