"""The session that flags add up to."""

import argparse
from typing import Any

from msgspec.structs import replace

from app import session as state
from app.cli.options.plugins import method_from
from app.cli.options.start import started
from app.samples import PREFIX, sample
from app.session import Method, Session, Volume
from lutcore.errors import ParameterError

_PLAIN = (
    "mesh",
    "mm_per_unit",
    "material",
    "shadows",
    "exposure",
    "albedo",
    "quantity",
    "colormap",
    "range",
    "symmetric",
    "flip",
    "percentiles",
    "fade",
    "strokes",
    "flat",
    "size",
    "background",
    "compared_by",
    "wipe",
    "difference",
)
# Fields by what holds their names and the kind of plug-in.
_METHODS = {
    "estimator": ("method", "curvature estimator"),
    "profile": ("profile", "diffusion profile"),
    "model": ("model", "shading model"),
}


def session_from(arguments: argparse.Namespace, **fixed: Any) -> Session:
    """Return the session that the arguments describe.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used the functions above.
    **fixed : object
        Fields that the command decides.

    Returns
    -------
    Session
        Defaults, then the session file, then the flags.

    Raises
    ------
    SessionError, ParameterError
        If a file or a value is not right.
    """
    given = vars(arguments)
    if not (given["mesh"] or given["session"] or given["own_mesh"]):
        raise ParameterError("say which mesh: a file, sample:NAME, or --session FILE")
    start = started(given.get("session"))
    decided = {name: value for name, value in fixed.items() if value is not None}
    return state.checked(start, **(said(arguments, start) | decided))


def said(arguments: argparse.Namespace, start: Session) -> dict[str, Any]:
    """Return the fields of a session that the arguments say.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used some of the functions that add flags.
    start : Session
        What parameters of plug-ins are added to.

    Returns
    -------
    dict
        Fields that a flag was given for, also where it says what `start` says.

    Raises
    ------
    ParameterError
        If a value is not right.
    """
    given = vars(arguments)
    found = {name: given[name] for name in _PLAIN if given.get(name) is not None}
    if given.get("camera"):
        from app.camera import parse

        found["camera"] = parse(given["camera"])
    for field in ("peers", "compared"):
        if given.get(field):
            found[field] = tuple(Method(name) for name in given[field])
    for field in ("repairs", "lights"):
        if given.get(field):
            found[field] = tuple(given[field])
    if given.get("scale") is not None:
        found["scale"] = _scale(given["scale"], found, start)
    if given.get("level") is not None or given.get("smoothing") is not None:
        found["volume"] = _volume(start.volume, given)
    for field, (flag, kind) in _METHODS.items():
        method = method_from(getattr(start, field), given, kind, flag)
        if method is not None:
            found[field] = method
    return found


def _volume(start: Volume, given: dict[str, Any]) -> Volume:
    level, smoothing = given.get("level"), given.get("smoothing")
    try:
        if level is not None:
            start = replace(start, level=None if level == "otsu" else float(level))
        return start if smoothing is None else replace(start, smoothing=smoothing)
    except ValueError:
        raise ParameterError(
            f"level = {level}, smoothing = {smoothing}: expected otsu or a number, and a number"
        ) from None


def _scale(text: str, found: dict[str, Any], start: Session) -> float | None:
    if text == "auto":
        return None
    try:
        length = float(text.removesuffix("mm"))
    except ValueError:
        raise ParameterError(f"scale = {text!r} is neither auto nor a length") from None
    return length / _mm_per_unit(text, found, start) if text.endswith("mm") else length


def _mm_per_unit(text: str, found: dict[str, Any], start: Session) -> float:
    """Return the size of a mesh unit; a file is not read for it."""
    said: float | None = found.get("mm_per_unit", start.mm_per_unit)
    mesh = found.get("mesh", start.mesh)
    if said is None and isinstance(mesh, str) and mesh.startswith(PREFIX):
        said = sample(mesh).mm_per_unit
    if said is None:
        raise ParameterError(
            f"scale = {text!r} is in mm; say how many of them a mesh unit has: --mm-per-unit N"
        )
    if not said > 0.0:
        raise ParameterError(f"mm_per_unit = {said}: expected a number > 0")
    return said
