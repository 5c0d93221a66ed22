"""The part of the estimators of other packages that calls them; runs in a child process.

Each function returns the package's own numbers, neither turned nor sorted.
"""

import numpy as np

from lutcore.arrays import AnyArray


def meshlab_directions(
    vertices: AnyArray, faces: AnyArray, method: AnyArray, scale: AnyArray
) -> dict[str, AnyArray]:
    """Run MeshLab's filter for principal directions, once for each of its two values.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.
    method : ndarray of str, shape=()
        The filter's method, by MeshLab's name.
    scale : ndarray, shape=()
        Its absolute scale, mesh units; 0 for methods that have none.

    Returns
    -------
    dict of str to ndarray
        What MeshLab calls min, max, dir1 and dir2.
    """
    import pymeshlab

    options = {"scale": pymeshlab.PureValue(float(scale))} if scale > 0.0 else {}
    found = {}
    for name, kind in (("min", "Min Curvature"), ("max", "Max Curvature")):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        # Cleaning drops vertices, so that arrays no longer fit; the mesh comes here clean.
        meshes.compute_curvature_principal_directions_per_vertex(
            method=str(method), curvcolormethod=kind, autoclean=False, **options
        )
        found[name] = meshes.current_mesh().vertex_scalar_array()
    return {
        **found,
        "dir1": meshes.current_mesh().vertex_curvature_principal_dir1_matrix(),
        "dir2": meshes.current_mesh().vertex_curvature_principal_dir2_matrix(),
    }


def meshlab_discrete(vertices: AnyArray, faces: AnyArray) -> dict[str, AnyArray]:
    """Run MeshLab's filter for discrete curvatures.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.

    Returns
    -------
    dict of str to ndarray
        What MeshLab calls mean and gauss.
    """
    import pymeshlab

    found = {}
    for name, kind in (("mean", "Mean Curvature"), ("gauss", "Gaussian Curvature")):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        meshes.compute_scalar_by_discrete_curvature_per_vertex(curvaturetype=kind)
        found[name] = meshes.current_mesh().vertex_scalar_array()
    return found


def meshlab_apss(
    vertices: AnyArray, faces: AnyArray, filter_scale: AnyArray
) -> dict[str, AnyArray]:
    """Run MeshLab's filter for curvatures of an algebraic point set surface.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.
    filter_scale : ndarray, shape=()
        Its filter scale, in units of the local spacing.

    Returns
    -------
    dict of str to ndarray
        What MeshLab calls K1 and K2.
    """
    import pymeshlab

    found = {}
    for kind in ("K1", "K2"):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        meshes.compute_curvature_and_color_apss_per_vertex(
            curvaturetype=kind, filterscale=float(filter_scale)
        )
        found[kind] = meshes.current_mesh().vertex_scalar_array()
    return found


def vtk(vertices: AnyArray, faces: AnyArray) -> dict[str, AnyArray]:
    """Run vtkCurvatures.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.

    Returns
    -------
    dict of str to ndarray
        VTK's minimum and maximum.
    """
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLogger, vtkObject, vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersGeneral import vtkCurvatures

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # it complains of each noisy vertex
    vtkObject.GlobalWarningDisplayOff()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(vertices))
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtkIdTypeArray(faces.astype(np.int64).ravel()))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    found = {}
    for name in ("Minimum", "Maximum"):
        curvatures = vtkCurvatures()
        curvatures.SetInputData(data)
        getattr(curvatures, f"SetCurvatureTypeTo{name}")()
        curvatures.Update()
        scalars = curvatures.GetOutput().GetPointData().GetScalars()
        found[name.lower()] = np.array(vtk_to_numpy(scalars))
    return found


def libigl(vertices: AnyArray, faces: AnyArray, rings: AnyArray) -> dict[str, AnyArray]:
    """Run libigl's fit of quadrics.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.
    rings : ndarray, shape=()
        Rings of neighbours to fit to.

    Returns
    -------
    dict of str to ndarray
        libigl's PV1, PV2, PD1 and its list of bad vertices.
    """
    import igl

    pd1, _, pv1, pv2, bad = igl.principal_curvature(vertices, faces.astype(np.int64), int(rings))
    return {"PV1": pv1, "PV2": pv2, "PD1": pd1, "bad": np.array(bad, np.int64)}


def trimesh(vertices: AnyArray, faces: AnyArray, radius: AnyArray) -> dict[str, AnyArray]:
    """Run trimesh's curvature measures.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.
    radius : ndarray, shape=()
        Radius of the balls, mesh units.

    Returns
    -------
    dict of str to ndarray
        The measures of mean and of Gauss curvature of the ball around each vertex.
    """
    from trimesh import Trimesh
    from trimesh.curvature import (
        discrete_gaussian_curvature_measure,
        discrete_mean_curvature_measure,
    )

    mesh = Trimesh(vertices, faces, process=False)
    return {
        "mean": discrete_mean_curvature_measure(mesh, vertices, float(radius)),
        "gauss": discrete_gaussian_curvature_measure(mesh, vertices, float(radius)),
    }
