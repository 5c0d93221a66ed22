"""A comparison's parts are what each would be alone, bit for bit."""

import json

import numpy as np
import pytest
from msgspec.structs import replace

from app.cli.main import main
from app.contestants import alone, size
from app.differences import difference_of
from app.picture import compose, render
from app.pipeline import Pipeline
from app.scene import Surface
from app.session import Camera, Method, Session, Substance, from_json, to_json
from app.wiping import column, line
from lutcore.errors import ParameterError
from lutcore.mesh import TriangleMesh
from lutcore.metrics import ciede2000

TORUS = Session(mesh="sample:torus", view="compare", size=(320, 240))
KINDS = {
    "model": (Method("lambert"), Method("wrap", {"width": 0.6})),
    "estimator": (Method("vtk"), Method("rusinkiewicz2004")),
    "material": (Method("ketchup"), Method("marble")),
}


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


def _of(kind, **fields):
    return replace(TORUS, compared_by=kind, compared=KINDS[kind], **fields)


def _alone(session, index, made, pipeline):
    """What one of the compared is by itself, under what the comparison settled."""
    single = replace(alone(session)[index], camera=made.camera, wipe=None, difference=False)
    if made.exposure is not None:
        single = replace(single, exposure=made.exposure)
    if session.compared_by == "estimator":
        single = replace(single, range=made.ranges[session.quantity])
    return render(single, pipeline)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("at", [0.4, 0.0, 1.0])
def test_either_side_of_a_wipe_is_its_own_picture(kind, at, pipeline):
    session = _of(kind, wipe=at)
    made = render(session, pipeline)
    height, width, _ = made.image.shape
    share = compose(session, pipeline).panels[0].width
    box = (0, round(0.045 * height), round(share * width), height - round(0.045 * height))
    rows, middle, (start, stop) = slice(0, box[3]), column(box, at), line(box, at)
    first, second = (_alone(session, index, made, pipeline).image for index in (0, 1))
    left, right = slice(0, min(start, middle)), slice(max(stop, middle), box[2])
    np.testing.assert_array_equal(made.image[rows, left], first[rows, left])
    np.testing.assert_array_equal(made.image[rows, right], second[rows, right])
    assert not np.array_equal(first, second)
    if 0.0 < at < 1.0:
        assert stop > start
        assert len(np.unique(made.image[rows, start:stop])) == 1
    else:
        assert start == stop


@pytest.mark.parametrize("kind", KINDS)
def test_the_compared_have_the_colours_of_their_own_pictures(kind, pipeline):
    session = _of(kind)
    made = compose(session, pipeline)
    for index in (0, 1):
        single = replace(alone(session)[index], camera=made.camera, exposure=made.exposure)
        single = replace(single, range=made.ranges.get(session.quantity))
        own = compose(single, pipeline).panels[0].content
        here = made.panels[index].content
        for field in ("rgb", "values", "normals"):
            np.testing.assert_array_equal(getattr(here, field), getattr(own, field))
        assert here.lit == own.lit


def test_materials_are_exposed_for_the_brightest_and_models_for_the_first(pipeline):
    there = compose(_of("material"), pipeline)
    swapped = replace(_of("material"), compared=KINDS["material"][::-1])
    assert there.exposure == compose(swapped, pipeline).exposure
    ketchup = replace(alone(_of("material"))[0], camera=there.camera)
    assert there.exposure < compose(ketchup, pipeline).exposure
    session = _of("model")
    first = replace(alone(session)[0], camera=there.camera)
    made = compose(replace(session, camera=there.camera), pipeline)
    assert made.exposure == compose(first, pipeline).exposure


def test_a_difference_says_where_it_is_most(pipeline):
    made = compose(_of("model", difference=True), pipeline)
    (found,) = made.difference.values()
    one, two = (made.panels[index].content.rgb for index in (0, 1))
    values = ciede2000(one, two)
    mesh = made.panels[0].content.mesh
    assert found["vertex"] == np.argmax(values)
    assert found["max"] == values.max()
    assert found["mean"] == values.mean()
    assert found["p99"] == np.percentile(values, 99.0)
    np.testing.assert_array_equal(found["position"], mesh.vertices[found["vertex"]])


def test_estimators_differ_in_the_unit_of_the_quantity(pipeline):
    made = compose(_of("estimator", difference=True, quantity="mean"), pipeline)
    ((label, found),) = made.difference.items()
    assert label == "rusinkiewicz2004"
    one, two = (made.panels[index].content.values for index in (0, 1))
    assert found["max"] == np.abs(one - two).max() > 0.0
    coarse = compose(_of("estimator", difference=True, quantity="mean", mm_per_unit=2.0), pipeline)
    assert coarse.difference[label]["max"] == pytest.approx(found["max"] / 2.0)
    # One bar for all that are compared, and one for the difference, which is not of their map.
    contents = [panel.content for panel in made.panels]
    bars = [content for content in contents if not isinstance(content, Surface)]
    assert [(bar.low, bar.high) for bar in bars] == [made.ranges["mean"], made.ranges["difference"]]
    scales = [content.scale for content in contents if isinstance(content, Surface)]
    assert scales[0].low == scales[1].low < scales[0].high == scales[1].high


def test_vertices_without_an_estimate_have_no_say():
    mesh = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    values = np.array([1.0, 9.0, 3.0])
    found = difference_of(values, mesh, np.array([True, False, True]))
    assert (found["max"], found["vertex"], found["mean"]) == (3.0, 2, 2.0)
    with pytest.raises(ParameterError, match="in common"):
        difference_of(values, mesh, np.zeros(3, dtype=bool))


