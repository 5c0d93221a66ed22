"""A session as the command line that draws it."""

import argparse
import shlex
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

from app.scripting import absolute
from app.session import FIGURE_LIGHTS, Camera, Cone, Directional, Method, Point, Session
from lutcore.errors import CurvelightError

_TEXTS = {"material": "--material", "shadows": "--shadows", "background": "--background"}
_NUMBERS = {"mm_per_unit": "--mm-per-unit", "scale": "--scale", "exposure": "--exposure"}
_SWITCHES = {name: f"--{name}" for name in ("symmetric", "flip", "fade", "strokes", "flat")}
_PAIRS = {"range": "--range", "percentiles": "--percentiles"}


class _NotSaid(Exception):  # noqa: N818  it is no error: a file says it instead
    """Flags cannot say a value."""


class _Parser(argparse.ArgumentParser):
    """Raises where argparse would end the program."""

    def error(self, message: str) -> NoReturn:
        raise _NotSaid(message)


def command_line(session: Session, output: str = "picture.png") -> str | None:
    """Return the command that draws a session, every value as its flag.

    The flags are read back as the command reads them: they are returned only if they add up to the
    very session.

    Parameters
    ----------
    session : Session
        What is drawn.
    output : str
        The picture to write.

    Returns
    -------
    str or None
        Quoted for a shell; None where flags cannot say all: `command_of_file` can.
    """
    wanted = absolute(session)
    try:
        words = [*_words(wanted)]
        if _said_by(wanted.view, words) != wanted:
            return None
    except (_NotSaid, CurvelightError):
        return None
    return shlex.join(["curvelight", wanted.view, *words, "-o", output])


def command_of_file(session: Session, file: Path, output: str = "picture.png") -> str:
    """Return the command that draws a session that was saved.

    Parameters
    ----------
    session : Session
        Says the view.
    file : Path
        Holds the session.
    output : str
        The picture to write.

    Returns
    -------
    str
        Quoted for a shell.
    """
    words = ["curvelight", session.view, "--session", str(file.resolve()), "-o", output]
    return shlex.join(words)


def _said_by(view: str, words: list[str]) -> Session:
    """Return the session that the command of a view makes of words."""
    command = import_module(f"app.cli.{view}")
    parser = _Parser(view, allow_abbrev=False)
    command.add_arguments(parser, words)
    said: Session = command.session_of(parser.parse_args([*words, "-o", "picture.png"]))
    return said


def _words(session: Session) -> Iterator[str]:
    default = Session()
    yield session.mesh
    for name, flag in {**_TEXTS, **_NUMBERS, **_PAIRS}.items():
        value = getattr(session, name)
        if value != getattr(default, name):
            yield from _flag(flag, _text(value))
    yield from (flag for name, flag in _SWITCHES.items() if getattr(session, name))
    if not session.albedo:
        yield "--no-albedo"
    for name in ("quantity", "colormap"):
        if getattr(session, name) != getattr(default, name):
            yield from _flag(f"--{name}", getattr(session, name))
    yield from _mesh_words(session)
    yield from _method_words(session)
    if session.lights != FIGURE_LIGHTS:
        for light in session.lights:
            yield from _light(light)
    if session.camera != default.camera:
        yield from _flag("--camera", _camera(session.camera))
    # Always, for what a command takes by itself depends on its other flags.
    yield from _flag("--size", "x".join(map(str, session.size)))


def _mesh_words(session: Session) -> Iterator[str]:
    if session.volume.level is not None:
        yield from _flag("--level", _text(session.volume.level))
    if session.volume.smoothing:
        yield from _flag("--smoothing", _text(session.volume.smoothing))
    for repair in session.repairs:
        value = "" if repair.value is None else f"={_text(repair.value)}"
        yield from _flag("--repair", f"{repair.kind}{value}")


def _method_words(session: Session) -> Iterator[str]:
    default = Session()
    flags = {"estimator": "--method", "profile": "--profile", "model": "--model"}
    for name, flag in flags.items():
        method: Method = getattr(session, name)
        if method != getattr(default, name):
            yield from _flag(flag, method.name)
            for parameter, value in method.parameters.items():
                yield from _flag(f"--{parameter.replace('_', '-')}", _text(value))
    if session.compared:
        yield from _flag("--models", ",".join(one.name for one in session.compared))
    if session.compared_by != default.compared_by:
        yield from _flag("--by", session.compared_by)
    if session.wipe is not None:
        yield from _flag("--wipe", _text(session.wipe))
    if session.difference:
        yield "--difference"
    if session.peers:
        yield from _flag("--disagree", ",".join(one.name for one in session.peers))


def _light(light: Directional | Point | Cone) -> tuple[str, ...]:
    if isinstance(light, Directional):
        flag = "--light" if light.frame == "world" else "--camera-light"
        return _flag(flag, _text((*light.direction, *light.irradiance)))
    if isinstance(light, Point):
        return _flag("--point-light", _text((*light.position, *light.intensity)))
    numbers = *light.position, *light.direction, light.angle, *light.intensity
    return _flag("--cone-light", _text(numbers))


def _camera(camera: str | Camera) -> str:
    if isinstance(camera, str):
        return camera
    if camera.height is not None:
        raise _NotSaid("a parallel projection")
    return _text((*camera.position, *camera.target, *camera.up, camera.angle))


def _flag(flag: str, value: str) -> tuple[str, ...]:
    # A value that begins with a dash would be taken for a flag of its own.
    return (f"{flag}={value}",) if value.startswith("-") else (flag, value)


def _text(value: Any) -> str:
    """Return a value as a flag takes it; numbers come back bit for bit."""
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        return ",".join(map(_text, value))
    if isinstance(value, float):
        return repr(value).removesuffix(".0")
    raise _NotSaid(repr(value))
