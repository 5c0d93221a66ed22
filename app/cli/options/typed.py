"""What is typed behind a flag: numbers, lights, sizes, names, repairs."""

import argparse

from app.session import Cone, Directional, Point, Repair, Vector


def floats(text: str, *counts: int) -> list[float]:
    """Return numbers with commas.

    Parameters
    ----------
    text : str
        What was typed.
    *counts : int
        How many there may be.

    Returns
    -------
    list of float
        The numbers.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not numbers with commas") from None
    if len(numbers) not in counts:
        wanted = " or ".join(map(str, counts))
        raise argparse.ArgumentTypeError(f"{text!r} has {len(numbers)} numbers, expected {wanted}")
    return numbers


def pair(text: str) -> tuple[float, float]:
    """Return two numbers with a comma.

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    tuple of float
        The first below the second.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    low, high = floats(text, 2)
    if not low < high:
        raise argparse.ArgumentTypeError(f"{text!r}: the first must be below the second")
    return low, high


def size(text: str) -> tuple[int, int]:
    """Return the pixels of WIDTHxHEIGHT.

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    tuple of int
        Width and height.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    width, cross, height = text.lower().partition("x")
    if not (cross and width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT in pixels")
    return int(width), int(height)


def names(text: str) -> list[str]:
    """Return names with commas.

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    list of str
        None of them empty.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise argparse.ArgumentTypeError(f"{text!r} is not names with commas")
    return names


def repair(text: str) -> Repair:
    """Return the repair of KIND[=VALUE].

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    Repair
        Its kind and value checked.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    kind, equals, number = text.partition("=")
    value = floats(number, 1)[0] if equals else None
    try:
        return Repair(kind, value)  # type: ignore[arg-type]  # it checks the kind itself
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def directional(text: str) -> Directional:
    """Return the directional light of X,Y,Z[,E].

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    Directional
        In world axes.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    numbers = floats(text, 3, 4, 6)
    return Directional(_vector(numbers[:3]), _strength(numbers[3:]), "world")


def camera_directional(text: str) -> Directional:
    """Return the directional light of X,Y,Z[,E].

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    Directional
        In the camera's axes.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    numbers = floats(text, 3, 4, 6)
    return Directional(_vector(numbers[:3]), _strength(numbers[3:]), "camera")


def point(text: str) -> Point:
    """Return the point light of X,Y,Z[,I].

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    Point
        In world coordinates.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    numbers = floats(text, 3, 4, 6)
    return Point(_vector(numbers[:3]), _strength(numbers[3:]))


def cone(text: str) -> Cone:
    """Return the cone light of X,Y,Z,DX,DY,DZ,ANGLE[,I].

    Parameters
    ----------
    text : str
        What was typed.

    Returns
    -------
    Cone
        In world coordinates.

    Raises
    ------
    ArgumentTypeError
        If it is not that.
    """
    numbers = floats(text, 7, 8, 10)
    return Cone(_vector(numbers[:3]), _vector(numbers[3:6]), _strength(numbers[7:]), numbers[6])


def _strength(numbers: list[float]) -> Vector:
    """One number for white, three for RGB, none for 1."""
    if not numbers:
        return 1.0, 1.0, 1.0
    red, green, blue = numbers * 3 if len(numbers) == 1 else numbers
    return red, green, blue


def _vector(numbers: list[float]) -> Vector:
    x, y, z = numbers
    return x, y, z
