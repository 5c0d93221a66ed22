"""Shade a mesh as a translucent material and write a picture, or the values at its vertices.

.png is a picture; .vtp, .ply and .npz hold `shading` (float32, linear radiant exitance) and
`shading_srgb` (uint8: the same exposed and sRGB-encoded, without the exit Fresnel factor and the
vertex colours that a picture adds).
"""

import argparse
from typing import TYPE_CHECKING

from app.cli.options.mesh import add_mesh
from app.cli.options.methods import add_curvature
from app.cli.options.picture import add_colors, add_picture
from app.cli.options.session import session_from
from app.cli.options.shading import add_shading
from app.cli.performing import add_performing, perform
from app.cli.work import Run
from app.session import Session, Settled

if TYPE_CHECKING:
    from lutcore.arrays import FloatArray


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    output = add_mesh(parser)
    add_shading(parser, words)
    add_curvature(parser, words)
    add_colors(parser)
    add_picture(parser)
    add_performing(parser, output)


def run(arguments: argparse.Namespace) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    int
        Exit code.
    """
    return perform(arguments, session_of, _shade)


def session_of(arguments: argparse.Namespace) -> Session:
    """Return the session that the arguments describe.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    Session
        Of this command's view.

    Raises
    ------
    SessionError, ParameterError
        If a file or a value is not right.
    """
    return session_from(arguments, view="shade")


def _shade(work: Run) -> int:
    from app import export
    from lutcore.color import auto_exposure
    from lutcore.shading import AUTO

    work.require(".png", ".vtp", ".ply", ".npz")
    warnings = work.warn()
    exposure = work.session.exposure
    camera = None
    if work.output.suffix.lower() == ".png":
        made = work.draw()
        exposure, camera = made.exposure, made.camera
        exitance = work.exitance(camera)
    else:
        exitance = work.exitance()
        exposure = exposure or auto_exposure(exitance)
        mesh = work.pipeline.subject(work.session).mesh
        export.save(work.output, mesh, export.shading_arrays(exitance, exposure))
    settled, cast = work.settled(camera), work.casting(camera)
    result = work.summary(warnings)
    if work.arguments.json:  # else nobody would read it
        result |= _told(work, settled, cast, exposure, exitance)
    chosen = ""
    if work.session.model.name == AUTO:
        chosen = f", shaded with {settled.label}{', and casting shadows' if cast else ''}"
    return work.finish(result, f"wrote {work.output}{chosen}")


def _told(
    work: Run, settled: Settled, cast: bool, exposure: float | None, exitance: "FloatArray"
) -> dict[str, object]:
    from lutcore.statistics import percentiles

    seen = work.pipeline.detail(work.session)
    return {
        "material": work.pipeline.material(work.session).name,
        "profile": work.session.profile.name,
        "model": work.session.model.name,
        "settled": settled.as_json(),
        "shadows": cast,
        "scale": work.pipeline.scale(work.session),
        "widths": None if seen is None else seen.widths.tolist(),
        "exposure": exposure,
        "exitance": {
            name: percentiles(exitance[:, channel])
            for channel, name in enumerate(("red", "green", "blue"))
        },
    }
