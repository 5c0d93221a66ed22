"""Where a glTF file has its numbers: in the GLB itself, in a data URI, or in a file beside it."""

import binascii
import stat
from pathlib import Path
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

from app.loading.errors import BadContentError

_BESIDE = "put the file that it names beside it, or export it as one self-contained GLB file"


class Buffers:
    """The binary data of one file, read when first asked for.

    Parameters
    ----------
    document : dict
        The file's JSON.
    content_size : int
        Bytes of the file.
    folder : Path
        Where it lies. No file outside this folder is opened.
    binary : bytes or None
        The binary chunk of a GLB file.
    """

    def __init__(
        self,
        document: dict[str, Any],
        content_size: int,
        folder: Path,
        binary: bytes | None = None,
    ) -> None:
        self._document = document
        self._content_size = content_size
        self._folder = folder
        self._binary = binary
        self._read: dict[int, bytes] = {}
        self._files: dict[Path, bytes] = {}

    @property
    def others(self) -> list[bytes]:
        """What was read from other files."""
        return list(self._files.values())

    @property
    def size(self) -> int:
        """Bytes of the file and of those that it names, as far as they are there."""
        named: set[Path] = set()
        for buffer in self._document.get("buffers", []):
            uri = buffer.get("uri")
            if isinstance(uri, str) and not _is_data(uri):
                try:
                    named.add(self._path(uri))
                except BadContentError:  # said when the data are needed
                    continue
        return self._content_size + sum(path.stat().st_size for path in named)

    def get(self, index: int) -> bytes:
        """Return the data of one buffer.

        Parameters
        ----------
        index : int
            Its number.

        Returns
        -------
        bytes
            As many as it says at least.

        Raises
        ------
        BadContentError
            If they are not there or too few, or the file that holds them lies elsewhere.
        """
        if index not in self._read:
            self._read[index] = self._found(index)
        return self._read[index]

    def _found(self, index: int) -> bytes:
        buffers = self._document.get("buffers", [])
        if not isinstance(index, int) or not 0 <= index < len(buffers):
            raise BadContentError(f"it refers to number {index} of its {len(buffers)} buffers")
        uri = buffers[index].get("uri")
        if uri is None:
            if index == 0 and self._binary is not None:
                return self._binary
            raise BadContentError(f"buffer {index} has no data")
        if not isinstance(uri, str):
            raise BadContentError(f"buffer {index} has a 'uri' that is no text")
        return self.named(uri, f"buffer {index}")

    def named(self, uri: str, what: str) -> bytes:
        """Return what a URI holds: data, or a file in the folder.

        Parameters
        ----------
        uri : str
            As the document has it.
        what : str
            What it is of, for messages.

        Returns
        -------
        bytes
            The data.

        Raises
        ------
        BadContentError
            If they are not there, or lie elsewhere.
        """
        if _is_data(uri):
            return _embedded(uri, what)
        path = self._path(uri)
        if path not in self._files:
            try:
                self._files[path] = path.read_bytes()
            except OSError as error:
                raise BadContentError(f"{path.name} cannot be read ({error.strerror})") from None
        return self._files[path]

    def _path(self, uri: str) -> Path:
        shown = uri[:80].encode("ascii", "backslashreplace").decode()
        if "://" in uri or ":" in uri.split("/", 1)[0] or "\\" in uri or "\0" in unquote(uri):
            raise BadContentError(f"its data lie in another place, {shown!r}", _BESIDE)
        folder = self._folder.resolve()
        try:
            path = (folder / unquote(uri)).resolve()
            if not path.is_relative_to(folder):
                raise BadContentError(f"its data lie outside its folder, in {shown!r}", _BESIDE)
            regular = stat.S_ISREG(path.stat().st_mode)
        except (OSError, RuntimeError, ValueError):
            raise BadContentError(
                f"its data lie in another file, {shown!r}, which is not there", _BESIDE
            ) from None
        if not regular:
            raise BadContentError(f"its data lie in {shown!r}, which is no file", _BESIDE)
        return path


def _is_data(uri: str) -> bool:
    return uri[:5].lower() == "data:"


def _embedded(uri: str, what: str) -> bytes:
    head, comma, data = uri[5:].partition(",")
    if not comma:
        raise BadContentError(f"the data URI of {what} has no comma")
    raw = unquote_to_bytes(data)
    if not head.lower().endswith(";base64"):
        return raw
    try:
        return binascii.a2b_base64(raw)
    except binascii.Error as error:
        raise BadContentError(f"the data URI of {what} is no base64 ({error})") from None
