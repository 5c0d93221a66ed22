"""Files of the rarer formats, written byte by byte like those of `tests.mesh_files`."""

import base64
import gzip
import io
import json
import struct
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from tests.mesh_files import Array, grid, ply, rainbow, simple_glb, stl_text, text_rows

MODEL = "3D/3dmodel.model"
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
# What meshio writes of its formats; the hand that wrote them matters less than that they are valid.
MESHIO_TYPES = {
    "gmsh.msh": "gmsh",
    "ansys.msh": "ansys",
    "plain.mesh": "medit",
    "plain.meshb": "medit",
    "plain.inp": "abaqus",
    "plain.avs": "avsucd",
    "plain.bdf": "nastran",
    "plain.vol": "netgen",
    "plain.post": "permas",
    "plain.tec": "tecplot",
    "plain.mdpa": "mdpa",
    "plain.xml": "dolfin-xml",
}


def packed(content: bytes) -> bytes:
    """Return a gzip file, the same for the same content."""
    return gzip.compress(content, mtime=0)


def gltf(content: bytes, uri: str | None = None) -> bytes:
    """Return a GLB file as glTF, its data embedded or, with `uri`, in another file."""
    (length,) = struct.unpack_from("<I", content, 12)
    document = json.loads(content[20 : 20 + length])
    data = base64.b64encode(content[28 + length :]).decode()
    document["buffers"][0]["uri"] = uri or f"data:application/octet-stream;base64,{data}"
    return json.dumps(document).encode()


def model_object(vertices: Array, faces: Array, name: int = 1) -> str:
    """Return a 3MF object with triangles."""
    points = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>\n' for x, y, z in vertices)
    rows = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>\n' for a, b, c in faces)
    return (
        f'<object id="{name}" type="model"><mesh>\n<vertices>\n{points}</vertices>\n'
        f"<triangles>\n{rows}</triangles>\n</mesh></object>\n"
    )


def model(objects: str, items: str, unit: str = "millimeter", prolog: str = "") -> str:
    """Return the XML of a 3MF model."""
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>{prolog}\n<model unit="{unit}" xmlns="{_CORE}" '
        'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">\n'
        f"<resources>{objects}</resources>\n<build>{items}</build>\n</model>\n"
    )


