"""Files packed with gzip, unpacked with a bound: a few kilobytes may hold gigabytes of zeros."""

import zlib

from app.loading.errors import BadContentError

_MAGIC = b"\x1f\x8b"
_GZIP = 31  # zlib's wbits for a gzip header and its checksum
_STEP = 1 << 20
# This much is always granted, beyond that a hundred times the file, which the most regular text
# meshes do not reach, and never more than the last.
_GRANTED, _RATIO, _MOST = 64 << 20, 100, 2 << 30


def is_packed(content: bytes) -> bool:
    """Tell whether a file is packed with gzip.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    bool
        Whether it begins as such files do.
    """
    return content.startswith(_MAGIC)


def unpacked(content: bytes) -> bytes:
    """Unpack a gzip file.

    Parameters
    ----------
    content : bytes
        The whole file; one member or several, padded with zeros or not.

    Returns
    -------
    bytes
        What it holds.

    Raises
    ------
    BadContentError
        If it is damaged, cut short, or unfolds to more than a mesh would.
    """
    most = min(max(_GRANTED, _RATIO * len(content)), _MOST)
    found = bytearray()
    rest = content
    while rest:
        member = zlib.decompressobj(wbits=_GZIP)
        waiting = rest
        while not member.eof:
            try:
                found += member.decompress(waiting, _STEP)
            except zlib.error as error:
                raise BadContentError(
                    f"its gzip data are damaged at byte {len(content) - len(waiting)} or after "
                    f"({error})"
                ) from None
            if len(found) > most:
                raise BadContentError(
                    f"it unfolds from {len(content)} bytes to more than {most}, as no mesh does",
                    "unpack it yourself if you trust it",
                )
            if not member.eof and not member.unconsumed_tail:
                raise BadContentError(
                    f"its gzip data end too early, after {len(found)} unpacked bytes"
                )
            waiting = member.unconsumed_tail
        # A tape's or a disk's last block is filled up with zeros.
        rest = member.unused_data.lstrip(b"\0")
    return bytes(found)
