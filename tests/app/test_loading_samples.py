"""Valid files: what the installed packages ship must all be read."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from app.loading import load_mesh
from app.loading.formats import KNOWN
from lutcore.errors import MeshError

PACKAGES = ("pyvista", "pymeshlab", "trimesh", "skimage", "meshio", "vtkmodules", "sample_meshes")
# VTK's data of kinds that have no triangles: grids of cells in space.
NO_SURFACE = {"hexbeam.vtk", "rectilinear.vtk", "uniform.vtk"}


def shipped():
    found = []
    for package in PACKAGES:
        spec = importlib.util.find_spec(package)
        if spec is None or spec.origin is None:
            continue
        paths = sorted(Path(spec.origin).parent.rglob("*"))
        found += [path for path in paths if path.suffix[1:].lower() in KNOWN]
    return found


FILES = shipped()


def test_there_are_samples_of_several_packages():
    assert len({path.parent for path in FILES}) >= 3
    assert len(FILES) >= 15


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_sample_is_read(path):
    if path.name in NO_SURFACE:
        with pytest.raises(MeshError, match=r"volumes|no triangles"):
            load_mesh(path)
        return
    loaded = load_mesh(path)
    assert np.isfinite(loaded.mesh.vertices).all()
    if path.suffix == ".ply":
        text = path.read_bytes()[:2000].split()
        assert len(loaded.mesh.vertices) == int(text[text.index(b"vertex") + 1])
