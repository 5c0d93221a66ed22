import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.camera import VIEWS, axes, fit, parse
from app.session import Camera
from lutcore.errors import ParameterError

POINTS = np.random.default_rng(5).normal(size=(200, 3)) * (3.0, 1.0, 0.5) + (100.0, -7.0, 2.0)


def projected(camera, points, aspect):
    """Picture coordinates: what is seen lies within -1 and 1."""
    x, y, z = axes(camera) @ (points - np.asarray(camera.position)).T
    slope = np.tan(np.radians(camera.angle / 2.0))
    return x / (-z * slope * aspect), y / (-z * slope), -z


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("aspect", [0.4, 1.0, 2.5])
def test_a_fitted_view_shows_all_points_and_nearly_fills_the_picture(view, aspect):
    camera = fit(view, POINTS, aspect)
    x, y, depth = projected(camera, POINTS, aspect)
    assert (depth > 0.0).all()
    largest = max(abs(x).max(), abs(y).max())
    assert 0.85 < largest < 1.0


def test_a_fitted_view_is_centred():
    x, y, _ = projected(fit("front", POINTS, 1.0), POINTS, 1.0)
    assert abs(x.max() + x.min()) < 0.05
    assert abs(y.max() + y.min()) < 0.05


@given(st.tuples(*[st.floats(-5.0, 5.0)] * 3), st.tuples(*[st.floats(-5.0, 5.0)] * 3))
def test_camera_axes_are_orthonormal_or_refused(position, up):
    try:
        frame = axes(Camera(position, (0.0, 0.0, 0.0), up))
    except ParameterError:
        return
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-6)
    assert np.linalg.det(frame) == pytest.approx(1.0, abs=1e-6)


def test_a_camera_is_a_name_or_nine_or_ten_numbers():
    assert parse("left") == "left"
    assert parse("1,2,3,0,0,0,0,1,0") == Camera((1.0, 2.0, 3.0), (0.0, 0.0, 0.0))
    assert parse("1,2,3,0,0,0,0,1,0,45").angle == 45.0


@pytest.mark.parametrize("text", ["lft", "1,2,3", "1,2,3,4,5,6,7,8,x", "nan,2,3,0,0,0,0,1,0"])
def test_other_words_for_a_camera_are_refused(text):
    with pytest.raises(ParameterError, match="camera"):
        parse(text)


def test_one_point_can_be_seen():
    camera = fit("front", np.zeros((1, 3)), 1.0)
    assert np.isfinite(camera.position).all()
    assert camera.position != camera.target
