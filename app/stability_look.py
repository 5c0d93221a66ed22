"""How an outcome looks in a picture, on a page and in a terminal: colour, mark, number."""

from typing import NamedTuple

from app.stability import Outcome
from lutcore.gallery.judgement import Verdict


class Look(NamedTuple):
    """Colours and mark of a verdict.

    Parameters
    ----------
    fill, text : str
        Colours. From light to dark they are as far apart in grey as in colour; blue, yellow and
        vermilion stay apart for the colour-blind (Okabe and Ito 2008).
    mark : str
        Sign that needs no colour.
    plain : str
        The same where only ASCII can be shown.
    """

    fill: str
    text: str
    mark: str
    plain: str


LOOKS = {
    Verdict.SURVIVES: Look("#d3e8f8", "#0b2f4d", "✓", ""),
    Verdict.DEGRADED: Look("#f2bf3c", "#332500", "~", "~"),
    Verdict.WRONG: Look("#b8480a", "#ffffff", "✗", "x"),
    Verdict.REFUSED: Look("#ffffff", "#555555", "—", "refused"),
    Verdict.DIED: Look("#1c1c1c", "#ffffff", "†", "died"),
}


def number(value: float) -> str:
    """Return a number in two digits, as short as it can be.

    Parameters
    ----------
    value : float
        0 or more.

    Returns
    -------
    str
        Such as ``.044``, ``1.3``, ``12`` or ``>99``.
    """
    if not value <= 99.0:
        return ">99"
    if value < 0.0005:
        return "<.001"
    text = f"{value:.3f}" if value < 0.0995 else f"{value:.2f}" if value < 0.995 else f"{value:.2g}"
    return text.removeprefix("0")


def growth(outcome: Outcome) -> str:
    """Return how many times larger the defect makes the error.

    Parameters
    ----------
    outcome : Outcome
        One estimator on one case.

    Returns
    -------
    str
        A multiplication sign and a number; empty if that cannot be said.
    """
    ratio = outcome.ratio
    if ratio is None:
        return ""
    text = ">999" if ratio > 999.0 else "<.01" if ratio < 0.01 else f"{ratio:.2g}"
    return "\N{MULTIPLICATION SIGN}" + (f"{ratio:.0f}" if 99.5 <= ratio <= 999.0 else text)


def sentence(outcome: Outcome) -> str:
    """Return all that is known of an outcome, for who points at it.

    Parameters
    ----------
    outcome : Outcome
        One estimator on one case.

    Returns
    -------
    str
        Several lines.
    """
    lines = [f"{outcome.method} on {outcome.case}: {outcome.verdict}"]
    if outcome.message:
        lines.append(outcome.message)
    if outcome.score is not None:
        found = outcome.score
        lines.append(f"RMS error {found.error:.3g} of the RMS curvature")
        lines.append(f"99 % of the vertices below {found.worst:.3g}")
        if outcome.without is not None:
            times = f" ({growth(outcome)})" if outcome.ratio is not None else ""
            lines.append(f"without the defect {outcome.without:.3g}{times}")
        if found.within_1 is not None and found.within_2 is not None:
            lines.append(
                f"within its error bar {found.within_1:.0%}, within two {found.within_2:.0%}"
            )
        if found.missing:
            lines.append(f"not estimated, as it says itself: {found.missing:.1%}")
        if found.turned:
            lines.append(f"wrong sign of the mean curvature: {found.turned:.1%}")
    lines.append(f"{outcome.seconds:.3f} s")
    return "\n".join(lines)
