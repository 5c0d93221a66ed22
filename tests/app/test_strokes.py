"""Directions as strokes, and colours that fade: where they are, and that nothing else changes."""

import dataclasses

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.spatial import cKDTree

from app.colormaps import table
from app.fading import certainty
from app.picture import compose, render
from app.pipeline import Pipeline
from app.scene import Surface
from app.session import Method, Session
from app.strokes import strokes_of
from lutcore.analytic import saddle
from lutcore.curvature import PrincipalCurvatures

TORUS = Session(
    mesh="sample:torus",
    view="curvature",
    quantity="mean",
    estimator=Method("rusinkiewicz2004"),
    size=(200, 160),
)


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


class Doubtful(Pipeline):
    """Knows nothing of the half at negative x, and tells no directions."""

    def curvatures(self, session):
        found = super().curvatures(session)
        left = self.subject(session).mesh.vertices[:, 0] < 0.0
        return dataclasses.replace(found, error=np.where(left, 10.0, 0.0), directed=False)


def _surface(session, pipeline) -> Surface:
    content = compose(session, pipeline).panels[0].content
    assert isinstance(content, Surface)
    return content


def test_strokes_follow_the_directions_and_the_surface(pipeline):
    subject, found = pipeline.subject(TORUS), pipeline.curvatures(TORUS)
    strokes = strokes_of(subject.mesh, found)
    ends = strokes.points.reshape(2, len(strokes.at), -1, 2, 3)  # k1 and k2, station, side
    middle = ends.mean(axis=3)
    for line, direction in zip(middle, (found.d1, found.d2), strict=True):
        along = line[:, -1] - line[:, 0]
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        assert np.abs(np.einsum("ij,ij->i", along, direction[strokes.at])) == pytest.approx(1.0)
    # Above the surface by the same distance all along: a stroke that were straight would leave a
    # tube of this radius by a third of its own length at its ends.
    spacing = np.linalg.norm(middle[0, :, -1] - middle[0, :, 0], axis=1).max()
    away = cKDTree(subject.mesh.vertices).query(middle.reshape(-1, 3))[0]
    assert away.max() < spacing


def test_strokes_are_even_and_the_same_each_time(pipeline):
    subject, found = pipeline.subject(TORUS), pipeline.curvatures(TORUS)
    one, other = (strokes_of(subject.mesh, found) for _ in range(2))
    np.testing.assert_array_equal(one.points, other.points)
    points = subject.mesh.vertices
    near = cKDTree(points[one.at]).query(points[one.at], 2)[0][:, 1]
    far = cKDTree(points[one.at]).query(points)[0]
    # No two are nearer than the spacing, and no vertex is farther than that from all.
    assert far.max() <= near.min() * (1.0 + 1e-9)


def test_there_are_no_strokes_where_k1_and_k2_are_not_told_apart():
    exact = saddle(2000, k=(-0.5, 0.5))
    truth, count = exact.truth, len(exact.mesh.vertices)
    left = exact.mesh.vertices[:, 0] < 0.0
    error = np.where(left, 10.0, 0.01)
    error[np.flatnonzero(~left)[:5]] = np.inf
    doubtful = PrincipalCurvatures(
        truth.k1, truth.k2, truth.d1, truth.d2, truth.normals, error, np.zeros(count)
    )
    at = strokes_of(exact.mesh, doubtful).at
    assert len(at) > 20
    assert not left[at].any()
    assert np.isfinite(error[at]).all()


def test_strokes_are_drawn_on_curvature_and_nowhere_else(pipeline):
    session = replace(TORUS, strokes=True, flat=True, colormap="cividis")
    plain = render(replace(session, strokes=False), pipeline).image.astype(int)
    drawn = render(session, pipeline).image.astype(int)
    changed = drawn[(drawn != plain).any(axis=2)]
    assert len(changed) > 200
    # Black ones and white ones: darker, and lighter, than anything in this map.
    colors = 255.0 * table("cividis")
    assert changed.max(axis=1).min() < 0.5 * colors.max(axis=1).min()
    assert changed.min(axis=1).max() > 1.5 * colors.min(axis=1).max()
    shade = replace(session, view="shade")
    np.testing.assert_array_equal(
        render(shade, pipeline).image, render(replace(shade, strokes=False), pipeline).image
    )


def test_the_strokes_stay_the_same_while_colours_change(pipeline):
    one = _surface(replace(TORUS, strokes=True), pipeline)
    other = _surface(replace(TORUS, strokes=True, range=(0.0, 1.0)), pipeline)
    assert one.strokes is other.strokes is not None


def test_an_estimator_without_directions_says_so():
    surface = _surface(replace(TORUS, strokes=True), Doubtful())
    assert surface.strokes is None
    assert surface.caption == "rusinkiewicz2004 gives no directions"


def test_certainty_falls_between_twice_the_error_and_the_error():
    k1, k2 = np.array([1.0, 1.0, 1.0, 0.1, 0.0, 1.0]), np.array([0.0, 0.0, 0.0, -1.0, 0.0, 0.5])
    error = np.array([0.0, 0.5, 1.0, 2.0 / 3.0, 0.0, np.inf])
    axes = np.zeros((6, 3))
    found = certainty(PrincipalCurvatures(k1, k2, axes, axes, axes, error, 0.0))
    # In the middle, at an error of two thirds, halfway; 0 with error 0 is known exactly.
    assert found == pytest.approx([1.0, 1.0, 0.0, 0.5, 1.0, 0.0])


def test_fading_turns_doubtful_vertices_grey_and_leaves_the_others():
    pipeline, session = Doubtful(), replace(TORUS, fade=True)
    surface = _surface(session, pipeline)
    sure = certainty(pipeline.curvatures(session))
    assert surface.rgb is not None
    assert 0.4 < (sure == 1.0).mean() < 0.6
    spread = np.ptp(surface.rgb.astype(int), axis=1)
    assert (spread[sure == 0.0] == 0).all()
    plain = _surface(replace(session, fade=False), pipeline)
    assert plain.rgb is None
    assert plain.values is not None
    scale = plain.scale
    share = np.clip((plain.values - scale.low) / (scale.high - scale.low), 0.0, 1.0)
    color = scale.colors[np.minimum(256.0 * share, 255.0).astype(int)]
    np.testing.assert_allclose(surface.rgb[sure == 1.0], 255.0 * color[sure == 1.0], atol=0.51)


def test_a_certain_surface_does_not_change_when_it_fades(pipeline):
    session = replace(TORUS, flat=True)
    plain = render(session, pipeline).image.astype(int)
    faded = render(replace(session, fade=True), pipeline).image.astype(int)
    assert (certainty(pipeline.curvatures(session)) == 1.0).all()
    # Colours are mixed between vertices instead of looked up: a step or two of 256 apart, but for
    # silhouettes.
    assert np.percentile(np.abs(plain - faded), 99) <= 4


def test_percentiles_widen_the_automatic_range(pipeline):
    ends = [
        render(replace(TORUS, percentiles=shares), pipeline).range
        for shares in ((5.0, 95.0), (1.0, 99.0), (0.0, 100.0))
    ]
    assert ends[0] == render(TORUS, pipeline).range
    assert ends[2][0] < ends[1][0] < ends[0][0] < ends[0][1] < ends[1][1] < ends[2][1]
    with pytest.raises(ValueError, match="percentiles"):
        Session(percentiles=(95.0, 5.0))
