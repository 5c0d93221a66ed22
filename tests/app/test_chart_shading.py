import csv
import io
import json
from dataclasses import dataclass
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from app.chart.gathering import compared, sampled
from app.chart.shaders import ways
from app.chart.shading import TOLERANCES
from app.cli.main import main
from lutcore import analytic
from lutcore.parameters import choice, param
from lutcore.shading import ShadingModel, model_registry, shading_inputs

MODELS = ["--models", "lambert,curvature-lut,gather"]
FAST = ["--repeats", "1", "--sample", "20", "--limit", "120", "--method", "rusinkiewicz2004"]


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "torus.off"
    made = analytic.torus(300).mesh
    lines = ["OFF", f"{len(made.vertices)} {len(made.faces)} 0"]
    lines += [" ".join(map(repr, vertex.tolist())) for vertex in made.vertices]
    lines += [" ".join(map(str, [3, *face.tolist()])) for face in made.faces]
    path.write_text("\n".join(lines))
    return str(path)


@pytest.fixture(autouse=True)
def _small_warm_up(monkeypatch):
    """Let calls that do not count be short."""
    monkeypatch.setattr("app.chart.shaders._WARM_UP", 30)


def chart(mesh, path, *words):
    return main(["chart", mesh, "-o", str(path), *MODELS, *FAST, "--mm-per-unit", "20", *words])


@pytest.mark.parametrize("suffix", [".svg", ".csv"])
def test_the_command_writes_what_it_says(mesh, tmp_path, capsys, suffix):
    path = tmp_path / f"out{suffix}"
    assert chart(mesh, path, "--json", "--metric", "mean-de2000") == 0
    said = json.loads(capsys.readouterr().out)
    assert said["measure"] == "mean CIEDE2000"
    assert said["tolerance"] == TOLERANCES["mean-de2000"]
    points = {(one["name"], one["setting"]): one for one in said["points"]}
    # The reference is what `gather` computes, at the vertices that were drawn.
    assert points["gather", ""]["error"]["greatest"] < 1e-6
    assert points["gather", ""]["l2"] < 1e-6
    assert said["reference_error"] < 1e-4
    assert points["lambert", ""]["error"]["least"] > 0.1
    assert ("curvature-lut", "hinges 8") in points
    for one in said["points"]:
        each = one["microseconds_per_vertex"]["least"]
        assert one["milliseconds_per_frame"] == pytest.approx(1e-3 * each * said["vertices"])
    written = path.read_bytes()
    if suffix == ".svg":
        assert b"time for a frame of" in written
        ElementTree.fromstring(written)
    else:
        rows = list(csv.DictReader(io.StringIO(written.decode())))
        assert len(rows) == len(said["points"])
        assert {"l2", "relative", "milliseconds_per_frame"} <= set(rows[0])


class _Seen(HTMLParser):
    def __init__(self):
        super().__init__()
        self.tags, self.open = [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))


