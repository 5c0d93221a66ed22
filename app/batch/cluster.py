"""A batch on a Dask cluster: one task for each mesh, with a child process inside the task.

The workers need this package, and the same paths or addresses for meshes and results.
"""

import atexit
import threading
from collections import Counter
from collections.abc import Generator, Sequence
from typing import Any
from urllib.parse import urlsplit
from uuid import uuid4

import msgspec

from app.batch.crew import Crew, environment
from app.batch.ledger import Record
from app.batch.mesh_work import finish
from app.batch.plan import Item
from app.batch.pool import uses_auto
from lutcore.errors import CurvelightError, ParameterError

_PATIENCE = 20  # seconds for the scheduler to answer


class ClusterError(CurvelightError):
    """A cluster cannot be reached, or has no workers."""


def run_there(
    address: str, items: Sequence[Item], target: str, *, resume: bool
) -> Generator[Record, None, None]:
    """Draw meshes on a cluster.

    Parameters
    ----------
    address : str
        Of its scheduler: ``tcp://host:8786``.
    items : sequence of Item
        The meshes; their paths hold on every worker.
    target : str
        The output folder; an absolute path that all workers see, or an address.
    resume : bool
        Whether what is finished is left as it is.

    Yields
    ------
    dict
        A mesh's record as soon as it is kept. A caller that stops listening ends the work: no
        further mesh is begun, and what the children are at is left.

    Raises
    ------
    ParameterError
        If the package distributed is not installed.
    ClusterError
        If the cluster cannot be reached or has no workers.
    """
    client = _client(address)
    token = uuid4().hex
    futures: dict[Any, Item] = {}
    try:
        parallel = _most_on_a_machine(client.nthreads())
        if not parallel:
            raise ClusterError(f"{address}: the cluster has no workers; start some")
        variables = environment(parallel, uses_auto(items))
        for item in items:
            payload = msgspec.json.encode(item)
            future = client.submit(draw, payload, target, resume, token, variables, pure=False)
            futures[future] = item
        yield from _records(futures, client.loop)
    finally:
        client.cancel([*futures])
        client.run(stop, token)
        client.close()


def draw(
    payload: bytes, target: str, resume: bool, token: str, variables: dict[str, str]
) -> Record:
    """Draw one mesh: the task that a worker of the cluster runs.

    Parameters
    ----------
    payload : bytes
        An `Item` as JSON.
    target : str
        The output folder.
    resume : bool
        Whether a finished mesh is left as it is.
    token : str
        Of the batch: its tasks share warm children.
    variables : dict of str to str
        Of the children's environment.

    Returns
    -------
    dict
        The record.
    """
    with _lock:
        crew = _crews.setdefault(token, Crew(variables))
    return finish(msgspec.json.decode(payload, type=Item), target, resume, crew)


def stop(token: str) -> None:
    """End the children that a worker of the cluster keeps for a batch.

    Parameters
    ----------
    token : str
        Of the batch.
    """
    with _lock:
        crew = _crews.pop(token, None)
    if crew is not None:
        crew.stop()


_crews: dict[str, Crew] = {}
_lock = threading.Lock()


@atexit.register
def _stop_all() -> None:
    for token in [*_crews]:
        stop(token)


def _records(futures: dict[Any, Item], loop: Any) -> Generator[Record, None, None]:
    from distributed import as_completed

    for future in as_completed([*futures], loop=loop):
        item = futures.pop(future)
        error = future.exception()
        if error is None:
            yield future.result()
        else:  # the worker died more often than the scheduler allows, or lacks the package
            message = f"lost by the cluster ({type(error).__name__}: {error})"
            yield {"n": item.n, "mesh": item.mesh, "reason": "lost", "message": message}


def _client(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError:
        raise ParameterError(
            "--dask needs the package distributed; install it with pip install "
            "'curvelight[cluster]'"
        ) from None
    try:
        return Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(
            f"{address}: no Dask scheduler answers ({error}); check the address and start one with "
            "dask scheduler"
        ) from None


def _most_on_a_machine(threads: dict[str, int]) -> int:
    """Return how many tasks run at once on the machine that has most workers."""
    on: Counter[str | None] = Counter()
    for address, count in threads.items():
        on[urlsplit(address).hostname] += count
    return max(on.values(), default=0)
