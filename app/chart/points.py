"""What a chart of speed against accuracy holds, whatever is compared in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from statistics import median

from app.chart.measure import PERCENT, Measure


@dataclass(frozen=True)
class Spread:
    """A figure that was measured several times.

    Parameters
    ----------
    least, middle, greatest : float
        Least, median and greatest of the repeats.
    """

    least: float
    middle: float
    greatest: float

    @classmethod
    def of(cls, values: Sequence[float]) -> "Spread":
        """Return the spread of some values.

        Parameters
        ----------
        values : sequence of float
            One for each repeat, at least one.

        Returns
        -------
        Spread
            Of all of them.
        """
        return cls(min(values), median(values), max(values))


@dataclass(frozen=True)
class Point:
    """One contestant at one setting, measured.

    Parameters
    ----------
    name : str
        The contestant's name.
    setting : str
        What was set, in few words; empty for its default.
    time : Spread
        Seconds for a vertex.
    error : Spread
        In the chart's measure: of a share, 0.01 is 1 %.
    series : str
        Points of one name and one series are joined by a line.
    order : float
        Their order along it.
    details : mapping of str to float
        What else was measured, by a name with its unit.
    """

    name: str
    setting: str
    time: Spread
    error: Spread
    series: str = ""
    order: float = 0.0
    details: Mapping[str, float] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """Seconds for a vertex: the least of the repeats, for a busy machine only adds to it."""
        return self.time.least

    @property
    def share(self) -> float:
        """The error: the median of the repeats."""
        return self.error.middle

    @property
    def label(self) -> str:
        """Name and setting."""
        return f"{self.name}, {self.setting}" if self.setting else self.name


@dataclass(frozen=True)
class Missing:
    """A contestant, or one setting of it, that gave no figures.

    Parameters
    ----------
    name, setting : str
        As of a point.
    reason : str
        Why, in its own words.
    """

    name: str
    setting: str
    reason: str


@dataclass(frozen=True)
class Advice:
    """What to take.

    Parameters
    ----------
    point : Point or None
        The recommended one, if there is one.
    sentence : str
        The recommendation in one sentence.
    """

    point: Point | None
    sentence: str


@dataclass(frozen=True)
class Chart:
    """Everything that a chart says.

    Parameters
    ----------
    subject : str
        What it was measured on.
    meaning : tuple of str
        What the error is and how time was taken, sentence by sentence.
    points : tuple of Point
        All that gave figures.
    front : tuple of Point
        Those that nothing beats in both time and error, fastest first.
    missing : tuple of Missing
        All that gave none.
    advice : Advice
        The recommendation.
    tolerance : float or None
        Error that was asked for.
    machine : mapping of str to str
        What it was measured with.
    facts : mapping of str to object
        What a script wants to know beside it: the settings of the run.
    measure : Measure
        What the error is.
    columns : mapping of str to Measure
        Details that belong into a table for people.
    frame : int or None
        Vertices that are worked on for one picture, where that is a figure worth saying.
    """

    subject: str
    meaning: tuple[str, ...]
    points: tuple[Point, ...]
    front: tuple[Point, ...]
    missing: tuple[Missing, ...]
    advice: Advice
    tolerance: float | None
    machine: Mapping[str, str]
    facts: Mapping[str, object]
    measure: Measure = PERCENT
    columns: Mapping[str, Measure] = field(default_factory=dict)
    frame: int | None = None
