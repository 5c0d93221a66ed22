"""What one element of a PLY file holds: columns of numbers and of lists."""

from dataclasses import dataclass, field

import numpy as np

from app.loading.errors import BadContentError
from app.loading.ply_header import Element
from lutcore.arrays import AnyArray


@dataclass
class Table:
    """The values of one element.

    Parameters
    ----------
    columns : dict of str to ndarray, shape=(rows,)
        Values of the properties that are no lists.
    lists : dict of str to (ndarray, ndarray)
        All values of each list property, one list after another, and the lists' lengths.
    """

    columns: dict[str, AnyArray] = field(default_factory=dict)
    lists: dict[str, tuple[AnyArray, AnyArray]] = field(default_factory=dict)


def empty_table(element: Element) -> Table:
    """Return the table of an element without rows.

    Parameters
    ----------
    element : Element
        What the header says of it.

    Returns
    -------
    Table
        Its properties, without values.
    """
    table = Table()
    for each in element.properties:
        if each.length is None:
            table.columns[each.name] = np.empty(0, each.dtype)
        else:
            table.lists[each.name] = np.empty(0, each.dtype), np.empty(0, np.int64)
    return table


def cut_short(element: Element, row: int) -> BadContentError:
    """Return the error for a file that ends too early.

    Parameters
    ----------
    element : Element
        The table in which it ends.
    row : int
        The row in which it ends, from 0.

    Returns
    -------
    BadContentError
        To be raised by the caller.
    """
    return BadContentError(f"it ends in row {row} of {element.rows} of {element.name!r}")