def test_four_lie_in_a_square_and_each_is_drawn(pipeline):
    four = (Method("lambert"), Method("wrap"), Method("kubo2010"), Method("curvature-lut"))
    session = replace(TORUS, compared=four)
    made = compose(session, pipeline)
    assert (made.rows, len(made.panels)) == (2, 4)
    assert size(session) == (1600, 1600)
    image = render(session, pipeline).image
    half = image.shape[0] // 2, image.shape[1] // 2
    corners = [
        image[y : y + half[0] - 15, x : x + half[1]] for y in (0, half[0]) for x in (0, half[1])
    ]
    bare = [(corner == image[0, 0]).all(axis=2).mean() for corner in corners]
    assert min(bare) == pytest.approx(max(bare), abs=0.01)
    assert 0.2 < bare[0] < 0.9
    assert len({corner.mean() for corner in corners}) == 4


def test_the_bar_of_four_estimators_goes_over_both_rows(pipeline):
    four = tuple(Method(name) for name in ("vtk", "trimesh", "rusinkiewicz2004", "vtk"))
    made = compose(replace(TORUS, compared=four, compared_by="estimator"), pipeline)
    assert [panel.tall for panel in made.panels] == [False, False, True, False, False]
    assert sum(panel.width for panel in made.panels[:3]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"compared": ()}, "two models"),
        ({"compared": (Method("skin1"),), "compared_by": "material"}, "two materials"),
        ({"compared": (Method("wrap"),) * 3, "wipe": 0.5}, "a wipe is between two"),
        (
            {"compared": (Method("vtk"),) * 2, "compared_by": "estimator", "quantity": "all"},
            "not one number",
        ),
        (
            {"compared": (Method("skin1", {"eta": 1.0}),) * 2, "compared_by": "material"},
            "no parameters",
        ),
        ({"compared": (Method("skin1"), Method("skin3")), "compared_by": "material"}, "skin1"),
    ],
)
def test_what_cannot_be_compared_is_refused(fields, words, pipeline):
    with pytest.raises(ParameterError, match=words):
        compose(replace(TORUS, **fields), pipeline)


def test_a_material_of_ones_own_is_compared_by_its_name(pipeline):
    own = Substance("soap", (1.0, 1.0, 1.0), (0.01, 0.02, 0.03), 1.4)
    session = replace(
        TORUS, material=own, compared=(Method("soap"), Method("skin1")), compared_by="material"
    )
    assert [one.material for one in alone(session)] == [own, "skin1"]
    assert compose(session, pipeline).panels[0].content.caption == "soap"


def test_a_session_says_it_in_json():
    session = _of("material", wipe=0.25)
    assert from_json(to_json(session)) == session
    # What was written before there were these fields.
    old = json.loads(to_json(_of("model")))
    del old["wipe"], old["compared_by"]
    assert from_json(json.dumps(old).encode()) == _of("model")


def test_a_difference_in_a_session_takes_no_room_from_another_view(pipeline):
    plain = render(replace(TORUS, view="shade"), pipeline).image
    left_on = render(replace(TORUS, view="shade", difference=True), pipeline).image
    np.testing.assert_array_equal(left_on, plain)


def test_the_command_line_says_the_same(tmp_path, capsys, pipeline):
    place = tmp_path / "w.png"
    words = ["--models", "vtk,rusinkiewicz2004", "--by", "estimator", "--wipe", "0.3"]
    words += ["--difference", "--size", "320x240", "--json", "-o", str(place)]
    assert main(["compare", "sample:torus", *words]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["by"], told["unit"], told["quantity"]) == ("estimator", "1/mm", "curvedness")
    (found,) = told["difference"].values()
    assert set(found) == {"mean", "p99", "max", "vertex", "position"}
    from PIL import Image

    session = _of("estimator", wipe=0.3, difference=True)
    np.testing.assert_array_equal(np.asarray(Image.open(place)), render(session, pipeline).image)
    assert main(["compare", "sample:torus", "--models", "a,b,c", "--wipe", "0.5", "-o", "x.png"])
    assert "a wipe is between two" in capsys.readouterr().err


@pytest.mark.parametrize("parallel", [False, True])
def test_parts_far_behind_do_not_clip_what_is_looked_at(tmp_path, pipeline, parallel):
    path, far = tmp_path / "islands.off", 1e6
    corner = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    stray = corner * 0.01 + [0.0, 0.0, -3e4]
    points = np.vstack([corner, stray]) + far
    lines = [" ".join(map(repr, map(float, point))) for point in points]
    faces = ["3 0 1 2", "3 0 2 3", "3 4 5 6", "3 4 6 7"]
    path.write_text("\n".join(["OFF", "8 4 0", *lines, *faces, ""]))
    session = replace(
        _of("model"),
        mesh=str(path),
        camera=Camera((far, far, far + 4.0), (far, far, far), height=2.2 if parallel else None),
    )
    image = render(session, pipeline).image[:220]
    bare = (image == image[0, 0]).all(axis=2)
    # 2 units of 2.14 that the height shows, of either half of the width, are the square.
    assert 0.3 < 1.0 - bare.mean() < 1.0
    halves = bare[:, :160], bare[:, 160:]
    assert (halves[0] != halves[1]).mean() < 0.01
