"""What can be repaired about a mesh, and how each repair is set; `app.repairing` does it."""

from dataclasses import dataclass

from lutcore.parameters import Number


@dataclass(frozen=True)
class Kind:
    """One way to repair a mesh.

    Parameters
    ----------
    words : str
        What it does, in few words, as a button says it.
    doc : str
        What it does, in one sentence.
    value : Number, optional
        What its number accepts, where it takes one.
    default : float
        That number where none is given.
    """

    words: str
    doc: str
    value: Number | None = None
    default: float = 0.0

    def check(self, name: str, value: float | None) -> float:
        """Return the number that a repair works with.

        Parameters
        ----------
        name : str
            The kind's name, for the message.
        value : float or None
            What was given.

        Returns
        -------
        float
            It, or the default.

        Raises
        ------
        ParameterError
            If it is out of range.
        ValueError
            If a number is given to a kind that takes none.
        """
        if self.value is None:
            if value is not None:
                raise ValueError(f"repair {name!r} takes no number")
            return 0.0
        return float(self.value.check(f"repair {name}", self.default if value is None else value))


KINDS: dict[str, Kind] = {
    "merge": Kind(
        "Merge close vertices",
        "Join vertices that lie closer than this, and drop the faces that collapse.",
        Number(0.0, 5.0, "% of the diagonal", "Largest distance that is joined.", False),
        0.01,
    ),
    "islands": Kind(
        "Drop small parts",
        "Drop separate parts that are smaller than this.",
        Number(0.01, 99.0, "% of the diagonal", "Least diagonal of a part that stays.", False),
        10.0,
    ),
    "manifold": Kind(
        "Undo branching",
        "Drop faces until no edge has more than two, and part the surface where it touches itself "
        "in a point.",
    ),
    "holes": Kind(
        "Fill holes",
        "Close holes of no more edges than this by flat patches.",
        Number(3, 100_000, "edges", "Most edges around a hole that is filled.", True),
        100.0,
    ),
    "orient": Kind(
        "Orient faces",
        "Turn faces so that neighbours agree, and closed parts so that they are not inside out.",
    ),
    "decimate": Kind(
        "Reduce faces",
        "Collapse edges, those first that change the shape least, down to this many faces.",
        Number(100, 100_000_000, "faces", "How many faces are left.", True),
        100_000.0,
    ),
}
"""The repairs by name, in the order in which they are best done."""
