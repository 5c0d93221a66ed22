"""Which format a file has, by what it holds; its name is only a hint."""

import re
import struct

from app.loading.errors import BadContentError
from app.loading.formats import FORMATS, KNOWN

_OFF = re.compile(rb"(?:\s|#[^\n]*\n)*(?:ST)?C?N?4?n?OFF\b")
_OBJ = re.compile(rb"^[ \t]*v[ \t]+[-+.\d]", re.MULTILINE)
_VTK = re.compile(rb"<VTKFile\b[^>]*\btype\s*=\s*[\"']UnstructuredGrid[\"']")
_HEAD = 4096
_ZIP = b"PK\x03\x04"
_PACKED = {
    b"\x1f\x8b": "gzip",
    _ZIP: "zip",
    b"BZh": "bzip2",
    b"\xfd7zXZ": "xz",
    b"7z\xbc\xaf": "7z",
}


def sniff(content: bytes, suffix: str) -> str:
    """Return the format of a file.

    Parameters
    ----------
    content : bytes
        The whole file.
    suffix : str
        The file name's ending in lower case without the dot.

    Returns
    -------
    str
        One of `app.loading.formats.FORMATS`: that of the content if it can be told, else that of
        the name.

    Raises
    ------
    BadContentError
        If neither is known.
    """
    found = _by_content(content, suffix)
    if found:
        return found
    for magic, packer in _PACKED.items():
        if content.startswith(magic):
            raise BadContentError(f"it is a {packer} archive", "unpack it first")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise BadContentError("its text is UTF-16", "save it as UTF-8 or ASCII")
    if suffix in FORMATS:
        return suffix
    known = ", ".join(name.upper() for name in KNOWN)
    raise BadContentError(
        "it is not a mesh in a format that can be read", f"convert it to one of {known}"
    )


def _by_content(content: bytes, suffix: str) -> str | None:
    head = content[:_HEAD]
    if re.match(rb"ply\s", head):
        return "ply"
    if head.startswith(b"glTF"):
        return "glb"
    if head.startswith(b"# vtk DataFile"):
        return "vtk"
    if b"<VTKFile" in head:
        return "vtu" if _VTK.search(head) else "vtp"
    if head.startswith(_ZIP) and (suffix == "3mf" or b"3dmodel.model" in content):
        return "3mf"
    # The size proves a binary STL, whose free header may hold any word, "solid" among them.
    if len(content) > 84 and len(content) == 84 + 50 * struct.unpack_from("<I", content, 80)[0]:
        return "stl"
    if _OFF.match(head):
        return "off"
    if re.match(rb"\s*solid\b", head, re.IGNORECASE) and re.search(rb"facet|endsolid", head):
        return "stl"
    if re.match(rb"\s*\{", head) and (suffix == "gltf" or b'"asset"' in content):
        return "gltf"
    # Other text formats may have lines that begin with a v.
    if b"\0" not in head and (suffix not in FORMATS or suffix in KNOWN) and _OBJ.search(content):
        return "obj"
    return None
