"""How far each shading model holds: its error on a ball over the ball's radius in l_d."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.chart.captions import Inks, styles
from app.chart.measure import PERCENT
from app.pipeline import Pipeline
from app.session import Session
from lutcore.arrays import FloatArray
from lutcore.baking import bake
from lutcore.progress import Progress, part, tell
from lutcore.shading import model_registry
from lutcore.stability_of_shading.distance import RATIOS, WALKED, against_profile, against_walk

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PHOTONS = 200_000
CHANNELS = ("red", "green", "blue")
_WIDE, _HIGH = 12.0, 6.3
# The least error that is drawn, and the most.
_LEAST, _MOST = 1e-4, 1.0


@dataclass(frozen=True, eq=False)
class Ranges:
    """Errors of local models on balls.

    Parameters
    ----------
    material, profile, channel : str
        Names of the substance, of how light spreads in it, and of the channel.
    names : tuple of str
        Models.
    ratios : tuple of float
        Radii in l_d against the profile.
    errors : ndarray, shape=(models, ratios)
        Relative L2 errors against it.
    walked : tuple of float
        Radii in l_d against the random walk.
    physical : ndarray, shape=(models, walked)
        Relative L2 errors against it.
    scatter : ndarray, shape=(walked,)
        The walk's own standard error.
    """

    material: str
    profile: str
    channel: str
    names: tuple[str, ...]
    ratios: tuple[float, ...]
    errors: FloatArray
    walked: tuple[float, ...]
    physical: FloatArray
    scatter: FloatArray

    @property
    def subject(self) -> str:
        """What it was measured on."""
        return f"balls of {self.material}, {self.channel}, light from one side"

    @property
    def meaning(self) -> str:
        """What the errors are."""
        return (
            "Error is relative L2 over the whole ball. Left, against the profile "
            f"{self.profile} integrated over the true sphere with the Fresnel factor inside, "
            f"errors below {100.0 * _LEAST:g} % drawn there; "
            f"right, against {PHOTONS:,} photons followed through it, whose own scatter is the "
            "dotted line: an error below it is not resolved, and drawn on it."
        )


def measured(
    session: Session, pipeline: Pipeline, names: Sequence[str], seed: int, progress: Progress
) -> Ranges:
    """Measure local models on balls of the session's material, in the channel that glows farthest.

    Parameters
    ----------
    session : Session
        Its material and profile are used.
    pipeline : Pipeline
        Where they come from.
    names : sequence of str
        Models; those that are not local are left out.
    seed : int
        Of the random walk.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Ranges
        What was found.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    local = tuple(name for name in names if model_registry.get(name).local)
    models = [model_registry.get(name)() for name in local]
    material, profile = pipeline.material(session), pipeline.profile(session)
    table = bake(material, profile=profile)
    channel = int(np.argmax(table.mean_free_path * table.psi[:, 0]))
    tell(progress, 0.0, "models on balls")
    errors = against_profile(models, material, profile, channel)
    walking = part(progress, 0.3, 1.0)
    physical, scatter = against_walk(
        models, material, profile, channel, PHOTONS, seed=seed, progress=walking
    )
    return Ranges(
        material.name,
        session.profile.name,
        CHANNELS[channel],
        local,
        RATIOS,
        errors,
        WALKED,
        physical,
        scatter,
    )


def plain(found: Ranges) -> dict[str, object]:
    """Return the errors as plain values, for JSON.

    Parameters
    ----------
    found : Ranges
        Any.

    Returns
    -------
    dict
        By model.
    """
    return {
        "subject": found.subject,
        "meaning": found.meaning,
        "radius_over_l_d": list(found.ratios),
        "against_profile": _by_model(found, found.errors),
        "walked_radius_over_l_d": list(found.walked),
        "against_walk": _by_model(found, found.physical),
        "walk_standard_error": found.scatter.tolist(),
    }


def _by_model(found: Ranges, errors: FloatArray) -> dict[str, list[float]]:
    return {name: row.tolist() for name, row in zip(found.names, errors, strict=True)}


