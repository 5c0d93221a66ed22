"""The members of a zip archive, unpacked with a bound."""

import io
import struct
import zipfile
import zlib

from app.loading.errors import BadContentError

# As of gzip: always granted; beyond that, times the archive; never more.
_GRANTED, _RATIO, _MOST = 64 << 20, 100, 2 << 30
# Other methods may ask for gigabytes before they unpack a byte, and 3MF knows these two alone.
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    OSError,
    RuntimeError,
    ValueError,
    OverflowError,
    IndexError,
    KeyError,
)


class Archive:
    """A zip archive in memory.

    Parameters
    ----------
    content : bytes
        The whole file.

    Raises
    ------
    BadContentError
        If its directory is damaged.
    """

    def __init__(self, content: bytes) -> None:
        self._left = min(max(_GRANTED, _RATIO * len(content)), _MOST)
        self._size = len(content)
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(content))
            self.names = frozenset(self._zip.namelist())
        except _BROKEN as error:
            raise BadContentError(f"its zip directory is damaged ({error})") from None

    def get(self, name: str) -> bytes:
        """Return one member.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        bytes
            What it holds.

        Raises
        ------
        BadContentError
            If it is not there, damaged, encrypted, or unfolds to more than a mesh would, all
            members together.
        """
        if name not in self.names:
            raise BadContentError(f"its archive has no part {name[:80]!r}")
        info = self._zip.getinfo(name)
        if info.compress_type not in _METHODS:
            raise BadContentError(
                f"{name} is packed by method {info.compress_type}", "save it with another program"
            )
        if info.flag_bits & 1:
            raise BadContentError(f"{name} is encrypted", "save it without a password")
        try:
            with self._zip.open(info) as member:
                # What is said of its size may be wrong: what comes out is counted.
                found = member.read(self._left + 1)
        except _BROKEN as error:
            raise BadContentError(f"{name} in its archive is damaged ({error})") from None
        if len(found) > self._left:
            raise BadContentError(
                f"its {self._size} bytes unfold to more than {max(_GRANTED, len(found))}, as no "
                "mesh does",
                "unpack it yourself if you trust it",
            )
        self._left -= len(found)
        return found
