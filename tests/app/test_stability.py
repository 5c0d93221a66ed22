"""The gallery run over estimators, from the command line and from Python."""

import csv
import io
import json
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from app.cli.main import main
from app.stability import examine
from app.stability_files import record, row, save
from app.stability_look import LOOKS, growth, number, sentence
from app.stability_thumbnail import thumbnails
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import CancelledError, MeshError, ParameterError
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.gallery import catalogue
from lutcore.gallery.judgement import Verdict
from lutcore.progress import tell

FAST = "rusinkiewicz2004,ball-jet"
CASES = "umbilic,noise-20,cracked-soup"


def run(*words):
    return main(["stability", *words])


def answered(values):
    """Return an estimator that answers any mesh with what `values` makes of its vertex count."""

    @dataclass(frozen=True)
    class Made(EstimatorParameters):
        def estimate(self, mesh, scale, progress):
            """Answer."""
            count = len(mesh.vertices)
            axes = np.tile(np.eye(3)[0], (count, 1))
            found = PrincipalCurvatures(
                np.ones(count), np.ones(count), axes, axes, axes, np.ones(count), 0.0
            )
            return values(found, progress)

    return Made


def hang(found, progress):
    while True:
        tell(progress, 0.5, "hanging")
        time.sleep(0.01)


def refuse(found, progress):
    raise MeshError("this mesh is\nnot to my taste")


def fault(found, progress):
    raise ZeroDivisionError("a fault")


ODD = {
    "hangs": hang,
    "refuses": refuse,
    "faults": fault,
    "says-nothing": lambda found, progress: replace(found, k1=found.k1 * np.nan),
    "turns": lambda found, progress: replace(found, k1=-found.k1, k2=-found.k2),
    "knows": lambda found, progress: found,
    "doubts": lambda found, progress: replace(found, error=found.error * np.inf),
}


@pytest.fixture(scope="module")
def report():
    cases = [catalogue.build(name) for name in CASES.split(",")]
    return examine(cases, [*FAST.split(","), "meshlab-pca"], seed=0, limit=30.0)


