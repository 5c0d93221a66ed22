import numpy as np
import pytest

from app.loading.checks import checked
from app.loading.errors import BadContentError
from app.loading.surface import RawSurface
from tests.mesh_files import grid

VERTICES, FACES = grid()


@pytest.mark.parametrize(
    ("vertices", "corners", "counts"),
    [
        (np.zeros((3, 2)), np.arange(3), np.array([3])),
        (np.zeros((3, 3)), np.arange(3), np.array([3, 3])),
        (np.zeros((3, 3)), np.arange(3), np.array([2])),
    ],
)
def test_arrays_of_a_reader_that_do_not_fit_together_are_refused(vertices, corners, counts):
    with pytest.raises(BadContentError, match="do not fit together"):
        checked(RawSurface(vertices, corners, counts))


def test_colours_that_do_not_fit_the_vertices_are_left_out_aloud():
    surface = RawSurface(VERTICES, FACES.ravel(), np.full(len(FACES), 3), np.zeros((4, 3)))
    assert checked(surface)[1] is None
    assert "colours do not fit" in surface.warnings[0]
