"""One mesh from its file to its results and its record: what a batch does many times."""

import os
import time
from pathlib import Path
from typing import Any, NamedTuple

from msgspec.structs import replace

from app.batch import ledger
from app.batch.crew import Crew, OversteppedError
from app.batch.ledger import DONE, Record
from app.batch.plan import Item
from app.batch.remote import fetched
from app.batch.store import Store, digest, opened
from app.batch.task import Task
from app.batch.telling import failure
from app.portable import portable
from app.samples import PREFIX
from lutcore.errors import CancelledError, CurvelightError
from lutcore.isolated import IsolatedError


def finish(item: Item, target: str, resume: bool, crew: Crew) -> Record:
    """Draw a mesh, unless that is done, and keep what came of it.

    Parameters
    ----------
    item : Item
        The mesh and what is drawn of it.
    target : str
        The output folder; see `app.batch.store.opened`.
    resume : bool
        Whether a finished mesh that has not changed is left as it is.
    crew : Crew
        Who draws.

    Returns
    -------
    dict
        The record; ``resumed`` says whether an earlier run had it. Whatever a mesh does is told
        in ``reason`` and ``message``.

    Raises
    ------
    CancelledError
        If the crew was stopped.
    """
    start = time.perf_counter()
    try:
        return _finished(item, opened(target), target, resume, crew)
    except CancelledError:
        raise
    except Exception as error:  # of this mesh alone, as a full disk or an address that is gone
        if not isinstance(error, CurvelightError | OSError):
            raise
        problem = failure(error) if isinstance(error, CurvelightError) else _lost(error)
        return _head(item, target) | problem | {"seconds": _since(start), "resumed": False}


def _finished(item: Item, store: Store, target: str, resume: bool, crew: Crew) -> Record:
    start = time.perf_counter()
    if "://" not in item.mesh:
        return _kept_or_drawn(_Case(item, store, None, start), target, resume, crew)
    # In a folder of its own that has the same name in each run: reports show it.
    folder = store.pending(f"mesh-{digest(item.mesh.encode())[:16]}")
    try:
        mesh = str(fetched(item.mesh, folder))
        works = tuple(replace(one, session=replace(one.session, mesh=mesh)) for one in item.works)
        case = _Case(replace(item, works=works), store, folder, start)
        return _kept_or_drawn(case, target, resume, crew)
    finally:
        store.leave(folder)


class _Case(NamedTuple):
    """A mesh that lies on this machine."""

    item: Item
    store: Store
    origin: Path | None
    start: float


def _kept_or_drawn(case: _Case, target: str, resume: bool, crew: Crew) -> Record:
    item, store = case.item, case.store
    key = ledger.key_of(item, ledger.content_of(item.works[0].session.mesh))
    if resume and (record := ledger.finished(store, key)) is not None:
        return record | {"n": item.n, "resumed": True}
    pending = store.pending(key)
    origin = case.origin or store.origin(pending)
    task = Task(item.works, str(pending), str(origin), ledger.thumbnail(key))
    try:
        answer = crew.do(task, item.seconds, item.memory_gib)
    except OversteppedError as error:
        answer = {"outputs": [], "problems": [{"reason": error.reason, "message": str(error)}]}
    except IsolatedError as error:
        answer = {"outputs": [], "problems": [{"reason": "crashed", "message": str(error)}]}
    problems = answer.pop("problems")
    reason, message = DONE, ""
    if problems:
        reason, message = problems[0]["reason"], problems[0]["message"]
        # The record names the mesh already, and no folder of this machine.
        message = message.removeprefix(f"{item.works[0].session.mesh}: ")
    record = _head(item, target) | {"key": key, "reason": reason, "message": message}
    record |= {"problems": problems} if len(problems) > 1 else {}
    record |= answer | {"seconds": _since(case.start), "resumed": False}
    ledger.publish(store, record, pending)
    return record


def _head(item: Item, target: str) -> Record:
    mesh = item.mesh
    if not mesh.startswith(PREFIX) and "://" not in mesh:
        mesh = mesh if "://" in target else portable(mesh, Path(os.path.abspath(target)))
    return {"n": item.n, "mesh": mesh}


def _lost(error: OSError) -> dict[str, Any]:
    return {"reason": "unreadable", "message": str(error)}


def _since(start: float) -> float:
    return round(time.perf_counter() - start, 4)