def test_the_page_holds_chart_pictures_and_ranges(mesh, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("app.chart.ranges.PHOTONS", 2_000)
    path = tmp_path / "out.html"
    assert chart(mesh, path, "--shadows", "on") == 0
    assert "cast shadows on both sides" in capsys.readouterr().out
    seen = _Seen()
    seen.feed(path.read_text())
    tags = [tag for tag, _ in seen.tags]
    assert tags.count("svg") == 2
    assert tags.count("img") == 1
    assert tags.count("title") > 8  # of the page, and a hint for each point
    links = [value for _, attrs in seen.tags for key, value in attrs.items() if key == "src"]
    assert all(link.startswith("data:") for link in links)


@pytest.mark.parametrize(("what", "suffix"), [("range", ".csv"), ("strip", ".png")])
def test_parts_can_be_had_alone(mesh, tmp_path, capsys, monkeypatch, what, suffix):
    monkeypatch.setattr("app.chart.ranges.PHOTONS", 2_000)
    path = tmp_path / f"out{suffix}"
    assert chart(mesh, path, "--show", what, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    if what == "strip":
        # The reference and two local models, and below them the bar and two maps.
        assert Image.open(path).size == (3 * 320, 2 * 320)
        return
    assert set(said["against_profile"]) == {"lambert", "curvature-lut"}
    at = said["radius_over_l_d"].index(10.0)
    assert said["against_profile"]["lambert"][at] == pytest.approx(0.049, abs=0.001)
    rows = list(csv.DictReader(io.StringIO(path.read_text())))
    assert len(rows) == 2 * (len(said["radius_over_l_d"]) + len(said["walk_standard_error"]))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "a.pdf"], "PDF is not written; write -o a.html"),
        (["-o", "a.csv", "--show", "strip"], "unknown output format '.csv'"),
        (["-o", "a.html", "--show", "range"], "unknown output format '.html'"),
        (["-o", "a.png", "--models", "lambrt"], "did you mean 'lambert'"),
        (["-o", "a.png", "--sample", "3"], "outside its range 10"),
        (["-o", "a.png", "--metric", "l3"], "metric"),
        (["-o", "a.png", "--tolerance", "-1"], "tolerance"),
    ],
)
def test_wrong_input_gets_one_line(mesh, tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert main(["chart", mesh, *words]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err
    assert list(tmp_path.iterdir()) == []


def test_a_dark_scene_is_refused_model_by_model(mesh, tmp_path, capsys):
    path = tmp_path / "a.csv"
    assert chart(mesh, path, "--point-light", "0,0,1,0") == 0
    captured = capsys.readouterr()
    assert "no light reaches the surface" in captured.err
    assert "No recommendation" in captured.out


def test_one_parameter_is_varied_at_a_time():
    @dataclass(frozen=True)
    class Made(ShadingModel):
        """Any."""

        width: float = param(0.5, 0.0, 1.0, "", "Even steps.")
        size: float = param(0.01, 1e-3, 0.1, "", "Tenfold steps.")
        count: int = param(2, 1, 16, "", "Doubled.")
        kind: str = choice("a", ("a", "b"), "Each option.")

        def shade(self, inputs):
            """Nothing."""

    found = [values for _, values, _ in ways(Made)]
    assert found[0] == {}
    assert all(len(values) <= 1 for values in found)
    assert [one["width"] for one in found if "width" in one] == [0.0, 0.25, 0.75, 1.0]
    assert [one["size"] for one in found if "size" in one] == pytest.approx([1e-3, 0.1])
    assert [one["count"] for one in found if "count" in one] == [1, 4, 8, 16]
    assert [one["kind"] for one in found if "kind" in one] == ["b"]


def test_vertices_are_drawn_as_often_as_they_have_area():
    exact = analytic.torus(400)
    normals = exact.truth.normals.copy()
    normals[:50] = 0.0
    drawn = sampled(exact.mesh, normals, 20_000, 3)
    assert drawn.min() >= 50
    # Vertices inside the ring have the least area: (R - r)/(R + r) of those outside.
    outside = np.hypot(*exact.mesh.vertices[:, :2].T)
    ends = [
        drawn[np.abs(outside[drawn] - end) < 0.02 * end] for end in (outside.min(), outside.max())
    ]
    assert 0 < len(ends[0]) < len(ends[1])


def test_errors_are_what_they_are_said_to_be(mesh):
    from app.chart.shaders import Scene
    from lutcore.lights import DirectionalLight

    exact = analytic.torus(300)
    light = DirectionalLight((0.0, 0.0, 1.0), (2.0, 2.0, 2.0))
    inputs = shading_inputs(exact.mesh, exact.truth, "skin1", [light])
    truth = model_registry.get("lambert")().shade(inputs)
    said = compared(Scene(inputs, inputs), 1.1 * truth, truth, np.full(3, 2.0), 0.5)
    assert said["l2"] == pytest.approx(0.1)
    brightest = np.percentile((0.1 * truth / inputs.table.total / 2.0).max(axis=1), 99.0)
    assert said["relative"] == pytest.approx(brightest)
    assert 0.0 < said["mean-de2000"] < said["p99-de2000"]