@pytest.fixture(scope="module")
def judged():
    """A report of estimators that do what none should, on a sphere, where k1 = k2 = 1."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("app.stability._START", 0.1)
        for name, values in ODD.items():
            patch.setitem(estimator_registry._loaded, name, answered(values))
        # Far more than the others need, even on a busy machine.
        return examine([catalogue.build("umbilic")], list(ODD), seed=0, limit=2.0)


def test_what_each_estimator_does_becomes_its_verdict(judged):
    found = {method: outcome for (_, method), outcome in judged.outcomes.items()}
    verdicts = {method: (outcome.verdict, outcome.message) for method, outcome in found.items()}
    assert verdicts == {
        "hangs": (Verdict.DIED, "took more than 2 s"),
        "refuses": (Verdict.REFUSED, "this mesh is not to my taste"),
        "faults": (Verdict.DIED, "fault in the estimator: ZeroDivisionError: a fault"),
        "says-nothing": (Verdict.WRONG, "4000 of 4000 vertices are not finite"),
        "turns": (Verdict.WRONG, "wrong sign at 100% of the vertices"),
        "knows": (Verdict.SURVIVES, ""),
        "doubts": (Verdict.SURVIVES, ""),
    }
    assert judged.methods[:2] == ["knows", "doubts"]
    assert judged.methods[2] == "refuses"  # no answer is better than a wrong one


@pytest.mark.parametrize("suffix", ["png", "csv", "json", "html"])
def test_even_the_odd_ones_can_be_written(judged, tmp_path, suffix):
    save(tmp_path / f"x.{suffix}", judged)
    assert (tmp_path / f"x.{suffix}").stat().st_size > 500


def test_the_error_without_the_defect_is_beside_it(report):
    noisy = report.outcomes["noise-20", "rusinkiewicz2004"]
    assert noisy.verdict is Verdict.WRONG
    assert noisy.without == pytest.approx(report.outcomes["cracked-soup", noisy.method].without)
    assert noisy.ratio == pytest.approx(noisy.score.error / noisy.without)
    assert noisy.ratio > 100.0
    assert report.outcomes["noise-20", "meshlab-pca"].ratio is None


def test_the_same_seed_gives_the_same_errors_and_another_others():
    errors = []
    for seed in (1, 1, 2):
        found = examine(
            [catalogue.build("noise-20", seed)], ["rusinkiewicz2004"], seed=seed, limit=30.0
        )
        errors.append(found.outcomes["noise-20", "rusinkiewicz2004"].score.error)
    assert errors[0] == errors[1] != errors[2]


def test_it_can_be_cancelled_and_says_where_it_stands():
    told = []

    def watch(share, step):
        told.append((share, step))
        return share < 0.5

    cases = [catalogue.build(name) for name in ("umbilic", "saddle")]
    with pytest.raises(CancelledError):
        examine(cases, ["rusinkiewicz2004", "ball-jet"], seed=0, limit=30.0, progress=watch)
    shares = [share for share, _ in told]
    assert shares == sorted(shares)
    assert (0.0, "rusinkiewicz2004: starting") in told
    assert any(step == "rusinkiewicz2004: saddle" for _, step in told)


def test_csv_has_a_row_for_each_case_and_estimator(report, tmp_path):
    save(tmp_path / "x.csv", report)
    with (tmp_path / "x.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 9
    assert list(rows[0])[:4] == ["case", "method", "verdict", "error"]
    (refused,) = [one for one in rows if (one["case"], one["method"]) == ("umbilic", "meshlab-pca")]
    assert (refused["verdict"], refused["error"]) == ("refused", "")
    assert "nothing to convert" in refused["message"]
    noisy = report.outcomes["noise-20", "ball-jet"]
    (same,) = [one for one in rows if (one["case"], one["method"]) == ("noise-20", "ball-jet")]
    assert float(same["error"]) == pytest.approx(noisy.score.error, rel=1e-5)


def test_json_tells_everything(report, tmp_path):
    save(tmp_path / "x.json", report)
    told = json.loads((tmp_path / "x.json").read_text())
    assert told == json.loads(json.dumps(record(report)))
    assert [case["name"] for case in told["cases"]] == CASES.split(",")
    assert told["methods"]["meshlab-pca"]["refused"] == 3
    assert set(told["verdicts"]) == {str(verdict) for verdict in Verdict}
    assert told["results"][0] == row(report.outcomes["umbilic", report.methods[0]])


class Page(HTMLParser):
    """Counts what a page is made of, and checks that what is opened is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.cells, self.sources = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.sources += [value for name, value in attrs if name in ("src", "href")]
        if tag == "td" and "title" in given:
            self.cells.append(given)
        if tag not in ("img", "meta"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_html_is_whole_and_needs_nothing_else(report, tmp_path):
    save(tmp_path / "x.html", report)
    text = (tmp_path / "x.html").read_text(encoding="utf-8")
    page = Page(text)
    assert page.open == []
    assert len(page.cells) == 9
    assert any("nothing to convert" in cell["title"] for cell in page.cells)
    assert len(page.sources) == 3
    assert all(source.startswith("data:image/png;base64,") for source in page.sources)
    assert all(case.why in text for case in report.cases)


def test_the_picture_has_the_verdicts_colours_in_their_places(report, tmp_path):
    save(tmp_path / "x.png", report)
    picture = np.asarray(Image.open(tmp_path / "x.png").convert("RGB")).astype(int)
    for verdict in (Verdict.SURVIVES, Verdict.WRONG, Verdict.DEGRADED):
        fill = [int(LOOKS[verdict].fill[i : i + 2], 16) for i in (1, 3, 5)]
        covered = np.mean(np.abs(picture - fill).max(axis=2) <= 2)
        cells = sum(report.count(method)[verdict] for method in report.methods)
        # A cell is .78 by .64 inches; text and the white line between cells take a fifth.
        size = cells * 78 * 64 / (picture.shape[0] * picture.shape[1])
        assert 0.6 * size < covered < size + 0.01


def test_verdicts_differ_in_grey_and_have_marks():
    def grey(color):
        red, green, blue = (int(color[i : i + 2], 16) for i in (1, 3, 5))
        return 0.299 * red + 0.587 * green + 0.114 * blue

    filled = sorted(grey(look.fill) for look in LOOKS.values())
    assert min(np.diff(filled)) > 20.0
    assert len({look.mark for look in LOOKS.values()}) == len(LOOKS)
    assert all(abs(grey(look.fill) - grey(look.text)) > 100.0 for look in LOOKS.values())


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "<.001"),
        (0.0123, ".012"),
        (0.0996, ".10"),
        (0.5, ".50"),
        (0.996, "1"),
        (1.34, "1.3"),
        (12.3, "12"),
        (1e9, ">99"),
        (np.inf, ">99"),
    ],
)
def test_numbers_are_short(value, text):
    assert number(value) == text


