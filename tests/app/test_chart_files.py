import csv
import io
import re
from xml.etree import ElementTree

import pytest

from app.chart.captions import Inks, head
from app.chart.data import as_csv, gathered, plain, rows
from app.chart.drawing import figure
from app.chart.labels import overlap, place
from app.chart.page import page
from app.chart.points import Missing
from app.chart.writing import SUFFIXES, content
from lutcore.errors import ParameterError
from tests.app.charts import LADDER, chart, point


def test_labels_stay_apart_inside_and_off_the_points():
    from matplotlib.figure import Figure

    axes = Figure(figsize=(8, 5)).add_subplot()
    places = [(0.5 + 0.01 * i, 0.5 + 0.01 * (i % 2)) for i in range(6)]
    axes.set(xlim=(0, 1), ylim=(0, 1))
    boxes = place(
        axes,
        [(f"a label of some length {i}", *at) for i, at in enumerate(places)],
        places,
        bold="a label of some length 3",
        color="black",
        paper="white",
    )
    assert len(boxes) == 6
    frame = axes.get_window_extent()
    pixels = axes.transData.transform(places)
    for i, box in enumerate(boxes):
        assert not any(overlap(box, other) for other in boxes[:i])
        assert frame.x0 <= box[0] < box[2] <= frame.x1
        assert not any(overlap(box, (x, y, x + 1, y + 1)) for x, y in pixels)


@pytest.mark.parametrize(
    ("one", "other", "answer"),
    [
        ((0, 0, 2, 2), (1, 1, 3, 3), True),
        ((0, 0, 2, 2), (2, 0, 3, 2), False),
        ((0, 0, 9, 9), (3, 3, 4, 4), True),
        ((0, 0, 2, 2), (0, 3, 2, 4), False),
    ],
)
def test_boxes_overlap_where_they_share_more_than_an_edge(one, other, answer):
    assert overlap(one, other) is answer
    assert overlap(other, one) is answer


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(
    "points", [[], [point("a", 1e-6, 0.0)], LADDER], ids=["empty", "no error", "three"]
)
def test_every_format_holds_charts_of_any_size(suffix, points):
    assert len(content(chart(points, tolerance=0.01), suffix)) > 50


def test_another_ending_is_refused():
    with pytest.raises(ParameterError, match="output format"):
        content(chart(LADDER), ".pdf")


def test_each_name_has_a_look_of_its_own():
    many = [point(f"{i:02}", 1e-6 * (i + 1), 1.0 / (i + 1)) for i in range(40)]
    drawn = figure(chart(many), Inks())
    looks = {
        (line.get_color(), line.get_marker()) for line in drawn.axes[0].lines if line.get_gid()
    }
    assert len(looks) == 40


def test_csv_holds_every_point_and_everyone_missing():
    missing = [Missing("d", "4 h", "a reason, with a comma")]
    table = list(csv.DictReader(io.StringIO(as_csv(chart(LADDER, missing=missing)))))
    assert [row["name"] for row in table] == ["a", "b", "c", "d"]
    assert [row["recommended"] for row in table] == ["0", "1", "0", ""]
    assert float(table[2]["error_median"]) == pytest.approx(0.02)
    assert float(table[2]["microseconds_per_vertex_least"]) == pytest.approx(3.0)
    assert table[3]["reason"] == "a reason, with a comma"


def test_plain_values_say_all():
    said = plain(chart(LADDER, tolerance=0.5, missing=[Missing("d", "", "why")]))
    assert said["recommendation"]["name"] == "a"
    assert said["points"][0]["microseconds_per_vertex"]["median"] == pytest.approx(1.0)
    assert [one["on_front"] for one in said["points"]] == [True, True, True]
    assert said["missing"] == [{"name": "d", "setting": "", "reason": "why"}]


def test_the_table_is_sorted_by_error_and_marks_the_recommended():
    heading, *body = rows(chart(LADDER))
    assert [row[0] for row in body] == ["c", "b", "a"]
    assert [row[-1] for row in body] == ["front", "recommended", "front"]
    assert {len(row) for row in body} == {len(heading)}


def test_missing_ones_of_one_reason_stand_together():
    missing = [Missing("a", "2 h", "slow"), Missing("b", "", "b: no"), Missing("a", "4 h", "slow")]
    assert gathered(missing) == [("a (2 h, 4 h)", "slow"), ("b", "no")]


EVIL = "<script>alert('$x_1$')</script>&\""


def test_a_page_shows_what_it_is_given_and_runs_none_of_it():
    points = [point(EVIL, 1e-6, 0.1, setting=EVIL), *LADDER]
    made = page(chart(points, missing=[Missing(EVIL, EVIL, EVIL)], subject=EVIL))
    assert "<script" not in made
    assert "&lt;script&gt;" in made
    assert not re.search(r'(src|href)="(?!#)', made)  # nothing from elsewhere
    picture = made[made.index("<svg") : made.index("</svg>") + 6]
    ElementTree.fromstring(picture)  # well-formed, or it raises


def test_a_page_says_each_point_under_the_pointer_and_follows_the_theme():
    made = page(chart(LADDER))
    hints = re.findall(r"<title>([^<]*)</title>", made)
    assert [hint.splitlines()[0] for hint in hints[1:]] == ["a", "b", "c"]
    assert "error 3 %" in hints[2]
    assert "prefers-color-scheme: dark" in made
    assert not re.findall("#0[0-9]0[0-9]0[0-9]", made)  # no ink that was not replaced


@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_pictures_are_the_same_each_time(suffix):
    assert content(chart(LADDER), suffix) == content(chart(LADDER), suffix)


def test_a_picture_shows_formulas_in_names_as_they_are():
    drawn = content(chart(LADDER, subject="scan_$1^2$.ply"), ".svg").decode()
    assert "scan_$1^2$.ply" in drawn


@pytest.mark.parametrize("padding", range(8))
def test_a_per_cent_sign_stays_beside_its_number(padding):
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(15.0, 9.0))
    words = "y" * padding + " 12.5 %" * 30  # breaks in every place there is
    head(drawn, chart(LADDER, subject=words), Inks())
    lines = [line for text in drawn.texts for line in text.get_text().splitlines()]
    assert sum("12.5\N{NO-BREAK SPACE}%" in line for line in lines) > 1
    assert not any(line.startswith("%") for line in lines)
