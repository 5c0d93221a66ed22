"""A picture beside the one it should look like, for people's own regression tests."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from app.likeness import THRESHOLD, Likeness, likeness, write_difference
from app.provenance import PictureError, read_pixels, read_record
from app.record import Record, elsewhere
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from app.render import Image

DIFFERS = 6
"""Exit code of a picture that is not as expected."""


class Reference:
    """The picture that another should look like.

    Parameters
    ----------
    arguments : Namespace
        Of the command: `reference` and `threshold`.
    output : Path
        The picture that is about to be made.
    """

    def __init__(self, arguments: argparse.Namespace, output: Path) -> None:
        self.path: Path = arguments.reference
        if output.suffix.lower() != ".png":
            raise ParameterError("a reference is compared with a picture: write -o NAME.png")
        self._place = output.with_name(f"{output.stem}-difference.png")
        for written in (output, self._place):
            if written.exists() and self.path.exists() and written.samefile(self.path):
                raise ParameterError(f"{written} is the reference itself; choose another name")
        self._threshold: float | None = arguments.threshold
        self._expected = read_pixels(self.path)
        self._found: Likeness | None = None

    def compare(self, image: "Image", record: Record) -> None:
        """Compare the picture that was made, and write how it differs beside it if it does.

        Parameters
        ----------
        image : ndarray of uint8, shape=(height, width, 3 or 4)
            What was made.
        record : Record
            How.
        """
        limit = self._threshold
        if limit is None and not self._made_alike(record):
            limit = THRESHOLD
        self._found = likeness(self._expected, image, limit)
        if self._differs_visibly:
            write_difference(self._place, self._expected, image, self._found)

    def _made_alike(self, record: Record) -> bool:
        try:
            return not elsewhere(read_record(self.path).record, record)
        except PictureError:  # nobody knows what drew it
            return False

    @property
    def _differs_visibly(self) -> bool:
        found = self._found
        return found is not None and not found.alike and found.difference is not None

    @property
    def sentence(self) -> str:
        """What was found, in words."""
        if self._found is None:
            return f"{self.path}: not compared"
        verdict = "as" if self._found.alike else "DIFFERS from"
        shown = f"; see {self._place}" if self._differs_visibly else ""
        return f"{verdict} {self.path}: {self._found.sentence}{shown}"

    @property
    def exit_code(self) -> int:
        """0, or 6 if the picture differs."""
        return DIFFERS if self._found is not None and not self._found.alike else 0

    def as_json(self) -> dict[str, object]:
        """Return what was found as plain data.

        Returns
        -------
        dict
            The measures, the reference, and the picture of the difference if there is one.
        """
        measures = self._found.as_json() if self._found is not None else {}
        place = str(self._place) if self._differs_visibly else None
        return {"picture": str(self.path), "difference": place, **measures}
