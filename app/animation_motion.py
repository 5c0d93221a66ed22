"""What an animation does, and at which rates its file can show it."""

from dataclasses import dataclass, replace
from pathlib import Path

from lutcore.parameters import Parameters, choice, param

GIF, MP4 = ".gif", ".mp4"
SUFFIXES = GIF, MP4
TURNTABLE, LIGHT_SWEEP = "turntable", "light-sweep"
# A GIF counts in hundredths of a second, and viewers slow down what is shorter than two.
_HUNDREDTHS = 100
_SHORTEST = 2


@dataclass(frozen=True)
class Motion(Parameters):
    """One turn of the object, or of the lights.

    Parameters
    ----------
    kind : str
        What turns.
    seconds : float
        How long a turn takes.
    fps : float
        Frames in a second.
    """

    kind: str = choice(TURNTABLE, (TURNTABLE, LIGHT_SWEEP), "What turns: the object, the lights.")
    seconds: float = param(6.0, 0.1, 600.0, "s", "How long a turn takes.")
    fps: float = param(20.0, 1.0, 60.0, "1/s", "Frames in a second.")

    @property
    def count(self) -> int:
        """How many frames a turn has."""
        return max(2, round(self.seconds * self.fps))

    @property
    def turns_object(self) -> bool:
        """Whether the object turns, not the lights."""
        return self.kind == TURNTABLE

    def kept_by(self, path: Path) -> "Motion":
        """Return the nearest motion that a file can show.

        Parameters
        ----------
        path : Path
            A name that ends on one of `SUFFIXES`.

        Returns
        -------
        Motion
            For a GIF, each frame lasts whole hundredths of a second.
        """
        if path.suffix.lower() != GIF:
            return self
        hundredths = max(_SHORTEST, round(_HUNDREDTHS / self.fps))
        return replace(self, fps=_HUNDREDTHS / hundredths)
