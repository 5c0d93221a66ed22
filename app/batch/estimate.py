"""How long a batch will take and how much disk, by drawing two samples as the job draws meshes."""

import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
from msgspec.structs import replace

from app.batch.crew import Crew, environment
from app.batch.ledger import files_of, thumbnail
from app.batch.plan import Item
from app.batch.task import Task
from app.samples import PREFIX, sample
from app.volume import source_of
from lutcore.isolated import IsolatedError

# Bytes of a file for each triangle, where text or doubled vertices make it more than in a binary
# PLY; halves and doubles cancel in a batch.
_BYTES = {".stl": 50.0, ".obj": 55.0, ".off": 45.0, ".vtp": 40.0}
_BINARY = 20.0
_SMALL, _LARGE = "sample:sphere", "sample:marble-face"


@dataclass(frozen=True)
class Estimate:
    """What meshes will take.

    Parameters
    ----------
    seconds : tuple of float
        Of one worker, for each mesh.
    bytes : int
        Of all results.
    """

    seconds: tuple[float, ...]
    bytes: int


@dataclass(frozen=True)
class _Rate:
    """Seconds of one mesh: so many, and so many for each triangle."""

    base: float
    each: float
    bytes: float


def estimate(items: Sequence[Item], jobs: int) -> Estimate:
    """Estimate what a batch will take, by a trial of a few seconds.

    Parameters
    ----------
    items : sequence of Item
        The meshes; their files are not read.
    jobs : int
        Meshes that are drawn at once.

    Returns
    -------
    Estimate
        Good to a factor of about two: triangles are told from the size of a file.

    Raises
    ------
    IsolatedError
        If the trial fails.
    """
    crew = Crew(environment(jobs, False))
    rates: dict[bytes, _Rate] = {}
    seconds, total = [], 0.0
    try:
        for item in items:
            works = [(one.output, replace(one.session, mesh="")) for one in item.works]
            key = msgspec.json.encode(works)
            if key not in rates:
                rates[key] = _rate(item, crew)
            rate = rates[key]
            seconds.append(rate.base + rate.each * triangles(item.mesh))
            total += rate.bytes
    finally:
        crew.stop()
    return Estimate(tuple(seconds), int(total))


def triangles(mesh: str) -> float:
    """Return about how many triangles a mesh has.

    Parameters
    ----------
    mesh : str
        A path, ``sample:NAME`` or an address.

    Returns
    -------
    float
        From the size of its files; 0 where they cannot be seen.
    """
    path = sample(mesh).path if mesh.startswith(PREFIX) else Path(mesh)
    try:
        size = sum(file.stat().st_size for file in source_of(path).files)
    except OSError:
        return 0.0
    return size / _BYTES.get(path.suffix.lower(), _BINARY)


def _rate(item: Item, crew: Crew) -> _Rate:
    _trial(item, _SMALL, crew)  # loads what every mesh needs
    few, faces_few, held = _trial(item, _SMALL, crew)
    many, faces_many, held_more = _trial(item, _LARGE, crew)
    each = max(0.0, (many - few) / (faces_many - faces_few))
    return _Rate(max(0.0, few - each * faces_few), each, (held + held_more) / 2.0)


def _trial(item: Item, mesh: str, crew: Crew) -> tuple[float, int, int]:
    """Return seconds, triangles and bytes of results of one sample."""
    folder = Path(tempfile.mkdtemp(prefix="curvelight-"))
    works = tuple(
        replace(one, session=replace(one.session, mesh=mesh, scale=None)) for one in item.works
    )
    try:
        task = Task(works, str(folder), str(folder), thumbnail("trial"))
        told = crew.do(task, item.seconds, item.memory_gib)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if told["problems"]:
        raise IsolatedError(f"a trial with {mesh} failed: {told['problems'][0]['message']}")
    seconds = sum(one["seconds"] for one in told["outputs"])
    return seconds, told["faces"], sum(one["bytes"] for one in files_of(told))
