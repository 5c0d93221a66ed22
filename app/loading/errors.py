"""What can be wrong with a file, inside the readers and for the user."""

from lutcore.errors import MeshError


class UnreadableFileError(MeshError):
    """The file cannot be read: missing, forbidden, damaged, cut short or of no known format."""


class BadContentError(Exception):
    """A reader's complaint, without the file's name: the loader adds that.

    Parameters
    ----------
    problem : str
        What is wrong and where: ``"line 12: 'x' is not a number"``.
    advice : str
        What the user can do about it.
    """

    def __init__(
        self,
        problem: str,
        advice: str = "the file is damaged or incomplete: copy or export it again",
    ) -> None:
        super().__init__(problem)
        self.problem = problem
        self.advice = advice
