"""Which formats can be read, by whom, and how each is told."""

from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path

from app.loading.guard import read_file_guarded
from app.loading.surface import RawSurface

# Told by their content.
KNOWN = ("ply", "obj", "stl", "off", "glb", "gltf", "3mf", "vtp", "vtu", "vtk")
# Told by the file name's ending, read by the package in a child process. Left out: what meshio
# reads only with packages that are not ours (XDMF, CGNS, MED, Exodus, MOAB, HMF), what holds no
# triangles (TetGen, FLAC3D, SVG), what its own writer wrote and it cannot read (UGRID), one
# that loses the vertices' order (WKT), and MeshLab's formats of points and of single programs.
MESHIO = {
    "msh": "Gmsh or Ansys Fluent",
    "mesh": "Medit",
    "meshb": "Medit, binary",
    "inp": "Abaqus",
    "avs": "AVS-UCD",
    "bdf": "Nastran",
    "fem": "Nastran",
    "nas": "Nastran",
    "vol": "Netgen",
    "post": "Permas",
    "dato": "Permas",
    "su2": "SU2",
    "dat": "Tecplot",
    "tec": "Tecplot",
    "mdpa": "Kratos",
    "xml": "DOLFIN",
}
MESHLAB = {"dae": "COLLADA", "wrl": "VRML", "x3d": "X3D", "3ds": "3D Studio", "ctm": "OpenCTM"}
FORMATS = (*KNOWN, *MESHIO, *MESHLAB)

_WITH_FILES_BESIDE = ("glb", "gltf", "obj")
_MODULES = {
    "3mf": "three_mf",
    "vtp": "vtk_guarded",
    "vtu": "vtk_guarded",
    "vtk": "vtk_guarded",
}


def reader(name: str, folder: Path) -> Callable[[bytes], RawSurface]:
    """Return what reads a format.

    Parameters
    ----------
    name : str
        One of `FORMATS`.
    folder : Path
        Where the file lies: glTF may keep its numbers, and OBJ its texture, in other files there.

    Returns
    -------
    callable
        From the file's content to its surface; raises `app.loading.errors.BadContentError`.
    """
    if name in MESHIO:
        return partial(read_file_guarded, "app.loading.meshio_child", suffix=name)
    if name in MESHLAB:
        return partial(read_file_guarded, "app.loading.meshlab_child", suffix=name)
    # Imported by name, so that a reader costs nothing until a file needs it.
    read: Callable[..., RawSurface] = import_module(f"app.loading.{_MODULES.get(name, name)}").read
    return partial(read, folder=folder) if name in _WITH_FILES_BESIDE else read
