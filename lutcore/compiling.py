"""What goes with compiling: who is told of it, and which process does it. Imports nothing."""

from collections.abc import Callable

_listeners: list[Callable[[], None]] = []
_elsewhere = [False]


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


def compile_elsewhere() -> None:
    """Have a child process compile from now on, and this one only load what it made.

    For a process that lives long: what compiling a function leaves in memory is several times as
    much as its code, and is never given back. A child costs a second to start.
    """
    _elsewhere[:] = [True]


def elsewhere() -> bool:
    """Tell whether a child process is to compile.

    Returns
    -------
    bool
        What `compile_elsewhere` asked for.
    """
    return _elsewhere[0]