def test_growth_is_short_and_the_sentence_is_not(report):
    noisy = report.outcomes["noise-20", "rusinkiewicz2004"]
    assert growth(replace(noisy, without=noisy.score.error / 3.0))[1:] == "3"
    assert growth(replace(noisy, without=noisy.score.error / 300.0))[1:] == "300"
    assert growth(replace(noisy, without=noisy.score.error / 3e4))[1:] == ">999"
    assert growth(replace(noisy, without=noisy.score.error * 3e4))[1:] == "<.01"
    assert growth(replace(noisy, without=None)) == ""
    assert growth(replace(noisy, without=0.0)) == ""
    assert "within its error bar" in sentence(noisy)
    assert "nothing to convert" in sentence(report.outcomes["umbilic", "meshlab-pca"])


def test_thumbnails_show_the_damage():
    flipped, sound = (thumbnails(catalogue.build(name), 60) for name in ("flipped-all", "noise-0"))
    assert flipped.shape == (60, 120, 3)

    def orange(image):
        red, blue = image[..., 0].astype(int), image[..., 2].astype(int)
        return np.mean(red > blue + 60)

    assert orange(flipped) > 0.4
    assert orange(sound) == 0.0


def test_the_command_prints_a_table_and_writes_the_file(tmp_path, capsys):
    out = tmp_path / "x.csv"
    words = ["--curvature", "-o", str(out), "--methods", FAST, "--cases", CASES]
    assert run(*words) == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    lines = shown.out.splitlines()
    assert lines[0].split() == ["case", "1", "2"]
    assert [line.split()[0] for line in lines[1:4]] == CASES.split(",")
    assert any(line.split()[1:3] == ["rusinkiewicz2004", "1"] for line in lines)
    assert lines[-1] == f"wrote {out}"
    assert shown.out.isascii()  # any terminal can show it
    assert len(list(csv.reader(io.StringIO(out.read_text())))) == 7


def test_the_command_answers_with_one_object(tmp_path, capsys):
    out = tmp_path / "x.json"
    words = ["-o", str(out), "--methods", "rusinkiewicz2004,rusinkiewicz2004", "--cases", "saddle"]
    assert run("--curvature", *words, "--json", "--seed", "7") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["output"] == str(out)
    assert told["seed"] == 7
    assert told["seconds"] > 0.0
    assert list(told["methods"]) == ["rusinkiewicz2004"]
    written = json.loads(out.read_text())
    assert written["results"] == told["results"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "--curvature"),
        (["--curvature", "--methods", "rusinkiewicz"], "did you mean 'rusinkiewicz2004'"),
        (["--curvature", "--methods", ""], "unknown curvature estimator ''"),
        (["--curvature", "--cases", "spikes"], "did you mean 'spike'"),
        (["--curvature", "--limit", "0"], "--limit = 0"),
        (["--curvature", "--limit", "nan"], "--limit = nan"),
        (["--curvature", "--seed", "-1", "--cases", "spike"], "seed = -1"),
    ],
)
def test_wrong_usage_is_told_before_any_work(tmp_path, capsys, words, message):
    out = tmp_path / "x.csv"
    assert run("-o", str(out), *words) == 2
    shown = capsys.readouterr()
    assert message in shown.err
    assert shown.out == ""
    assert not list(tmp_path.iterdir())


def test_an_unknown_ending_and_a_missing_folder_are_told_before_any_work(tmp_path, capsys):
    assert run("--curvature", "-o", str(tmp_path / "x.pdf")) == 2
    assert ".html" in capsys.readouterr().err
    assert run("--curvature", "-o", str(tmp_path / "none" / "x.png")) == 1
    assert "make the folder first" in capsys.readouterr().err


def test_saving_to_an_unknown_ending_is_refused(report, tmp_path):
    with pytest.raises(ParameterError, match=r"\.pdf"):
        save(tmp_path / "x.pdf", report)


def test_an_interrupt_leaves_the_old_file_and_nothing_else(tmp_path, capsys, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    out = tmp_path / "x.csv"
    out.write_text("before")
    monkeypatch.setattr("app.stability.principal_curvatures", interrupted)
    assert run("--curvature", "-o", str(out), "--cases", "saddle") == 130
    assert "interrupted" in capsys.readouterr().err
    assert out.read_text() == "before"
    assert list(tmp_path.iterdir()) == [out]


def test_help_says_what_the_outputs_are_and_imports_nothing_heavy():
    code = (
        "import sys; from app.cli.main import main; main(['stability', '--help']);"
        "print([name for name in ('numpy', 'matplotlib', 'numba') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "--curvature" in done.stdout
    assert done.stdout.splitlines()[-1] == "[]"
