"""Numbers as people read them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Measure:
    """What a figure is and how it is said.

    Parameters
    ----------
    title : str
        What it is called.
    factor : float
        What the value is multiplied by before it is shown.
    unit : str
        What follows the number.
    """

    title: str
    factor: float = 1.0
    unit: str = ""

    @property
    def heading(self) -> str:
        """Title and unit."""
        return f"{self.title}, {self.unit}" if self.unit else self.title

    def said(self, value: float) -> str:
        """Return a value as people read it.

        Parameters
        ----------
        value : float
            Not negative.

        Returns
        -------
        str
            With its unit.
        """
        text = number(self.factor * value)
        return f"{text} {self.unit}" if self.unit else text


def number(value: float) -> str:
    """Return a number that is not negative, to three digits or to whole ones.

    Parameters
    ----------
    value : float
        Any that is not negative.

    Returns
    -------
    str
        Without an exponent up to 100 000.
    """
    return f"{value:.0f}" if 100.0 <= value < 1e5 else f"{value:.3g}"


def microseconds(seconds: float) -> str:
    """Return seconds as a number of microseconds.

    Parameters
    ----------
    seconds : float
        Not negative.

    Returns
    -------
    str
        Without the unit.
    """
    return number(1e6 * seconds)


PERCENT = Measure("error", 100.0, "%")
"""A share, which is what errors are where nothing else is said."""
