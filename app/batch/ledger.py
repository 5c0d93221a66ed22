"""What is known of finished meshes: one record each, written before its results are.

A run that is killed at any moment leaves a record with whole results, in their places or still
pending, or none: then nothing of that mesh is a result yet.
"""

import json
import time
from functools import cache
from pathlib import Path
from typing import Any

import msgspec
from msgspec.structs import replace

from app.batch.plan import Item
from app.batch.store import HIDDEN, Folder, Store, digest
from app.samples import PREFIX, sample
from app.session import Session
from app.versions import versions
from app.volume import source_of

Record = dict[str, Any]
"""One mesh as plain data; a line of ``batch.jsonl``."""
DONE = "done"
LINES = "batch.jsonl"
_BREATH = 5.0  # seconds between two writings of it


def content_of(mesh: str) -> str:
    """Return what tells a mesh's content from others.

    Parameters
    ----------
    mesh : str
        A path of this machine, or ``sample:NAME``.

    Returns
    -------
    str
        SHA-256 of all its files, hexadecimal; empty where they cannot be read.
    """
    path = sample(mesh).path if mesh.startswith(PREFIX) else Path(mesh)
    try:
        digests = [digest(file.read_bytes()) for file in source_of(path).files]
    except OSError:
        return ""
    return digests[0] if len(digests) == 1 else digest("".join(digests).encode())


def key_of(item: Item, content: str) -> str:
    """Return what a mesh's results depend on, in a word.

    Parameters
    ----------
    item : Item
        Its sessions and the names of its results count, its number and limits do not.
    content : str
        See `content_of`.

    Returns
    -------
    str
        Another one if the mesh, a session, a name or the version of a package changes.
    """
    works = [
        (work.output, work.file, replace(work.session, mesh=""), _versions(work.session))
        for work in item.works
    ]
    return digest(msgspec.json.encode((content, works), order="sorted"))[:32]


def _versions(session: Session) -> dict[str, str]:
    return _versions_of(msgspec.json.encode(replace(session, mesh="")))


@cache
def _versions_of(session: bytes) -> dict[str, str]:
    return versions(msgspec.json.decode(session, type=Session))


def finished(store: Store, key: str) -> Record | None:
    """Return the record of a mesh whose results are all there and as they were written.

    Parameters
    ----------
    store : Store
        Where they lie.
    key : str
        See `key_of`.

    Returns
    -------
    dict or None
        None if it has to be drawn. Results that a killed run left pending are put in their places.
    """
    content = store.read(_name(key))
    if content is None:
        return None
    try:
        record: Record = json.loads(content)
        files = [(one["file"], one["sha256"]) for one in files_of(record)]
        if record["reason"] != DONE:
            return None
    except (ValueError, KeyError, TypeError):
        return None  # of another version: drawn again
    return record if all(_there(store, key, name, sha) for name, sha in files) else None


def _there(store: Store, key: str, name: str, sha: str) -> bool:
    content = store.read(name)
    if content is not None and digest(content) == sha:
        return True
    if not isinstance(store, Folder):
        return False
    pending = store.unsettled(key)
    left = store.read(str((pending / name).relative_to(store.root)))
    if left is None or digest(left) != sha:
        return False
    store.settle(pending, name)
    return True


def publish(store: Store, record: Record, pending: Path) -> None:
    """Keep a mesh's record, then put its results in their places.

    Parameters
    ----------
    store : Store
        Where to.
    record : dict
        What is known of it, its ``key`` included.
    pending : Path
        Where the results were drawn.
    """
    store.write(_name(record["key"]), json.dumps(record, indent=1).encode() + b"\n")
    for one in files_of(record):
        store.settle(pending, one["file"])
    small = thumbnail(record["key"])
    if (pending / small).exists():
        store.settle(pending, small)
    store.leave(pending)


def files_of(record: Record) -> list[dict[str, Any]]:
    """Return the files of a record.

    Parameters
    ----------
    record : dict
        Of a mesh.

    Returns
    -------
    list of dict
        ``file``, ``sha256`` and ``bytes`` of each.
    """
    return [file for output in record.get("outputs", []) for file in output["files"]]


class Lines:
    """The file of one JSON line for each mesh: whole whenever somebody looks.

    Parameters
    ----------
    store : Store
        Where it lies.
    """

    def __init__(self, store: Store) -> None:
        self.records: list[Record] = []
        self._store = store
        self._next = time.monotonic() + _BREATH

    def add(self, record: Record) -> None:
        """Take a record in; the file follows now and then.

        Parameters
        ----------
        record : dict
            Of a mesh.
        """
        self.records.append(record)
        start = time.monotonic()
        if start > self._next:
            self.write()
            # A long file takes long to write: it may cost a hundredth of the time.
            self._next = time.monotonic() + max(_BREATH, 100.0 * (time.monotonic() - start))

    def write(self) -> None:
        """Write all lines, in the job's order."""
        self.records.sort(key=lambda record: record["n"])
        self._store.write(LINES, "".join(f"{line(one)}\n" for one in self.records).encode())


def line(record: Record) -> str:
    """Return a record as one line of JSON.

    Parameters
    ----------
    record : dict
        Of a mesh.

    Returns
    -------
    str
        Without a line break.
    """
    return json.dumps(record, allow_nan=False)


def thumbnail(key: str) -> str:
    """Return where a small copy of a mesh's first picture lies.

    Parameters
    ----------
    key : str
        See `key_of`.

    Returns
    -------
    str
        A name in the output folder; there is none where nothing was drawn.
    """
    return f"{HIDDEN}/thumbnails/{key}.png"


def _name(key: str) -> str:
    return f"{HIDDEN}/records/{key}.json"
