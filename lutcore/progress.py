"""How long work tells its caller where it stands, and is told to stop."""

from collections.abc import Callable

from lutcore.errors import CancelledError

Progress = Callable[[float, str], bool]
"""Called with the share done (0 to 1) and the step in words; returns False to cancel."""


def silent(share: float, step: str) -> bool:
    """Ignore progress and never cancel.

    Parameters
    ----------
    share : float
        Share of the work that is done, 0 to 1.
    step : str
        What is being done.

    Returns
    -------
    bool
        Always true.
    """
    return True


def part(progress: Progress, low: float, high: float) -> Progress:
    """Return the function to which one stage of the work reports 0 to 1.

    Parameters
    ----------
    progress : callable
        The caller's function.
    low, high : float
        Shares of the whole work at the stage's beginning and end.

    Returns
    -------
    callable
        Passes the stage's share on as a share of the whole.
    """
    return lambda share, step: progress(low + share * (high - low), step)


def tell(progress: Progress, share: float, step: str) -> None:
    """Report progress and stop if asked to.

    Parameters
    ----------
    progress : callable
        The caller's function.
    share : float
        Share of the work that is done, 0 to 1.
    step : str
        What is being done.

    Raises
    ------
    CancelledError
        If the caller's function returned False.
    """
    if not progress(share, step):
        raise CancelledError(f"cancelled during: {step}")
