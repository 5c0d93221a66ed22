"""The errors a user can cause, worded for that user."""

from collections.abc import Iterable
from difflib import get_close_matches


class CurvelightError(Exception):
    """Base of every error that is the input's fault rather than the program's."""


class MeshError(CurvelightError):
    """The data hold no surface that can be used."""


class CancelledError(CurvelightError):
    """The caller's progress callback asked to stop."""


class ParameterError(CurvelightError, ValueError):
    """A parameter has a value that it cannot take."""

    @classmethod
    def unknown(cls, kind: str, value: object, choices: Iterable[str]) -> "ParameterError":
        """Build the error for a name that does not exist, naming the choices and the nearest.

        Parameters
        ----------
        kind : str
            What was named, in words: ``"material"``.
        value : object
            The name that was given.
        choices : iterable of str
            Every name that exists.

        Returns
        -------
        ParameterError
            The error, to be raised by the caller.
        """
        names = sorted(choices)
        near = get_close_matches(str(value), names, n=1, cutoff=0.5)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        return cls(f"unknown {kind} {value!r}{hint} (choices: {', '.join(names) or 'none'})")

    @classmethod
    def out_of_range(
        cls, name: str, value: object, low: float, high: float, unit: str = ""
    ) -> "ParameterError":
        """Build the error for a number outside its range.

        Parameters
        ----------
        name : str
            The parameter's name.
        value : object
            The value that was given.
        low, high : float
            The inclusive range.
        unit : str
            The unit of the range, for the message.

        Returns
        -------
        ParameterError
            The error, to be raised by the caller.
        """
        suffix = f" {unit}" if unit else ""
        return cls(f"{name} = {value!r} is outside its range {low:g} to {high:g}{suffix}")
