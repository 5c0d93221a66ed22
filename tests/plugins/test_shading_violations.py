"""By how much, and where, some published methods break what light does; see `VIOLATIONS`."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lutcore.baking import bake
from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from lutcore.materials import material
from lutcore.shading import model_registry, shading_models
from tests.plugins import test_every_shading_model
from tests.plugins.shading_violations import VIOLATIONS
from tests.surfaces import sphere

FloatArray = NDArray[np.float64]
ABOVE = [DirectionalLight((0.0, 0.0, 1.0))]
FIRST_ORDER = ("kolchin2007", "kolchin2007-simplified")
RINGS = ("kubo2010", "penner2011")


def gain(model: str, name: str, ratio: float, **parameters: Any) -> float:
    """Return the light that a sphere of `ratio` l_u gives out, over what Lambert's does; red."""
    x, weights = np.polynomial.legendre.leggauss(200)
    cosines = np.concatenate((0.5 * (x - 1.0), 0.5 * (x + 1.0)))
    table = bake(name)
    surface = sphere(cosines, ratio * table.mean_free_path[0])
    shaded = shade(*surface, name, ABOVE, model, **parameters)[:, 0]
    return float(np.tile(weights, 2) @ shaded / (table.total[0] * table.entering[0]))


def drop(model: str, name: str, ratio: float) -> float:
    """Return the share by which a rising light darkens a sphere of `ratio` l_u; red."""
    cosines = np.cos(np.linspace(np.pi, 0.0, 721))
    surface = sphere(cosines, ratio * material(name).mean_free_path[0])
    shaded = shade(*surface, name, ABOVE, model)[:, 0]
    return float((np.maximum.accumulate(shaded) - shaded).max() / shaded.max())


def test_every_violation_is_of_a_test_and_a_local_model() -> None:
    for test, model, _, _ in VIOLATIONS:
        assert hasattr(test_every_shading_model, test)
        assert model in shading_models() and model_registry.get(model).local


@pytest.mark.parametrize("width", [0.0, 0.2, 1.0])
def test_wrap_gives_out_one_plus_its_width(width: float) -> None:
    # int (c + w)/(1 + w) dc from -w to 1 is (1 + w)/2, Lambert's 1/2.
    for ratio in (0.1, np.inf):
        assert gain("wrap", "marble", ratio, width=width) == pytest.approx(1.0 + width, rel=1e-3)


@pytest.mark.parametrize("angle", [90.0, 110.0, 180.0])
def test_wrap_by_angle_gives_out_more_the_further_it_reaches(angle: float) -> None:
    end = np.radians(angle)
    expected = 2.0 * (1.0 - np.sin(end) / end)  # .73, 1.02 and 2
    for ratio in (0.1, np.inf):
        found = gain("bredow2002", "marble", ratio, angle=angle)
        assert found == pytest.approx(expected, rel=1e-3)


def test_wrapped_flat_surfaces_are_off_lambert_most_at_the_terminator() -> None:
    cosines = np.linspace(-1.0, 1.0, 2001)
    surface = sphere(cosines, np.inf)
    lambert = shade(*surface, "skin1", ABOVE, "lambert")[:, 0]
    for model, most in (("wrap", 0.2 / 1.2), ("bredow2002", 1.0 - 90.0 / 110.0)):
        off = np.abs(shade(*surface, "skin1", ABOVE, model)[:, 0] - lambert) / lambert.max()
        assert off.max() == pytest.approx(most, rel=1e-9)
        assert abs(cosines[off.argmax()]) < 1e-3


@pytest.mark.parametrize("model", RINGS)
@pytest.mark.parametrize("name", ["skin1", "marble", "spectralon"])
def test_rings_give_out_four_over_pi_of_lambert_at_most(model: str, name: str) -> None:
    ratios = np.geomspace(0.02, 1000.0, 20)
    gains = np.array([gain(model, name, ratio) for ratio in ratios])
    # A tiny ball is lit evenly: the mean of max(cos, 0) around a ring is 1/pi, over a ball 1/4.
    assert gains[0] == pytest.approx(4.0 / np.pi, rel=1e-3)
    assert (np.diff(gains) <= 1e-4).all()
    assert gains[-1] == pytest.approx(1.0, abs=1e-2)


@pytest.mark.parametrize("model", FIRST_ORDER)
@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_the_first_order_makes_light_without_bound(model: str, name: str) -> None:
    table = bake(name)
    # A tiny ball is all glow, R_d psi(0) l_u sin/radius; 2 int sqrt(1 - c^2) dc = pi.
    for ratio in (1e-4, 1e-3):
        expected = np.pi * table.psi[0, 0] / ratio
        assert gain(model, name, ratio) == pytest.approx(expected, rel=2e-3)
    # A large one has the area that Monge's form with a flat metric adds, E2 = <r^2>/(2 radius^2),
    # which `curvature-lut` takes back.
    spread = float(np.sqrt(table.mean_square[0]))
    for ratio in (10.0 * spread, 20.0 * spread):
        second = 0.5 * (spread / ratio) ** 2
        assert gain(model, name, ratio) - 1.0 == pytest.approx(second, rel=0.1)


@pytest.mark.parametrize("model", [*FIRST_ORDER, "curvature-lut"])
def test_where_there_is_nothing_but_glow_it_ends_under_a_light_overhead(model: str) -> None:
    cosines = np.cos(np.linspace(np.pi, 0.0, 721))
    surface = sphere(cosines, 1e-4 * material("skin1").mean_free_path[0])
    shaded = shade(*surface, "skin1", ABOVE, model)[:, 0]
    # |S+ w_t| = sin/radius, and psi is psi(0) all over.
    np.testing.assert_allclose(shaded / shaded.max(), np.sqrt(1.0 - cosines**2), atol=1e-3)


# Share of the most by which it darkens, red, at .1, .5 and 1 l_u; none from the last size on.
DROPS = [
    ("skin1", "kolchin2007", (0.864, 0.359, 0.003), 1.2),
    ("skin1", "kolchin2007-simplified", (0.864, 0.359, 0.003), 1.2),
    ("skin1", "curvature-lut", (0.867, 0.368, 0.004), 1.2),
    ("skin1", "curvature-lut-physical", (0.714, 0.330, 0.111), 2.0),
    ("marble", "kolchin2007", (0.953, 0.765, 0.540), 5.0),
    ("marble", "kolchin2007-simplified", (0.953, 0.765, 0.540), 5.0),
    ("marble", "curvature-lut", (0.954, 0.770, 0.549), 5.0),
    ("marble", "curvature-lut-physical", (0.744, 0.373, 0.154), 2.0),
]


@pytest.mark.parametrize(("name", "model", "known", "end"), DROPS)
def test_a_glow_darkens_under_a_higher_light_where_the_radius_is_short(
    name: str, model: str, known: tuple[float, ...], end: float
) -> None:
    found = [drop(model, name, ratio) for ratio in (0.1, 0.5, 1.0)]
    np.testing.assert_allclose(found, known, atol=1e-3)
    for ratio in end * np.geomspace(1.0, 300.0, 12):
        assert drop(model, name, ratio) <= 1e-5  # psi between knots
