import base64
import json
import re
from html.parser import HTMLParser
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from app.cli.main import main
from app.report_histograms import svg
from app.session import read
from lutcore.statistics import histogram
from tests import mesh_files

FAST = ["--method", "rusinkiewicz2004"]
PEERS = ["--disagree", "rusinkiewicz2004,ball-jet,corrected-curvature"]
REPORT_SIZE = ["--size", "640x320"]
VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """What a browser would take from a report: tags, addresses, text; every tag closed."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.addresses, self.text, self.open = [], [], "", []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.addresses += [value for name, value in attrs if name in ("src", "href", "xlink:href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def report(path, *arguments):
    assert main(["curvature", *arguments, "-o", str(path), "--quiet", *REPORT_SIZE]) == 0
    text = path.read_text(encoding="utf-8")
    return Page(text), text


@pytest.fixture(scope="module")
def torus(tmp_path_factory):
    return report(tmp_path_factory.mktemp("report") / "r.html", "sample:torus", *FAST, *PEERS)


def test_a_report_says_all_that_a_colleague_must_know(torus, capsys):
    page, _ = torus
    said = " ".join(page.text.split())
    for words in (
        "Curvature of sample:torus",
        "3,959 vertices, 7,918 triangles, diagonal 38.",
        "Method rusinkiewicz2004: One-ring estimator",
        "one sigma of k1 and of k2",
        "Gauss-Bonnet residual",
        "have |k| below its error",
        "interior: 3,959 vertices",
        "Where estimators disagree",
        "Nothing odd about the mesh was found",
        "SHA-256 c87f84749788d929",
        "curvelight curvature sample:torus",
        "numba",
    ):
        assert words in said, words


def test_its_numbers_are_those_of_the_command_in_mm(tmp_path, capsys):
    scaled = [*FAST, "--mm-per-unit", "10"]
    page, _ = report(tmp_path / "r.html", "sample:torus", *scaled)
    data = str(tmp_path / "x.npz")
    capsys.readouterr()
    assert main(["curvature", "sample:torus", "-o", data, "--json", *scaled]) == 0
    found = json.loads(capsys.readouterr().out)["percentiles"]["interior"]
    assert f"{found['k2']['p95'] / 10.0:.3g}" in page.text
    assert f"{found['gauss']['p5'] / 100.0:.3g}" in page.text


def test_a_report_needs_nothing_from_outside_and_runs_nothing(torus):
    page, text = torus
    assert "script" not in page.tags
    assert "link" not in page.tags
    outside = [one for one in page.addresses if not one.startswith(("data:image/png;base64,", "#"))]
    assert outside == []
    assert not re.search(r"url\((?!#)|@import", text)


def test_its_pictures_come_for_light_and_dark_surroundings(torus):
    page, text = torus
    pictures = [
        np.asarray(Image.open(BytesIO(base64.b64decode(one.partition(",")[2]))))
        for one in page.addresses
        if one.startswith("data:")
    ]
    assert [picture.shape[:2] for picture in pictures] == [(320, 640)] * 2 + [(800, 1000)] * 2
    assert [picture[0, 0, 0] > 128 for picture in pictures] == [True, False] * 2
    assert page.tags.count("svg") == 1
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text


def test_a_background_that_is_asked_for_holds_for_both(tmp_path):
    page, _ = report(tmp_path / "r.html", "sample:torus", *FAST, "--background", "#102030")
    assert sum(one.startswith("data:") for one in page.addresses) == 1


def test_a_name_that_looks_like_markup_is_text(tmp_path):
    name = '<script>alert(1)<b>&".ply'
    (tmp_path / name).write_bytes(mesh_files.ply(*mesh_files.grid()))
    page, text = report(tmp_path / "r.html", str(tmp_path / name), *FAST)
    assert "script" not in page.tags
    assert "b" in page.tags  # ours, around the method
    assert f"Curvature of {name}" in page.text
    assert "<script" not in text
    assert "1 mesh unit is 1 mm (assumed)" in page.text
    assert "boundary edges: 16" in page.text


def test_the_same_command_writes_the_same_report(tmp_path):
    path = tmp_path / "r.html"
    _, one = report(path, "sample:sphere", *FAST)
    _, other = report(path, "sample:sphere", *FAST)
    assert one == other


def test_a_report_shows_all_quantities_and_says_so(tmp_path, capsys):
    path = tmp_path / "r.html"
    assert main(["curvature", "sample:torus", "-o", str(path), "--quantity", "k1", *FAST]) == 2
    assert "leave --quantity out" in capsys.readouterr().err
    assert not path.exists()


def test_a_histogram_takes_the_pages_colour_and_has_a_bar_for_each_step():
    counted = histogram(np.linspace(0.0, 1.0, 1000), 0.0, 1.0, bins=8)
    colors = np.linspace([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 256)
    drawn = svg({"k1": counted}, colors)
    assert drawn.startswith("<svg")
    assert "currentColor" in drawn
    assert "#010203" not in drawn
    assert "#ff0000" in drawn
    assert "#0000ff" in drawn


def test_all_quantities_make_one_picture_that_a_session_repeats(tmp_path, capsys):
    one, other, saved = (tmp_path / name for name in ("1.png", "2.png", "s.json"))
    asked = ["--quantity", "all", *PEERS, *FAST]
    flags = ["-o", str(one), "--save-session", str(saved), "--json"]
    assert main(["curvature", "sample:torus", *flags, *asked]) == 0
    result = json.loads(capsys.readouterr().out)
    assert len(result["histograms"]) == 9
    assert len(read(saved).peers) == 3
    assert main(["curvature", "--session", str(saved), "-o", str(other), "--quiet"]) == 0
    assert one.read_bytes() == other.read_bytes()
    picture = np.asarray(Image.open(one)).astype(int)
    assert picture.shape == (1650, 1800, 3)
    # Every panel has a torus on the ground of the picture.
    panels = np.abs(picture - picture[0, 0]).max(axis=2).reshape(3, 550, 3, 600) > 40
    assert (panels.mean(axis=(1, 3)) > 0.1).all()


def test_a_histogram_and_the_disagreement_are_in_the_answer(tmp_path, capsys):
    path = tmp_path / "x.csv"
    arguments = ["curvature", "sample:torus", "-o", str(path), *PEERS, *FAST]
    assert main([*arguments, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    (counted,) = result["histograms"].values()
    assert list(result["histograms"]) == ["disagreement"]
    assert counted["unit"] == "1/mm"
    assert len(counted["edges"]) == len(counted["counts"]) + 1
    assert sum(counted["counts"]) + counted["below"] + counted["above"] == 3959
    apart = result["disagreement"]
    assert set(apart["median_distance"]) == set(PEERS[1].split(","))
    assert 0.0 <= apart["share_beyond_two_errors"] <= 1.0
    found = np.genfromtxt(path, delimiter=",", names=True)
    median = result["percentiles"]["interior"]["disagreement"]["p50"]
    assert np.median(found["curvature_disagreement"]) == pytest.approx(median, rel=1e-6)
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert "of disagreement, 1/mm" in said
    assert "####" in said
    assert "more than twice the error bar of rusinkiewicz2004" in said


def test_one_left_out_of_the_disagreement_is_reported(tmp_path, capsys):
    asked = [PEERS[0], f"{PEERS[1]},meshlab-pca"]
    out = ["-o", str(tmp_path / "x.npz"), "--json"]
    assert main(["curvature", "sample:torus", *out, *asked, *FAST]) == 0
    captured = capsys.readouterr()
    result = json.loads(captured.out)
    assert "left out of the disagreement: meshlab-pca" in result["warnings"][-1]
    assert "left out of the disagreement: meshlab-pca" in captured.err
    assert list(result["disagreement"]["refused"]) == ["meshlab-pca"]


def test_chosen_scales_are_reported_and_exported(tmp_path, capsys):
    path = tmp_path / "x.npz"
    flags = ["--method", "corrected-curvature", "--scale", "2", "--json"]
    assert main(["curvature", "sample:torus", "-o", str(path), *flags]) == 0
    scales = json.loads(capsys.readouterr().out)["percentiles"]["interior"]["scale"]
    assert scales["p1"] == scales["p99"] == pytest.approx(2.0)
    with np.load(path) as found:
        np.testing.assert_allclose(found["curvature_scale"], 2.0)
