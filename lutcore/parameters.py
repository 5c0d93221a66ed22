"""Parameters of plug-ins: each declared once, and read by flags, form, session, docs and tests."""

import dataclasses
from dataclasses import dataclass
from typing import Any, TypeVar, cast

from lutcore.errors import ParameterError

_KEY = "curvelight"
P = TypeVar("P", bound="Parameters")


@dataclass(frozen=True)
class Number:
    """What a numeric parameter accepts.

    Parameters
    ----------
    low, high : float
        Inclusive range.
    unit : str
        Unit, empty if it has none.
    doc : str
        One sentence.
    integer : bool
        Whether only whole numbers are accepted.
    """

    low: float
    high: float
    unit: str
    doc: str
    integer: bool

    def check(self, name: str, value: object) -> float | int:
        """Return the value as this parameter stores it.

        Parameters
        ----------
        name : str
            The parameter's name, for the message.
        value : object
            A number or its text.

        Returns
        -------
        float or int
            The value.

        Raises
        ------
        ParameterError
            If it is not a number of this kind, or out of range.
        """
        try:
            number = float(cast(Any, value))
        except (TypeError, ValueError):
            raise ParameterError(f"{name} = {value!r} is not a number") from None
        if self.integer and not number.is_integer():
            raise ParameterError(f"{name} = {value!r} is not a whole number")
        if not self.low <= number <= self.high:
            raise ParameterError.out_of_range(name, value, self.low, self.high, self.unit)
        return int(number) if self.integer else number


@dataclass(frozen=True)
class Choice:
    """What a parameter that names one of several ways accepts.

    Parameters
    ----------
    options : tuple of str
        The names.
    doc : str
        One sentence.
    """

    options: tuple[str, ...]
    doc: str

    def check(self, name: str, value: object) -> str:
        """Return the value if it is one of the options.

        Parameters
        ----------
        name : str
            The parameter's name, for the message.
        value : object
            The name given.

        Returns
        -------
        str
            The value.

        Raises
        ------
        ParameterError
            If it is none of the options.
        """
        if not isinstance(value, str) or value not in self.options:
            raise ParameterError.unknown(name, value, self.options)
        return value


def param(default: float, low: float, high: float, unit: str, doc: str) -> Any:
    """Declare a numeric parameter of a plug-in; whole numbers only if the default is an int.

    Parameters
    ----------
    default : float or int
        Value when nothing is said.
    low, high : float
        Inclusive range.
    unit : str
        Unit, empty if it has none.
    doc : str
        One sentence.

    Returns
    -------
    dataclasses.Field
        A field for the plug-in's frozen dataclass.
    """
    spec = Number(low, high, unit, doc, isinstance(default, int))
    return dataclasses.field(default=default, metadata={_KEY: spec})


def choice(default: str, options: tuple[str, ...], doc: str) -> Any:
    """Declare a parameter that names one of several ways.

    Parameters
    ----------
    default : str
        Value when nothing is said.
    options : tuple of str
        The names.
    doc : str
        One sentence.

    Returns
    -------
    dataclasses.Field
        A field for the plug-in's frozen dataclass.
    """
    return dataclasses.field(default=default, metadata={_KEY: Choice(options, doc)})


@dataclass(frozen=True)
class Parameters:
    """Base of every plug-in: a frozen dataclass whose fields are its checked parameters."""

    def __post_init__(self) -> None:
        for name, spec in declared(type(self)).items():
            object.__setattr__(self, name, spec.check(name, getattr(self, name)))


def declared(plugin: type[Parameters]) -> dict[str, Number | Choice]:
    """Return the parameters that a plug-in declares, in order.

    Parameters
    ----------
    plugin : type
        The plug-in's class.

    Returns
    -------
    dict of str to Number or Choice
        What each parameter accepts.
    """
    return {
        field.name: field.metadata[_KEY]
        for field in dataclasses.fields(plugin)
        if _KEY in field.metadata
    }


def create(plugin: type[P], label: str, values: dict[str, Any]) -> P:
    """Make a plug-in with the given parameter values.

    Parameters
    ----------
    plugin : type
        The plug-in's class.
    label : str
        Its kind and name, for the message.
    values : dict of str to object
        Values by parameter name.

    Returns
    -------
    plug-in
        An instance of the class, its values checked.

    Raises
    ------
    ParameterError
        If it has no parameter of that name, or the value is not accepted.
    """
    for name in values:
        if name not in declared(plugin):
            raise ParameterError.unknown(f"parameter of {label}", name, declared(plugin))
    return plugin(**values)
