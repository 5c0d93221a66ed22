"""Animations from the picture commands: their flags, and one run."""

import argparse

from msgspec.structs import replace

from app.animation_motion import LIGHT_SWEEP, MP4, SUFFIXES, TURNTABLE, Motion
from app.cli.console import note
from app.cli.work import Run
from app.ground import ground
from lutcore.errors import ParameterError


def add_animation(parser: argparse.ArgumentParser, lights: bool) -> None:
    """Add the flags of animations.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    lights : bool
        Whether the command's pictures have lights that can turn.
    """
    group = parser.add_argument_group(
        "animation, with -o NAME.gif or NAME.mp4",
        "One exposure for all frames: the least that eight of them, over the turn, would choose.",
    )
    kinds = {TURNTABLE: "turn the object once about the up axis; camera and lights stay"}
    if lights:
        kinds[LIGHT_SWEEP] = "turn the lights once about the up axis; the rest stays"
    for name, doc in kinds.items():
        group.add_argument(
            f"--{name}",
            type=_seconds,
            nargs="?",
            const=Motion.seconds,
            metavar="SECONDS",
            help=f"{doc} ({Motion.seconds:g} s)",
        )
    group.add_argument(
        "--fps",
        type=float,
        metavar="N",
        help=f"frames in a second ({Motion.fps:g}); a GIF shows each for whole hundredths",
    )


def is_animation(arguments: argparse.Namespace) -> bool:
    """Tell whether an animation is asked for.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used `add_animation`.

    Returns
    -------
    bool
        True where the output is one.

    Raises
    ------
    ParameterError
        If the flags and the output do not fit.
    """
    given = [name for name in ("turntable", "light_sweep") if vars(arguments).get(name) is not None]
    moving = arguments.output is not None and arguments.output.suffix.lower() in SUFFIXES
    if moving and len(given) != 1:
        raise ParameterError("an animation needs one of --turntable and --light-sweep")
    if not moving and (given or arguments.fps is not None):
        flag = given[0].replace("_", "-") if given else "fps"
        raise ParameterError(f"--{flag} makes an animation: write -o NAME.gif or NAME.mp4")
    return moving


def animate(work: Run) -> int:
    """Make the animation of a session, and say so.

    Parameters
    ----------
    work : Run
        The command at work.

    Returns
    -------
    int
        Exit code.
    """
    from app.animation import stage
    from app.animation_files import write_animation

    arguments = work.arguments
    asked = _motion(arguments)
    motion = asked.kept_by(work.output)
    if motion != asked:
        note(arguments, f"a GIF counts in hundredths: {motion.fps:.4g} frames in a second")
    work.require(*SUFFIXES)
    if ground(work.session.background).transparent:
        # A GIF's pixels are there or not, which frays outlines; MP4 has no alpha at all.
        raise ParameterError(
            "animations cannot be transparent: say --background COLOR, or draw pictures with -o "
            "NAME.png"
        )
    if work.output.suffix.lower() == MP4:
        width, height = (side + side % 2 for side in work.session.size)
        if (width, height) != work.session.size:
            note(arguments, f"MP4 needs even sizes: {width} x {height}")
            work.session = replace(work.session, size=(width, height))
    warnings = work.warn()
    scene = stage(work.session, work.pipeline, motion)
    write_animation(work.output, scene, work.pipeline)
    result = work.summary(warnings) | {
        "motion": motion.kind,
        "frames": motion.count,
        "fps": motion.fps,
        "exposure": scene.session.exposure,
    }
    return work.finish(result, f"wrote {work.output}: {motion.count} frames")


def _motion(arguments: argparse.Namespace) -> Motion:
    turning = arguments.turntable is not None
    seconds = arguments.turntable if turning else arguments.light_sweep
    fps = Motion.fps if arguments.fps is None else arguments.fps
    return Motion(TURNTABLE if turning else LIGHT_SWEEP, seconds, fps)


def _seconds(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no number of seconds; name the mesh before this flag"
        ) from None
