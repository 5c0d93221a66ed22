"""Arrays at vertices, by the names scripts rely on, and the files they are saved to."""

from pathlib import Path

import numpy as np

from app.endings import unknown_ending
from app.writing import replacing
from lutcore.arrays import AnyArray, FloatArray
from lutcore.color import srgb_bytes
from lutcore.curvature import PrincipalCurvatures
from lutcore.diagnostics import vertex_scales
from lutcore.mesh import TriangleMesh

DATA_SUFFIXES = (".vtp", ".ply", ".npz", ".csv")
Arrays = dict[str, AnyArray]


def curvature_arrays(curvatures: PrincipalCurvatures, spread: FloatArray | None = None) -> Arrays:
    """Return a curvature result under its public names.

    Parameters
    ----------
    curvatures : PrincipalCurvatures
        Result of an estimator.
    spread : ndarray, shape=(n,), optional
        Disagreement of several estimators, 1/mesh unit.

    Returns
    -------
    dict of str to ndarray
        k1, k2, d1, d2, mean_curvature, gauss_curvature, shape_index, curvedness,
        curvature_error (of both together), k1_error, k2_error, in 1/mesh unit; curvature_scale, in
        mesh units; and
        curvature_disagreement where there is one.
    """
    arrays: Arrays = {
        "k1": curvatures.k1,
        "k2": curvatures.k2,
        "d1": curvatures.d1,
        "d2": curvatures.d2,
        "mean_curvature": curvatures.mean,
        "gauss_curvature": curvatures.gauss,
        "shape_index": curvatures.shape_index,
        "curvedness": curvatures.curvedness,
        "curvature_error": curvatures.error,
        "k1_error": curvatures.error1,
        "k2_error": curvatures.error2,
        "curvature_scale": vertex_scales(curvatures).copy(),
    }
    return arrays if spread is None else arrays | {"curvature_disagreement": spread}


def shading_arrays(exitance: FloatArray, exposure: float) -> Arrays:
    """Return a shading result under its public names.

    Parameters
    ----------
    exitance : ndarray, shape=(n, 3)
        Radiant exitance, linear RGB.
    exposure : float
        Factor on it before encoding.

    Returns
    -------
    dict of str to ndarray
        shading (float32, linear) and shading_srgb (uint8).
    """
    return {
        "shading": exitance.astype(np.float32),
        "shading_srgb": srgb_bytes(exitance, exposure),
    }


def save(path: Path, mesh: TriangleMesh, arrays: Arrays) -> None:
    """Write a mesh with arrays at its vertices; the format follows from the name's ending.

    Parameters
    ----------
    path : Path
        Ends in .vtp, .ply, .npz or .csv.
    mesh : TriangleMesh
        The mesh; its vertices keep their order. A .csv holds no faces.
    arrays : dict of str to ndarray
        Each of n rows.

    Raises
    ------
    ParameterError
        If the ending is another.
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    """
    writers = {".vtp": _vtp, ".ply": _ply, ".npz": _npz, ".csv": _csv}
    writer = writers.get(path.suffix.lower())
    if writer is None:
        raise unknown_ending(path, DATA_SUFFIXES)
    with replacing(path) as beside:
        writer(beside, mesh, arrays)


def _npz(path: Path, mesh: TriangleMesh, arrays: Arrays) -> None:
    np.savez_compressed(
        path, allow_pickle=False, vertices=mesh.vertices, faces=mesh.faces, **arrays
    )


def columns(arrays: Arrays) -> Arrays:
    """Return arrays of one number a vertex, vectors taken apart.

    Parameters
    ----------
    arrays : dict of str to ndarray
        Scalars and vectors of three.

    Returns
    -------
    dict of str to ndarray, shape=(n,)
        ``d1`` becomes ``d1_x``, ``d1_y``, ``d1_z``; colours end in ``_r``, ``_g``, ``_b``.
    """
    flat: Arrays = {}
    for name, array in arrays.items():
        if array.ndim == 1:
            flat[name] = array
            continue
        endings = "rgb" if name.startswith("shading") else "xyz"
        flat.update({f"{name}_{end}": array[:, i] for i, end in enumerate(endings)})
    return flat


def _csv(path: Path, mesh: TriangleMesh, arrays: Arrays) -> None:
    x, y, z = mesh.vertices.T
    table = columns({"x": x, "y": y, "z": z, **arrays})
    np.savetxt(
        path,
        np.column_stack(list(table.values())),
        fmt="%.9g",
        delimiter=",",
        header=",".join(table),
        comments="",
    )


def _ply(path: Path, mesh: TriangleMesh, arrays: Arrays) -> None:
    # Written here: VTK's writer keeps colours only, trimesh's rounds positions to single precision.
    x, y, z = mesh.vertices.T
    flat = columns({"x": x, "y": y, "z": z, **arrays})
    rename = {"shading_srgb_r": "red", "shading_srgb_g": "green", "shading_srgb_b": "blue"}
    # Positions keep their precision; what was computed is as exact in single precision.
    fields = [
        (
            rename.get(name, name),
            array.dtype
            if array.dtype == np.uint8
            else np.dtype("<f8")
            if name in ("x", "y", "z")
            else np.dtype("<f4"),
        )
        for name, array in flat.items()
    ]
    vertices = np.empty(len(mesh.vertices), dtype=fields)
    for (field, _), array in zip(fields, flat.values(), strict=True):
        vertices[field] = array
    faces = np.empty(len(mesh.faces), dtype=[("count", "u1"), ("indices", "<i4", (3,))])
    faces["count"], faces["indices"] = 3, mesh.faces
    kinds = {"<f8": "double", "<f4": "float", "|u1": "uchar"}
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property {kinds[np.dtype(kind).str]} {name}" for name, kind in fields]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    with path.open("wb") as stream:
        stream.write("\n".join([*header, "end_header", ""]).encode())
        vertices.tofile(stream)
        faces.tofile(stream)


def _vtp(path: Path, mesh: TriangleMesh, arrays: Arrays) -> None:
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    data = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)  # type: ignore[arg-type]
    data.point_data.update(arrays)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    # Into memory: on a full disk VTK's own writing ends the process.
    writer.WriteToOutputStringOn()
    writer.Write()
    path.write_text(writer.GetOutputString(), encoding="ascii")
