"""What a library says of a file in its log only."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from app.loading.errors import BadContentError


class _Collector(logging.Handler):
    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.records: list[logging.LogRecord] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.records.append(record)


@contextmanager
def remarks(logger: str, package: str, warnings: list[str]) -> Iterator[None]:
    """Turn what a library logs into warnings, and errors that it passes over into an error.

    Parameters
    ----------
    logger : str
        Name of the library's logger.
    package : str
        What to call it.
    warnings : list of str
        Grows by one line for each thing that was logged.

    Yields
    ------
    None
        While the library works.

    Raises
    ------
    BadContentError
        If it logged an error.
    """
    collector, source = _Collector(), logging.getLogger(logger)
    source.addHandler(collector)
    try:
        yield
    finally:
        source.removeHandler(collector)
    for record in collector.records:
        line = f"{package} says: {record.getMessage()}"
        if record.levelno >= logging.ERROR:
            raise BadContentError(line)
        if line not in warnings:
            warnings.append(line)
