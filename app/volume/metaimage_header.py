"""The header of a MetaImage: lines of ``Key = value``, the last of which says where the data are.

Format: https://docs.itk.org/en/latest/learn/metaio.html (read there, written here).
"""

import re
from pathlib import Path

from app.loading.errors import BadContentError

KEY = re.compile(rb"\s*(ObjectType|NDims|Comment|ID|Name)\s*=")
_LONGEST = 1 << 16
_LAST = re.compile(rb"^ElementDataFile[ \t]*=[ \t]*([^\r\n]*)\r?\n?", re.MULTILINE)


def header(content: bytes) -> tuple[dict[str, str], int]:
    """Split the header into its fields.

    Parameters
    ----------
    content : bytes
        The beginning of the file.

    Returns
    -------
    dict of str to str
        Values by key.
    int
        Where what follows the header begins.

    Raises
    ------
    BadContentError
        If it has no end.
    """
    last = _LAST.search(content[:_LONGEST])
    if last is None:
        raise BadContentError("its header names no ElementDataFile")
    lines = content[: last.end()].decode("utf-8", "surrogateescape").splitlines()
    pairs = (line.partition("=") for line in lines)
    return {key.strip(): value.strip() for key, _, value in pairs}, last.end()


def data_files(path: Path, content: bytes) -> tuple[Path, ...]:
    """Return the files beside the header that hold the voxels.

    Parameters
    ----------
    path : Path
        The header's file.
    content : bytes
        The beginning of the file.

    Returns
    -------
    tuple of Path
        None where the data follow the header, or where it does not say.
    """
    try:
        name = header(content)[0]["ElementDataFile"]
    except BadContentError:
        return ()
    if name == "LOCAL" or not name or "\0" in name or name.startswith("LIST") or "%" in name:
        return ()
    return (path.parent / name,)
