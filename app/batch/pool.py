"""A batch on this machine: some threads, each with a child process of its own."""

from collections.abc import Generator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed

from app.batch.crew import Crew, environment
from app.batch.ledger import Record
from app.batch.mesh_work import finish
from app.batch.plan import Item
from app.contestants import alone
from lutcore.shading import AUTO


def run_here(
    items: Sequence[Item], target: str, *, resume: bool, jobs: int
) -> Generator[Record, None, None]:
    """Draw meshes on this machine.

    Parameters
    ----------
    items : sequence of Item
        The meshes.
    target : str
        The output folder.
    resume : bool
        Whether what is finished is left as it is.
    jobs : int
        Meshes that are drawn at once.

    Yields
    ------
    dict
        A mesh's record as soon as it is kept. A caller that stops listening ends the work: no
        further mesh is begun, and what the children are at is left.
    """
    crew = Crew(environment(jobs, uses_auto(items)))
    pool = ThreadPoolExecutor(jobs, thread_name_prefix="batch")
    try:
        futures = [pool.submit(finish, item, target, resume, crew) for item in items]
        for future in as_completed(futures):
            yield future.result()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        crew.stop()
        pool.shutdown(wait=True)


def uses_auto(items: Sequence[Item]) -> bool:
    """Tell whether some result leaves its model to `auto`.

    Parameters
    ----------
    items : sequence of Item
        The meshes.

    Returns
    -------
    bool
        True if one does.
    """
    return any(
        model.name == AUTO
        for item in items
        for work in item.works
        for model in (work.session.model, *(one.model for one in alone(work.session)))
    )
