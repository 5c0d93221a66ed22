"""Who is told when a function has to be compiled first. Imports nothing, so that asking is free."""

from collections.abc import Callable

_listeners: list[Callable[[], None]] = []


def when_compiling(listener: Callable[[], None]) -> None:
    """Have a function called, once, as soon as something has to be compiled.

    Parameters
    ----------
    listener : callable
        Takes no arguments. It replaces an earlier one that was not called yet.
    """
    _listeners[:] = [listener]


def tell() -> None:
    """Call the listener, if one is waiting."""
    if _listeners:
        _listeners.pop()()
