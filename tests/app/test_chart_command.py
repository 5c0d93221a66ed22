import csv
import io
import json
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from app.chart.writing import SUFFIXES
from app.cli.main import main
from lutcore import analytic
from lutcore.estimation import principal_curvatures

FAST = ["--methods", "rusinkiewicz2004,ball-jet,corrected-curvature", "--scales", "2,4"]
TINY = ["chart", "--curvature", "--vertices", "400", "--repeats", "2"]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_command_writes_every_format(tmp_path, suffix, capsys):
    path = tmp_path / f"out{suffix}"
    assert main([*TINY, *FAST, "-o", str(path), "--json", "--irregular"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["recommendation"]["sentence"].endswith(".")
    assert {one["name"] for one in said["points"]} == set(FAST[1].split(","))
    written = path.read_bytes()
    if suffix == ".png":
        assert Image.open(path).size > (1000, 600)
    elif suffix == ".svg":
        ElementTree.fromstring(written)
    elif suffix == ".csv":
        assert len(list(csv.DictReader(io.StringIO(written.decode())))) == len(said["points"])
    elif suffix == ".json":
        assert json.loads(written)["points"] == said["points"]
    else:
        assert said["recommendation"]["sentence"].encode() in written
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_errors_on_a_known_surface_are_those_against_the_truth(tmp_path, capsys):
    path = tmp_path / "out.json"
    words = [*TINY, "--methods", "rusinkiewicz2004", "--noise", "0", "--surface", "ellipsoid"]
    assert main([*words, "-o", str(path), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")
    (only,) = json.loads(path.read_text())["points"]
    exact = analytic.ellipsoid(400)
    found = principal_curvatures(exact.mesh, "rusinkiewicz2004")
    off = np.square(found.k1 - exact.truth.k1) + np.square(found.k2 - exact.truth.k2)
    whole = np.square(exact.truth.k1) + np.square(exact.truth.k2)
    assert only["error"]["median"] == pytest.approx(np.sqrt(off.mean() / whole.mean()))
    assert only["error"]["least"] == only["error"]["greatest"]  # no noise, so no spread
    assert only["on_front"]


def test_the_command_says_who_has_no_figures(tmp_path, capsys):
    path = tmp_path / "out.csv"
    words = [*TINY, "--methods", "rusinkiewicz2004,meshlab-pca", "-o", str(path)]
    assert main(words) == 0
    captured = capsys.readouterr()
    assert "rusinkiewicz2004" in captured.out
    assert "without figures: meshlab-pca: the values" in captured.err


def test_a_mesh_is_judged_without_a_truth(tmp_path, capsys):
    path = tmp_path / "out.json"
    words = ["chart", "--curvature", "sample:torus", *FAST, "--repeats", "1", "-o", str(path)]
    assert main([*words, "--json", "--tolerance", "0.5"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["tolerance"] == 0.5
    assert said["error"] == "change and bias"
    assert set(said["reference"]) <= set(FAST[1].split(","))
    for one in said["points"]:
        assert one["error"]["median"] == pytest.approx(np.hypot(one["change"], one["bias"]))
    assert "own noise counts as shape" in " ".join(said["meaning"])


def test_where_noise_drowns_all_nothing_is_recommended(tmp_path, capsys):
    words = ["chart", "--curvature", "sample:torus", "--methods", "rusinkiewicz2004"]
    assert main([*words, "--noise", "0.3", "--repeats", "1", "-o", str(tmp_path / "a.png")]) == 0
    assert "No recommendation: no estimate stays within 10 %" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["--curvature", "-o", "a.pdf"], 2, "PDF is not written; write -o a.html"),
        (["--curvature", "-o", "none/a.png"], 1, "make the folder first"),
        (["--curvature", "-o", "a.png", "--methods", "vtl"], 2, "did you mean 'vtk'"),
        (["--curvature", "-o", "a.png", "--surface", "tours"], 2, "did you mean 'torus'"),
        (["--curvature", "-o", "a.png", "--vertices", "7"], 2, "outside its range 100"),
        (["--curvature", "-o", "a.png", "--vertices", "many"], 2, "'many' is not a number"),
        (["--curvature", "-o", "a.png", "--noise", "-1"], 2, "noise = '-1' is outside"),
        (["--curvature", "-o", "a.png", "--repeats", "0"], 2, "repeats"),
        (["--curvature", "-o", "a.png", "--scales", "2,,4"], 2, "scales = '' is not a number"),
        (["--curvature", "-o", "a.png", "--tolerance", "nan"], 2, "tolerance"),
        (["--curvature", "sample:torus", "-o", "a.png", "--noise", "0"], 2, "moves no vertex"),
        (["--curvature", "sample:torus", "-o", "a.png", "--irregular"], 2, "leave it or MESH"),
        (["--curvature", "sample:tours", "-o", "a.png"], 2, "did you mean 'torus'"),
        (["--curvature", "missing.ply", "-o", "a.png"], 3, "missing.ply"),
        (["--curvature", "flat.off", "-o", "a.png"], 4, "no face has an area"),
        (["--curvature", "flat.off", "-o", "flat.off"], 2, "unknown output format"),
    ],
)
def test_wrong_input_gets_one_line_and_its_exit_code(
    tmp_path, monkeypatch, capsys, words, code, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "flat.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")
    before = sorted(tmp_path.iterdir())
    assert main(["chart", *words]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err
    assert "Traceback" not in captured.err
    assert sorted(tmp_path.iterdir()) == before


def test_an_interrupt_leaves_the_old_file_as_it_was(tmp_path, monkeypatch, capsys):
    path = tmp_path / "out.png"
    path.write_bytes(b"old")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("app.chart.writing.png", interrupted)
    assert main([*TINY, "--methods", "rusinkiewicz2004", "-o", str(path)]) == 130
    assert path.read_bytes() == b"old"
    assert [one.name for one in tmp_path.iterdir()] == ["out.png"]
