"""What other packages tell becomes ours, however odd it is."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lutcore import analytic
from plugins.curvature._completed import completed


@pytest.mark.parametrize("length", [0.0, 5e-324, 3e-323, 1e-300, 1e-40, 1.0, 1e200, np.inf, np.nan])
def test_directions_of_any_length_become_unit_vectors(length):
    mesh = analytic.saddle(100, k=(0.0, 0.0)).mesh
    flat = np.zeros(len(mesh.vertices))
    along = np.full((len(flat), 3), length) * [0.6, 0.8, 0.1]
    found = completed(mesh, flat, flat, along=along)
    for direction in (found.d1, found.d2):
        assert_allclose(np.linalg.norm(direction, axis=1), 1.0, atol=1e-12)
    assert_allclose(np.cross(found.d1, found.d2), found.normals, atol=1e-12)
