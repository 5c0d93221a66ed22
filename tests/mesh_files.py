"""Mesh files written byte by byte, so that no library's reading of a format hides in the tests."""

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_PLY_FORMAT = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}


def grid(size: int = 5) -> tuple[Array, Array]:
    """Return the vertices (n, 3) and triangles (m, 3) of a wavy sheet, float32 exact."""
    x, y = np.meshgrid(np.arange(size, dtype=np.float64), np.arange(size, dtype=np.float64))
    vertices = np.column_stack((x.ravel(), y.ravel(), (x * y).ravel() / 8.0))
    corner = np.arange(size * size).reshape(size, size)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    quads = np.stack((a, b, c, d), axis=-1).reshape(-1, 4)
    return vertices, np.concatenate((quads[:, :3], quads[:, [0, 2, 3]]))


def rainbow(count: int) -> Array:
    """Return uint8 colours (count, 3), all different."""
    return np.random.default_rng(7).integers(0, 256, (count, 3), dtype=np.uint8)


def text_rows(table: Any) -> str:
    """Return the rows as lines of numbers."""
    return "".join(" ".join(f"{value:.9g}" for value in row) + "\n" for row in table)


def ply(
    vertices: Array,
    polygons: Any,
    colors: Array | None = None,
    order: str = "<",
    counter: str = "uchar",
) -> bytes:
    """Return a PLY file; `order` is '' for text, '<' or '>' for binary."""
    header = [
        "ply",
        f"format {_PLY_FORMAT[order]} 1.0",
        "comment by hand",
        f"element vertex {len(vertices)}",
        *(f"property float {name}" for name in "xyz"),
    ]
    if colors is not None:
        kind = "uchar" if colors.dtype == np.uint8 else "float"
        header += [f"property {kind} {name}" for name in ("red", "green", "blue")]
    header += [f"element face {len(polygons)}", f"property list {counter} int vertex_indices"]
    head = "\n".join([*header, "end_header\n"]).encode()
    if order == "":
        rows = vertices if colors is None else np.column_stack((vertices, colors))
        faces = [[len(polygon), *polygon] for polygon in polygons]
        return head + text_rows(rows).encode() + text_rows(faces).encode()
    body = b""
    for index, vertex in enumerate(vertices):
        body += struct.pack(f"{order}3f", *vertex)
        if colors is not None:
            body += colors[index].astype(colors.dtype.newbyteorder(order)).tobytes()
    code = {"uchar": "B", "int": "i"}[counter]
    for polygon in polygons:
        body += struct.pack(f"{order}{code}{len(polygon)}i", len(polygon), *polygon)
    return head + body


def obj(vertices: Array, polygons: Any, colors: Array | None = None) -> bytes:
    """Return an OBJ file."""
    rows = vertices if colors is None else np.column_stack((vertices, colors / 255.0))
    lines = ["# by hand", "o part"]
    lines += ["v " + row for row in text_rows(rows).splitlines()]
    lines += ["f " + " ".join(str(index + 1) for index in polygon) for polygon in polygons]
    return ("\n".join(lines) + "\n").encode()


def off(vertices: Array, polygons: Any, colors: Array | None = None) -> bytes:
    """Return an OFF or COFF file."""
    rows = vertices if colors is None else np.column_stack((vertices, colors))
    head = f"{'OFF' if colors is None else 'COFF'}\n# by hand\n{len(vertices)} {len(polygons)} 0\n"
    faces = [[len(polygon), *polygon] for polygon in polygons]
    return (head + text_rows(rows) + text_rows(faces)).encode()


def stl_binary(vertices: Array, faces: Array, header: bytes = b"solid by hand") -> bytes:
    """Return a binary STL file."""
    records = np.zeros(len(faces), [("normal", "<f4", 3), ("at", "<f4", (3, 3)), ("more", "<u2")])
    records["at"] = vertices[faces]
    return header.ljust(80, b"\0") + struct.pack("<I", len(faces)) + records.tobytes()