def three_mf(parts: dict[str, Any], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return a zip archive of named parts, the same for the same parts."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as archive:
        for name, content in parts.items():
            archive.writestr(zipfile.ZipInfo(name), content, method)
    return out.getvalue()


def simple_three_mf(vertices: Array, faces: Array, method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return a 3MF file of one object."""
    text = model(model_object(vertices, faces), '<item objectid="1"/>')
    return three_mf({MODEL: text}, method)


def vtk_legacy(vertices: Array, polygons: Any, binary: bool = False) -> bytes:
    """Return a legacy VTK file of poly data."""
    size = sum(len(polygon) + 1 for polygon in polygons)
    head = f"# vtk DataFile Version 3.0\nby hand\n{'BINARY' if binary else 'ASCII'}\n"
    head += f"DATASET POLYDATA\nPOINTS {len(vertices)} float\n"
    middle = f"\nPOLYGONS {len(polygons)} {size}\n"
    rows = [[len(polygon), *polygon] for polygon in polygons]
    if not binary:
        return (head + text_rows(vertices) + middle + text_rows(rows)).encode()
    cells = np.concatenate(rows).astype(">i4").tobytes()
    return head.encode() + vertices.astype(">f4").tobytes() + middle.encode() + cells + b"\n"


def vtu(vertices: Array, faces: Array) -> bytes:
    """Return a VTU file in text."""

    def array(kind: str, name: str, values: Any, width: int = 1) -> str:
        words = " ".join(f"{value:.9g}" for value in np.ravel(values))
        return (
            f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" '
            f'format="ascii">{words}</DataArray>\n'
        )

    return (
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
        f'byte_order="LittleEndian">\n<UnstructuredGrid>\n<Piece NumberOfPoints="{len(vertices)}" '
        f'NumberOfCells="{len(faces)}">\n<Points>\n{array("Float32", "Points", vertices, 3)}'
        f"</Points>\n<Cells>\n{array('Int64', 'connectivity', faces)}"
        f"{array('Int64', 'offsets', np.arange(3, 3 * len(faces) + 1, 3))}"
        f"{array('UInt8', 'types', np.full(len(faces), 5))}</Cells>\n"
        "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    ).encode()


def vtp_packed(vertices: Array, faces: Array) -> bytes:
    """Return a VTP file as VTK writes it: packed, appended, in base64."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    points, cells, data, writer = vtkPoints(), vtkCellArray(), vtkPolyData(), vtkXMLPolyDataWriter()
    points.SetData(numpy_to_vtk(vertices.astype(np.float32), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(faces.ravel()), deep=True))
    data.SetPoints(points)
    data.SetPolys(cells)
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    writer.Write()
    return writer.GetOutputString().encode()


def dae(vertices: Array, faces: Array) -> bytes:
    """Return a COLLADA file."""
    points = " ".join(f"{value:.9g}" for value in vertices.ravel())
    corners = " ".join(str(corner) for corner in faces.ravel())
    return (
        '<?xml version="1.0"?>\n<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" '
        'version="1.4.1">\n<library_geometries><geometry id="g" name="g"><mesh>\n'
        f'<source id="p"><float_array id="pa" count="{vertices.size}">{points}</float_array>'
        f'<technique_common><accessor source="#pa" count="{len(vertices)}" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/>'
        '<param name="Z" type="float"/></accessor></technique_common></source>\n'
        '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>\n'
        f'<triangles count="{len(faces)}"><input offset="0" semantic="VERTEX" source="#v"/>'
        f"<p>{corners}</p></triangles>\n</mesh></geometry></library_geometries>\n"
        '<library_visual_scenes><visual_scene id="s"><node id="n">'
        '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>\n'
        '<scene><instance_visual_scene url="#s"/></scene>\n</COLLADA>\n'
    ).encode()


def _index_list(faces: Array) -> str:
    return " ".join(f"{a} {b} {c} -1" for a, b, c in faces)


def wrl(vertices: Array, faces: Array) -> bytes:
    """Return a VRML 2 file."""
    points = ", ".join(f"{x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices)
    return (
        "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [ "
        f"{points} ] }} coordIndex [ {_index_list(faces)} ] }} }}\n"
    ).encode()


def x3d(vertices: Array, faces: Array) -> bytes:
    """Return an X3D file."""
    points = " ".join(f"{value:.9g}" for value in vertices.ravel())
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<X3D profile="Interchange" version="3.0">\n'
        f'<Scene><Shape><IndexedFaceSet coordIndex="{_index_list(faces)}">'
        f'<Coordinate point="{points}"/></IndexedFaceSet></Shape></Scene>\n</X3D>\n'
    ).encode()


def three_ds(vertices: Array, faces: Array) -> bytes:
    """Return a 3D Studio file."""

    def chunk(name: int, body: bytes) -> bytes:
        return struct.pack("<HI", name, 6 + len(body)) + body

    corners = np.zeros((len(faces), 4), "<u2")
    corners[:, :3] = faces
    points = struct.pack("<H", len(vertices)) + vertices.astype("<f4").tobytes()
    rows = struct.pack("<H", len(faces)) + corners.tobytes()
    mesh = chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, rows))
    editor = chunk(0x3D3D, chunk(0x3D3E, struct.pack("<I", 3)) + chunk(0x4000, b"part\0" + mesh))
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)) + editor)


def ctm(vertices: Array, faces: Array) -> bytes:
    """Return an OpenCTM file, not packed."""
    head = struct.pack("<4si4siiiii", b"OCTM", 5, b"RAW\0", len(vertices), len(faces), 0, 0, 0)
    return (
        head
        + struct.pack("<i", 0)
        + b"INDX"
        + faces.astype("<u4").tobytes()
        + b"VERT"
        + vertices.astype("<f4").tobytes()
    )


def written_by_meshio() -> dict[str, bytes]:
    """Return the sheet in the formats of meshio, by file name."""
    import meshio

    mesh = meshio.Mesh(grid()[0], [("triangle", grid()[1])])
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, kind in MESHIO_TYPES.items():
            meshio.write(Path(folder) / name, mesh, file_format=kind)
            found[name] = (Path(folder) / name).read_bytes()
    return found


def in_process() -> dict[str, bytes]:
    """Return the sheet in the rarer formats that are read without a child process."""
    vertices, faces = grid()
    colors = rainbow(len(vertices))
    glb = simple_glb(vertices, faces, colors / 255.0)
    return {
        "plain.gltf": gltf(glb),
        "plain.3mf": simple_three_mf(vertices, faces),
        "stored.3mf": simple_three_mf(vertices, faces, zipfile.ZIP_STORED),
        "binary.ply.gz": packed(ply(vertices, faces, colors, "<")),
        "text.stl.gz": packed(stl_text(vertices, faces)),
    }


def in_child() -> dict[str, bytes]:
    """Return the sheet in the rarer formats that are read in a child process."""
    vertices, faces = grid()
    return {
        "packed.vtp": vtp_packed(vertices, faces),
        "plain.vtu": vtu(vertices, faces),
        "text.vtk": vtk_legacy(vertices, faces),
        "binary.vtk": vtk_legacy(vertices, faces, binary=True),
        "plain.dae": dae(vertices, faces),
        "plain.wrl": wrl(vertices, faces),
        "plain.x3d": x3d(vertices, faces),
        "plain.3ds": three_ds(vertices, faces),
        "plain.ctm": ctm(vertices, faces),
        **written_by_meshio(),
    }
