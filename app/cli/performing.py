"""How a picture command is carried out: once, again whenever a file changes, or only in words."""

import argparse
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from app.cli.animating import add_animation, animate, is_animation
from app.cli.console import note, out
from app.cli.work import Run
from app.pipeline import Pipeline
from app.samples import PREFIX
from app.session import Session, SessionError, to_json
from app.volume import source_of
from lutcore.errors import CancelledError, CurvelightError, MeshError, ParameterError

Settle = Callable[[argparse.Namespace], Session]
Act = Callable[[Run], int]


def add_performing(
    parser: argparse.ArgumentParser, output: argparse.Action, lights: bool = True
) -> None:
    """Add the flags that say how often, and against what.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    output : Action
        The flag of the result: words need none.
    lights : bool
        Whether the command's pictures have lights.
    """
    group = parser.add_argument_group("again and again")
    group.add_argument(
        "--watch",
        action="store_true",
        help="do it again whenever the mesh or the session file changes, until Ctrl-C",
    )
    group.add_argument(
        "--print-config",
        action=_Words,
        output=output,
        help="print the session that defaults, session file and flags add up to; draw nothing",
    )
    group.add_argument(
        "--reference",
        type=Path,
        metavar="FILE.png",
        help="compare the picture with this one; exit 6 if it differs, and write "
        "OUT-difference.png: both, and CIEDE2000",
    )
    add_threshold(group)
    add_animation(parser, lights)


def add_threshold(parser: argparse._ActionsContainer) -> None:
    """Add the flag that says how much pictures may differ.

    Parameters
    ----------
    parser : ArgumentParser or group
        Of the command.
    """
    parser.add_argument(
        "--threshold",
        type=_threshold,
        metavar="T",
        help="largest CIEDE2000, averaged over 11 x 11 pixels, and an SSIM of .98 at least; "
        "without it every bit counts if the same driver, VTK and kind of processor drew both, "
        "else 5",
    )


def perform(arguments: argparse.Namespace, settle: Settle, act: Act) -> int:
    """Carry out a command.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used `add_performing`.
    settle : callable
        Returns the session that the arguments describe.
    act : callable
        Does the command's work, once.

    Returns
    -------
    int
        Exit code.

    Raises
    ------
    CurvelightError
        See `app.cli.main`.
    """
    if arguments.print_config:
        out(to_json(settle(arguments)).decode().rstrip())
        return 0
    if is_animation(arguments):
        if arguments.reference:
            raise ParameterError("a reference is compared with a picture: write -o NAME.png")
        act = animate
    if arguments.watch:
        return _watch(arguments, settle, act)
    return act(Run(arguments, settle(arguments)))


def _watch(arguments: argparse.Namespace, settle: Settle, act: Act) -> int:
    from app.watching import changes

    if arguments.json:
        raise ParameterError("--json prints one object, --watch has no end; choose one")
    with suppress(SessionError):  # that is waited for; what was typed wrong is said at once
        settle(arguments)
    if not _named(arguments, settle):
        raise ParameterError("nothing to watch: samples do not change; name a file or --session")
    pipeline = Pipeline()
    try:
        for changed in changes(lambda: _named(arguments, settle)):
            if changed:
                note(arguments, f"changed: {', '.join(map(str, changed))}")
            try:
                act(Run(arguments, settle(arguments), pipeline))
            except CancelledError:
                raise
            except CurvelightError as error:
                if not changed and not isinstance(error, MeshError | SessionError):
                    raise  # what was typed is wrong, and no file will mend it
                note(arguments, f"{error}; waiting for it to change")
            except MemoryError:
                note(arguments, "not enough memory; waiting for a smaller mesh")
    except KeyboardInterrupt:
        note(arguments, "stopped watching")
    return 0


def _named(arguments: argparse.Namespace, settle: Settle) -> tuple[Path, ...]:
    """Return the files that a command depends on."""
    files = [arguments.session] if arguments.session else []
    try:
        mesh = settle(arguments).mesh
    except CurvelightError:
        return tuple(files)  # said when it is drawn; the session may be mended
    if not mesh.startswith(PREFIX):
        # A folder of slices changes when one comes or goes.
        files += dict.fromkeys((Path(mesh), *source_of(Path(mesh)).files))
    return tuple(files)


def _threshold(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not 0.0 <= number < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is no number from 0")
    return number


class _Words(argparse.Action):
    """A flag that makes the output needless."""

    def __init__(
        self, option_strings: list[str], dest: str, output: argparse.Action, **settings: Any
    ) -> None:
        super().__init__(option_strings, dest, nargs=0, default=False, **settings)
        self._output = output

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, *_: object
    ) -> None:
        self._output.required = False
        setattr(namespace, self.dest, True)
