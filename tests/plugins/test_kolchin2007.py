"""The paper's two forms, against quadrature of its double integral."""

import numpy as np
import pytest

from lutcore.diffusion import optics
from lutcore.exitance import shade
from lutcore.fresnel import mean_transmittance
from lutcore.lights import DirectionalLight
from lutcore.materials import material
from tests.quadrature import paper_factor
from tests.surfaces import sphere, torus


@pytest.mark.parametrize("vertex", [7, 40, 61, 93])
def test_full_and_simplified_form_are_eq_11(vertex: int) -> None:
    mesh, curvatures = torus(100)
    light = DirectionalLight((0.5, -0.7, 0.4), 1.5)
    w = np.asarray(light.direction)
    full = shade(mesh, curvatures, "skin1", [light], "kolchin2007")[vertex]
    simplified = shade(mesh, curvatures, "skin1", [light], "kolchin2007-simplified")[vertex]
    k1, k2 = max(curvatures.k1[vertex], 0.0), max(curvatures.k2[vertex], 0.0)
    w1, w2 = curvatures.d1[vertex] @ w, curvatures.d2[vertex] @ w
    w3 = float(curvatures.normals[vertex] @ w)
    exact = float(np.hypot(w1 * k1, w2 * k2))
    rough = float(np.sqrt((1.0 - w3**2) * (k1**2 + k2**2) / 2.0))
    for channel, constants in enumerate(optics(material("skin1"))):
        length = material("skin1").mean_free_path[channel]
        for value, kappa in ((full[channel], exact), (simplified[channel], rough)):
            truth = 1.5 * mean_transmittance(1.3) * paper_factor(w3, length * kappa, constants)
            # 64 samples: b dpsi < .16 x 1e-6.
            assert value == pytest.approx(truth, abs=2e-7)


def test_both_are_the_same_on_a_sphere() -> None:
    surface = sphere(np.linspace(-1.0, 1.0, 101), 4.0)
    light = [DirectionalLight((0.1, 0.5, 0.6))]
    np.testing.assert_allclose(
        shade(*surface, "skin1", light, "kolchin2007"),
        shade(*surface, "skin1", light, "kolchin2007-simplified"),
        rtol=0.0,
        # |w_t| and sqrt(1 - w3^2) differ by the root of a rounding where both vanish.
        atol=1e-8,
    )


def test_a_ridge_glows_across_but_not_along() -> None:
    mesh, curvatures = torus(10000, major=1e6)
    side = np.argmin(np.abs(curvatures.normals @ [0.0, 0.0, 1.0]))
    across = DirectionalLight((0.0, 0.0, 1.0))
    along = DirectionalLight(curvatures.d2[side])
    lambert = shade(mesh, curvatures, "skin1", [across], "lambert")[side]
    glow = shade(mesh, curvatures, "skin1", [across], "kolchin2007")[side]
    none = shade(mesh, curvatures, "skin1", [along], "kolchin2007")[side]
    assert (glow > lambert + 1e-3).all()
    # The tube itself bends with 1/1e6.
    assert (none < 1e-6).all()