def as_csv(found: Ranges) -> str:
    """Return the errors as comma-separated values.

    Parameters
    ----------
    found : Ranges
        Any.

    Returns
    -------
    str
        A line for each model, truth and radius.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["name", "truth", "radius_over_l_d", "error"])
    for truth, ratios, errors in _truths(found):
        for name, row in zip(found.names, errors, strict=True):
            for ratio, error in zip(ratios, row, strict=True):
                writer.writerow([name, truth, f"{ratio:g}", f"{error:.6g}"])
    return out.getvalue()


def _truths(found: Ranges) -> list[tuple[str, tuple[float, ...], FloatArray]]:
    return [
        ("profile", found.ratios, found.errors),
        ("walk", found.walked, found.physical),
    ]


def rows(found: Ranges) -> list[list[str]]:
    """Return the errors as rows of a table.

    Parameters
    ----------
    found : Ranges
        Any.

    Returns
    -------
    list of list of str
        The heading, then a row for each model and truth.
    """
    table = [["model", "against", *(f"{ratio:g} l_d" for ratio in found.walked)]]
    for truth, ratios, errors in _truths(found):
        at = [ratios.index(ratio) for ratio in found.walked]
        for name, row in zip(found.names, errors, strict=True):
            table.append([name, truth, *(PERCENT.said(float(row[i])) for i in at)])
    return table


def figure(found: Ranges, inks: Inks, *, headed: bool = True) -> "Figure":
    """Draw the errors.

    Parameters
    ----------
    found : Ranges
        Any.
    inks : Inks
        Colours of words, grid and background.
    headed : bool
        Whether subject and meaning stand above it.

    Returns
    -------
    Figure
        Of matplotlib.
    """
    import textwrap

    from matplotlib.figure import Figure

    drawn = Figure(figsize=(_WIDE, _HIGH), facecolor=inks.paper)
    top = 0.94
    if headed:
        drawn.text(
            0.03,
            0.97,
            f"Error on {found.subject}",
            fontsize=13.5,
            weight="bold",
            va="top",
            color=inks.text,
        )
        words = "\n".join(textwrap.wrap(found.meaning, 170))
        drawn.text(0.03, 0.915, words, fontsize=8.5, va="top", color=inks.text, linespacing=1.3)
        top = 0.81
    left = drawn.add_axes((0.065, 0.11, 0.36, top - 0.11), facecolor=inks.paper)
    right = drawn.add_axes((0.455, 0.11, 0.36, top - 0.11), facecolor=inks.paper)
    _draw(left, found, found.ratios, found.errors, inks)
    _draw(right, found, found.walked, np.maximum(found.physical, found.scatter), inks)
    right.plot(
        found.walked, 100.0 * found.scatter, color=inks.text, linestyle=(0, (1, 1.5)), lw=1.1
    )
    left.set_title("against the profile on the sphere", fontsize=11, color=inks.text)
    right.set_title("against the random walk", fontsize=11, color=inks.text)
    left.set_ylabel("error, %", color=inks.text, fontsize=11)
    right.set_yticklabels([])
    box = drawn.legend(
        *left.get_legend_handles_labels(),
        loc="upper left",
        bbox_to_anchor=(0.82, top + 0.015),
        frameon=False,
        fontsize=9.5,
        labelcolor=inks.text,
    )
    for one in box.get_texts():
        one.set_parse_math(False)
    return drawn


def _draw(
    axes: "Axes", found: Ranges, ratios: Sequence[float], errors: FloatArray, inks: Inks
) -> None:
    from matplotlib.ticker import FuncFormatter, NullFormatter

    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", color=inks.faint, linewidth=0.7)
    axes.set_axisbelow(True)
    known = styles(found.names)
    for name, row in zip(found.names, errors, strict=True):
        color, marker = known[name]
        shown = 100.0 * np.clip(row, _LEAST, None)
        axes.plot(ratios, shown, color=color, marker=marker, markersize=5, lw=1.4, label=name)
    axes.set_ylim(100.0 * _LEAST, 100.0 * _MOST)
    axes.set_xlabel("radius of the ball, l_d", color=inks.text, fontsize=11, parse_math=False)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.6g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.set_xticks([1.0, 2.0, 5.0, 10.0, 20.0, 50.0])
    axes.tick_params(which="both", color=inks.faint, labelcolor=inks.text, labelsize=10)
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(inks.faint)
