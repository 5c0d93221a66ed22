"""Entry point: finds the command, runs it, and turns errors into messages and exit codes."""

import argparse
import os
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType

from app.cli.console import clear_line, note
from app.cli.parser import Parser
from lutcore.compiling import when_compiling
from lutcore.errors import CancelledError, CurvelightError, MeshError, ParameterError

_COMPILING = "compiling for this machine, once; that can take a minute"
# Name: what it does. The command's module is imported only when it is used.
COMMANDS = {
    "view": "the window: inspect, shade and compare a mesh",
    "figure": "the paper's Figure 1: shading left, curvature right",
    "curvature": "measure curvature: a picture, or data",
    "shade": "shade as a translucent material: a picture, or data",
    "compare": "shading models side by side",
    "draw": "a saved session again, whatever it shows",
    "verify": "redraw a picture from its own metadata, and compare",
    "choose": "which shading model is enough for a scene, and why",
    "stability": "where curvature estimators and shading models fail, and by how much",
    "chart": "speed against accuracy, and one recommendation",
    "batch": "draw many meshes, each in a process of its own; take up what was interrupted",
    "lut": "a material's tables as npz, EXR or PNG",
    "models": "list shading models, diffusion profiles, curvature estimators and their parameters",
    "materials": "list materials",
    "samples": "list sample meshes",
    "doctor": "say whether this machine can draw, and what is missing",
}

OK, FAULT, USAGE, UNREADABLE, NO_SURFACE, INTERRUPTED = 0, 1, 2, 3, 4, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Without the program's name; those of this process if not given.

    Returns
    -------
    int
        Exit code: 0 fine, 1 fault, 2 usage, 3 file cannot be read, 4 no usable surface in it,
        5 part of a batch failed, 6 a picture differs.
    """
    words = _joined(list(sys.argv[1:] if arguments is None else arguments))
    verbose = "--verbose" in words
    try:
        code = _run_to_exit(words)
        # Here rather than at the interpreter's end, where a reader that left could not be caught.
        sys.stdout.flush()
        return code
    except KeyboardInterrupt:
        return _fail("interrupted; nothing was half written", INTERRUPTED, verbose)
    except BrokenPipeError:
        # The reader of our output left (curvelight samples | head); the rest has nowhere to go.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OK
    except CurvelightError as error:
        return _fail(str(error), exit_code(error), verbose)
    except MemoryError:
        return _fail("not enough memory; decimate the mesh or close programs", FAULT, verbose)
    except Exception as error:  # the last line of defence: a message, never a bare traceback
        return _fail(
            f"fault in the program: {type(error).__name__}: {error}; "
            "run again with --verbose and report what it prints",
            FAULT,
            verbose,
        )


def exit_code(error: CurvelightError) -> int:
    """Return the exit code for an error.

    Parameters
    ----------
    error : CurvelightError
        What was raised.

    Returns
    -------
    int
        See `main`.
    """
    from app.session import SessionError

    if isinstance(error, MeshError):
        from app.loading import UnreadableFileError

        return UNREADABLE if isinstance(error, UnreadableFileError) else NO_SURFACE
    if isinstance(error, ParameterError):
        return USAGE
    if isinstance(error, SessionError):
        return UNREADABLE
    return INTERRUPTED if isinstance(error, CancelledError) else FAULT


def _fail(message: str, code: int, verbose: bool) -> int:
    clear_line()
    if verbose:
        traceback.print_exc()
    print(f"curvelight: {message}", file=sys.stderr)  # noqa: T201
    return code


def _run_to_exit(words: list[str]) -> int:
    try:
        return _run(words)
    except SystemExit as stop:  # argparse, after help or a usage error
        return stop.code if isinstance(stop.code, int) else USAGE


def _run(words: list[str]) -> int:
    name = words[0] if words and not words[0].startswith("-") else None
    if name is None or name not in COMMANDS:
        _overview().parse_args(words or ["--help"])
        return OK
    module = import_module(f"app.cli.{name}")
    parser = Parser(
        f"curvelight {name}",
        description=module.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    return _command(module, parser, words[1:])


def _command(module: ModuleType, parser: argparse.ArgumentParser, words: list[str]) -> int:
    module.add_arguments(parser, words)
    parser.add_argument("--verbose", action="store_true", help="show tracebacks")
    parser.add_argument("--quiet", action="store_true", help="print errors only")
    arguments = parser.parse_args(words)
    when_compiling(lambda: note(arguments, _COMPILING))
    code: int = module.run(arguments)
    return code


def _overview() -> argparse.ArgumentParser:
    width = max(map(len, COMMANDS))
    listing = "\n".join(f"  {name:{width}}  {what}" for name, what in COMMANDS.items())
    parser = argparse.ArgumentParser(
        "curvelight",
        description="Curvature of scanned surfaces, and translucent shading from it.",
        epilog=f"commands:\n{listing}\n\n"
        "curvelight COMMAND --help tells more. sample:NAME stands wherever MESH does.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    parser.add_argument("command", choices=[*COMMANDS], metavar="COMMAND")
    return parser


class _Version(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        print(f"curvelight {version('curvelight')}")  # noqa: T201
        parser.exit()


def _joined(words: list[str]) -> list[str]:
    """Join ``--light -1,0,0`` to ``--light=-1,0,0``: argparse would take -1,0,0 for a flag."""
    joined: list[str] = []
    for word in words:
        vector = word[:1] == "-" and word[1:2] in "0123456789." and "," in word
        if vector and joined and joined[-1].startswith("--") and "=" not in joined[-1]:
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined
