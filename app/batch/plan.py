"""From a job to a list: every mesh, its sessions, and the name of every result."""

import glob
import os
from collections.abc import Iterable
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

from msgspec import Struct

from app.batch.framing import session_of
from app.batch.job import Block, Fields, Job, Variation
from app.batch.template import filled
from app.samples import PREFIX
from app.session import Session
from lutcore.errors import ParameterError

RESERVED = ("batch.jsonl", "summary.csv", "summary.parquet", "index.html", "contact.png")
"""Names that the batch itself gives in its folder."""
_ENDINGS = {"report": (".html", ".session.json")}
_PICTURE = (".png",)


class Work(Struct, frozen=True):
    """One result.

    Parameters
    ----------
    output : str
        Of `app.batch.job.OUTPUTS`.
    variation : str
        Name of the job's session.
    session : Session
        What is drawn.
    file : str
        Its path inside the output folder, with slashes; a report's session lies beside it.
    """

    output: str
    variation: str
    session: Session
    file: str

    @property
    def files(self) -> tuple[str, ...]:
        """All files that it writes."""
        stem = self.file.removesuffix(_endings(self.output)[0])
        return tuple(stem + ending for ending in _endings(self.output))


class Item(Struct, frozen=True):
    """One mesh with all that is drawn of it: what one child process does in one go.

    Parameters
    ----------
    n : int
        Its number in the job, from 1.
    mesh : str
        An absolute path, ``sample:NAME`` or an address.
    works : tuple of Work
        What is drawn.
    seconds, memory_gib : float
        What it may take.
    """

    n: int
    mesh: str
    works: tuple[Work, ...]
    seconds: float
    memory_gib: float

    @property
    def name(self) -> str:
        """What it is called in a line."""
        return self.mesh if self.mesh.startswith(PREFIX) else PurePosixPath(self.mesh).name


def planned(job: Job, overrides: Fields) -> tuple[list[Item], list[str]]:
    """Return what a job comes to.

    Parameters
    ----------
    job : Job
        See `app.batch.job`.
    overrides : dict
        Fields of a session that stand above all that the job says.

    Returns
    -------
    items : list of Item
        One for each mesh, in the job's order.
    remarks : list of str
        What is odd about the job.

    Raises
    ------
    ParameterError
        If a pattern matches nothing, a plug-in or material does not exist, or two results have
        one name.
    """
    meshes = _expanded(job)
    template = job.template or (
        "{stem}-{session}-{output}" if len(job.sessions) > 1 else "{stem}-{output}"
    )
    items = [_item(job, n, mesh, template, overrides) for n, mesh in enumerate(meshes, 1)]
    _check_names(items, template)
    _check_sessions(items)
    unused = [
        f"{job.label}: [[blocks]] {n} matches no mesh ({', '.join(block.match)})"
        for n, block in enumerate(job.blocks, 1)
        if not any(_matches(block, job, mesh) for mesh in meshes)
    ]
    return items, unused


def _endings(output: str) -> tuple[str, ...]:
    return _ENDINGS.get(output, _PICTURE)


def _expanded(job: Job) -> list[str]:
    found: dict[str, None] = {}
    for pattern in job.meshes:
        ones = list(_found(pattern, job.folder))
        if not ones:
            raise ParameterError(f"{job.label}: meshes: {pattern!r} matches no file")
        found.update(dict.fromkeys(ones))
    return list(found)


def _found(pattern: str, folder: Path) -> Iterable[str]:
    if pattern.startswith(PREFIX):
        return [pattern]
    if "://" in pattern:
        from app.batch.remote import found

        return found(pattern)
    whole = os.path.abspath(folder / pattern)
    if os.path.exists(whole) or not glob.has_magic(pattern):
        return [whole]  # one that is missing is told of with its name, as a mesh that failed
    return sorted(one for one in glob.glob(whole, recursive=True) if os.path.isfile(one))


def _matches(block: Block, job: Job, mesh: str) -> bool:
    path = mesh
    if not mesh.startswith(PREFIX) and "://" not in mesh:
        path = Path(os.path.relpath(mesh, job.folder)).as_posix()
    return any(
        fnmatchcase(path, pattern) or fnmatchcase(PurePosixPath(path).name, pattern)
        for pattern in block.match
    )


def _item(job: Job, n: int, mesh: str, template: str, overrides: Fields) -> Item:
    blocks = [block for block in job.blocks if _matches(block, job, mesh)]
    outputs, seconds, memory = job.outputs, job.seconds, job.memory_gib
    for block in blocks:
        outputs = block.outputs or outputs
        seconds = block.seconds or seconds
        memory = block.memory_gib or memory
    works = []
    for variation in job.sessions:
        fields = job.defaults | variation.fields
        for block in blocks:
            fields = fields | block.fields
        for output in dict.fromkeys(outputs):
            session = session_of(fields | overrides, output, mesh)
            name = filled(template, _values(n, mesh, variation, output, session))
            works.append(Work(output, variation.name, session, name + _endings(output)[0]))
    return Item(n, mesh, tuple(works), seconds, memory)


def _values(
    n: int, mesh: str, variation: Variation, output: str, session: Session
) -> dict[str, str | int]:
    path = PurePosixPath(mesh.removeprefix(PREFIX).replace("\\", "/"))
    compared = "-".join(model.name for model in session.compared)
    material = session.material if isinstance(session.material, str) else session.material.name
    return {
        "stem": path.stem,
        "folder": path.parent.name,
        "n": n,
        "session": variation.name,
        "output": output,
        "model": compared if output == "compare" else session.model.name,
        "material": material,
        "method": session.estimator.name,
    }


def _check_names(items: list[Item], template: str) -> None:
    # Without regard to capitals, as the file systems of Windows and macOS.
    taken = {name.casefold(): "the batch itself" for name in RESERVED}
    for item in items:
        for work in item.works:
            what = f"{work.output} of {item.mesh} ({work.variation})"
            for file in work.files:
                other = taken.setdefault(file.casefold(), what)
                if other != what:
                    raise ParameterError(
                        f"template {template!r} gives {file!r} to {other} and to {what}; add "
                        "{n:3}, {folder}, {session} or {output} to it"
                    )


def _check_sessions(items: list[Item]) -> None:
    """Find a name of a plug-in or material that does not exist before any work is done."""
    from app.batch.framing import check

    known: set[bytes] = set()
    for item in items:
        for work in item.works:
            check(work.session, work.output, known)
