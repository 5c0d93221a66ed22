"""Which of the methods on offer shall take part in a chart."""

from collections.abc import Sequence

from lutcore.errors import ParameterError


def named(text: str | None, kind: str, offered: Sequence[str]) -> list[str]:
    """Return the methods that a text names.

    Parameters
    ----------
    text : str or None
        Names with commas between; None for all.
    kind : str
        What they are, for the message.
    offered : sequence of str
        All there are.

    Returns
    -------
    list of str
        Each once.

    Raises
    ------
    ParameterError
        If there is none of such a name.
    """
    if text is None:
        return list(offered)
    found = list(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in found:
        if name not in offered:
            raise ParameterError.unknown(kind, name, offered)
    return found
