"""Array types, and the checks that every array from outside passes."""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lutcore.errors import ParameterError

FloatArray = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IndexArray = NDArray[np.int32]
BoolArray = NDArray[np.bool_]
AnyArray = NDArray[Any]
T = TypeVar("T", bound=np.generic)


def finite(name: str, value: ArrayLike, *shapes: tuple[int, ...]) -> FloatArray:
    """Return `value` as a finite float64 array of one of the given shapes.

    Parameters
    ----------
    name : str
        The parameter's name, for the message.
    value : array_like
        The value given by the caller.
    *shapes : tuple of int
        Shapes that are accepted; none means any shape.

    Returns
    -------
    ndarray of float64
        A contiguous array; a copy only where one is needed.

    Raises
    ------
    ParameterError
        If it is not numeric, not finite or of another shape.
    """
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} = {value!r} is not numeric") from None
    if np.ndim(value) == 0:
        array = array.reshape(())
    if shapes and array.shape not in shapes:
        wanted = " or ".join(str(shape) for shape in shapes)
        raise ParameterError(f"{name} has shape {array.shape}, expected {wanted}")
    if not np.isfinite(array).all():
        raise ParameterError(f"{name} = {value!r} is not finite")
    return array


def read_only(array: NDArray[T]) -> NDArray[T]:
    """Return an array as one that cannot be written to.

    Code is compiled apart for arrays that can be and arrays that cannot: those that compiled
    functions often get are always the one or the other.

    Parameters
    ----------
    array : ndarray
        Any.

    Returns
    -------
    ndarray
        A view of it.
    """
    view = array.view()
    view.setflags(write=False)
    return view


def unit_vector(name: str, value: ArrayLike) -> FloatArray:
    """Return `value`, a vector of three components, scaled to length one.

    Parameters
    ----------
    name : str
        The parameter's name, for the message.
    value : array_like, shape=(3,)
        Any vector but zero.

    Returns
    -------
    ndarray, shape=(3,)
        The unit vector.

    Raises
    ------
    ParameterError
        If it is not a finite vector of three components, or zero.
    """
    vector = finite(name, value, (3,))
    largest = float(np.abs(vector).max())
    if largest == 0.0:
        raise ParameterError(f"{name} = {value!r} has no direction")
    vector = vector / largest  # first, so that no square overflows
    return vector / float(np.linalg.norm(vector))
