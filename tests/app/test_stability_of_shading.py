import csv
import io
import json
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from app.cli.main import main
from app.stability_of_shading.files import SUFFIXES, record, save
from app.stability_of_shading.report import examine
from lutcore.stability_of_shading.maps import BETAS, CURVATURES, TOO_BRIGHT

WORDS = ["stability", "--shading", "--models", "lambert,kolchin2007"]


@pytest.fixture(scope="module")
def report():
    return examine(["lambert", "wrap", "kolchin2007"])


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_every_format_holds_all_cells(tmp_path, report, suffix):
    path = tmp_path / f"out{suffix}"
    save(path, report)
    cells, text = 3 * len(BETAS) * len(CURVATURES), path.read_bytes()
    if suffix == ".png":
        assert Image.open(path).size > (1000, 400)
    elif suffix == ".csv":
        assert len(list(csv.DictReader(io.StringIO(text.decode())))) == cells
    elif suffix == ".json":
        found = json.loads(text)
        assert len(found["cells"]) == cells
        missed = np.array(found["missed_over_r_d"]["wrap"])
        assert missed.shape == (len(BETAS), len(CURVATURES), len(found["n_dot_w"]))
    else:
        seen = _Seen()
        seen.feed(text.decode())
        assert seen.tags.count("rect") == cells
        assert seen.tags.count("path") == sum(len(one.regions) for one in report.outcomes)
        assert b"http" not in text


class _Seen(HTMLParser):
    def __init__(self):
        super().__init__()
        self.tags = []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)


def test_regions_and_checks_are_told_by_model(report):
    models = record(report)["models"]
    assert TOO_BRIGHT in models["kolchin2007"]["regions"]
    assert TOO_BRIGHT not in models["lambert"]["regions"]
    assert not models["kolchin2007"]["checks"]["extrapolation"]["passed"]
    shares = [one.failing for one in report.outcomes]
    assert shares == sorted(shares)


def test_the_table_names_regions_and_failed_checks(tmp_path, capsys):
    assert main([*WORDS, "-o", str(tmp_path / "a.csv"), "--tolerance", "0.2"]) == 0
    said = capsys.readouterr().out
    assert "tolerance 20 %" in said
    assert "more light out than in" in said
    assert "extrapolation: most exitance over irradiance" in said


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "a.png"], "--curvature or --shading"),
        (["--shading", "--curvature", "-o", "a.png"], "--curvature or --shading"),
        (["--shading", "-o", "a.pdf"], "PDF is not written; write -o a.html"),
        (["--shading", "-o", "a.png", "--models", "gather"], "unknown local shading model"),
        (["--shading", "-o", "a.png", "--eta", "9"], "eta"),
        (["--shading", "-o", "a.png", "--profile", "jensen"], "jensen2001"),
    ],
)
def test_wrong_input_gets_one_line(tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert main(["stability", *words]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err
    assert list(tmp_path.iterdir()) == []