def stl_text(vertices: Array, faces: Array) -> bytes:
    """Return a text STL file."""
    text = "solid by hand\n"
    for face in faces:
        text += "  facet normal 0 0 0\n    outer loop\n"
        text += "".join(f"      vertex {row}\n" for row in text_rows(vertices[face]).splitlines())
        text += "    endloop\n  endfacet\n"
    return (text + "endsolid by hand\n").encode()


def glb(document: dict[str, Any], binary: bytes) -> bytes:
    """Return a GLB file of a JSON document and its binary data."""
    words = json.dumps({"asset": {"version": "2.0"}, **document}).encode()
    words += b" " * (-len(words) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 12 + 8 + len(words) + 8 + len(binary)
    return (
        struct.pack("<4sII", b"glTF", 2, total)
        + struct.pack("<I4s", len(words), b"JSON")
        + words
        + struct.pack("<I4s", len(binary), b"BIN\0")
        + binary
    )


def simple_glb(
    vertices: Array,
    faces: Array,
    colors: Array | None = None,
    nodes: list[dict[str, Any]] | None = None,
) -> bytes:
    """Return a GLB file of one mesh, placed by `nodes` (once, unmoved, without them)."""
    parts = [vertices.astype("<f4").tobytes(), faces.astype("<u4").tobytes()]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3"},
        {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"},
    ]
    attributes = {"POSITION": 0}
    if colors is not None:
        parts.append(colors.astype("<f4").tobytes())
        accessors.append(
            {"bufferView": 2, "componentType": 5126, "count": len(colors), "type": "VEC3"}
        )
        attributes["COLOR_0"] = 2
    starts = np.cumsum([0, *(len(part) for part in parts)])
    document = {
        "scenes": [{"nodes": list(range(len(nodes)))}] if nodes else [{"nodes": [0]}],
        "nodes": nodes or [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 1}]}],
        "accessors": accessors,
        "bufferViews": [
            {"buffer": 0, "byteOffset": int(start), "byteLength": len(part)}
            for start, part in zip(starts, parts, strict=False)
        ],
        "buffers": [{"byteLength": int(starts[-1])}],
    }
    return glb(document, b"".join(parts))


def vtp(vertices: Array, polygons: Any, colors: Array | None = None) -> bytes:
    """Return a VTP file in text."""

    def array(kind: str, name: str, values: Any, width: int = 1) -> str:
        words = " ".join(f"{value:.9g}" for value in np.ravel(values))
        return (
            f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" '
            f'format="ascii">{words}</DataArray>\n'
        )

    data = "" if colors is None else array("UInt8", "RGB", colors, 3)
    ends = np.cumsum([len(polygon) for polygon in polygons])
    return (
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n'
        f'<PolyData>\n<Piece NumberOfPoints="{len(vertices)}" NumberOfPolys="{len(polygons)}">\n'
        f"<PointData>\n{data}</PointData>\n"
        f"<Points>\n{array('Float32', 'Points', vertices, 3)}</Points>\n"
        f"<Polys>\n{array('Int64', 'connectivity', np.concatenate(polygons))}"
        f"{array('Int64', 'offsets', ends)}</Polys>\n"
        "</Piece>\n</PolyData>\n</VTKFile>\n"
    ).encode()


def one_of_each() -> dict[str, bytes]:
    """Return the same sheet in every format, by file name."""
    vertices, faces = grid()
    colors = rainbow(len(vertices))
    return {
        "text.ply": ply(vertices, faces, colors, ""),
        "little.ply": ply(vertices, faces, colors, "<"),
        "big.ply": ply(vertices, faces, colors, ">"),
        "plain.obj": obj(vertices, faces, colors),
        "plain.off": off(vertices, faces),
        "color.off": off(vertices, faces, colors),
        "binary.stl": stl_binary(vertices, faces),
        "text.stl": stl_text(vertices, faces),
        "plain.glb": simple_glb(vertices, faces, colors / 255.0),
        "plain.vtp": vtp(vertices, faces, colors),
    }
