"""The pages of the contact sheet, each drawn as soon as its meshes are done."""

from concurrent.futures import Future, ThreadPoolExecutor
from typing import Self

from app.batch.ledger import Record
from app.batch.sheet import PAGE, write_page
from app.batch.store import Store


class SheetPages:
    """Draws pages beside the batch: after it, all cores but one would wait for them.

    As a context it ends with no further page begun.

    Parameters
    ----------
    store : Store
        Where to; holds the pictures.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._ahead: dict[int, Record] = {}
        self._next = 1
        self._page: list[Record] = []
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="sheet")
        self._drawn: list[Future[None]] = []

    def add(self, record: Record) -> None:
        """Take a record in.

        Parameters
        ----------
        record : dict
            Of a mesh; they come in any order.
        """
        self._ahead[record["n"]] = record
        while (following := self._ahead.pop(self._next, None)) is not None:
            self._next += 1
            self._show(following)

    def end(self) -> None:
        """Draw what is left, also where records are missing, and wait for it."""
        for _, record in sorted(self._ahead.items()):
            self._show(record)
        if self._page:
            self._draw()
        for page in self._drawn:
            page.result()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.shutdown(cancel_futures=True)

    def _show(self, record: Record) -> None:
        self._page.append(record)
        if len(self._page) == PAGE:
            self._draw()

    def _draw(self) -> None:
        number = len(self._drawn) + 1
        self._drawn.append(self._pool.submit(write_page, self._store, number, self._page))
        self._page = []
