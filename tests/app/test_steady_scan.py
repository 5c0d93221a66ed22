"""The laser scan, its vertices moved by a hundredth of their edges: what curvature makes of it."""

import numpy as np

from app.chart.perturbation import perturbation
from app.loading import load_mesh
from app.samples import sample
from lutcore.estimation import principal_curvatures

# What was asked of a steady estimate; three seeds gave .0136 to .0148.
STEADY = 0.015


def test_a_steady_estimate_of_the_scan_hardly_changes_and_holds_every_vertex():
    mesh = load_mesh(sample("marble-face-raw").path).mesh
    still, moved = (
        principal_curvatures(one, "auto", steadiness=300.0)
        for one in (mesh, perturbation(mesh, 0.01)(0))
    )
    assert still.k1.shape == still.k2.shape == (85_849,)
    used = np.unique(mesh.faces)
    before = np.stack([still.k1, still.k2])[:, used]
    after = np.stack([moved.k1, moved.k2])[:, used]
    assert np.isfinite(before).all()
    assert np.isfinite(after).all()
    change = np.sqrt(np.mean((after - before) ** 2)) / np.median(np.abs(before))
    assert change < STEADY
