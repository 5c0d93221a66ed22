"""A session as a Python script that draws it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
from msgspec.structs import fields, replace

from app.samples import PREFIX
from app.session import Session, from_json, to_json

_SCRIPT = '''\
"""Draws the picture of a session with Curvelight, bit for bit."""

from pathlib import Path

from app.picture import render
from app.pipeline import Pipeline
from app.provenance import write_picture
from app.record import record_of
from app.session import {names}

session = {session}
pipeline = Pipeline()
picture = render(session, pipeline)
write_picture(Path({output!r}), picture.image, record_of(session, pipeline, picture))
'''


def script(session: Session, output: str = "picture.png") -> str:
    """Return a Python script that draws a session.

    Parameters
    ----------
    session : Session
        What is drawn.
    output : str
        The picture to write.

    Returns
    -------
    str
        Runs as it is where the package ``curvelight`` is installed.
    """
    wanted = absolute(session)
    names = sorted({type(one).__name__ for one in _structs(wanted)})
    return _SCRIPT.format(names=", ".join(names), session=_code(wanted, True), output=output)


def absolute(session: Session) -> Session:
    """Return a session as a file says it, its mesh found from every folder.

    Parameters
    ----------
    session : Session
        Any session.

    Returns
    -------
    Session
        The same.
    """
    mesh = session.mesh
    if not mesh.startswith(PREFIX):
        mesh = str(Path(mesh).resolve())
    return from_json(to_json(replace(session, mesh=mesh)))


def _structs(value: Any) -> Iterator[msgspec.Struct]:
    """Go over the structs that the code of a value names."""
    if isinstance(value, msgspec.Struct):
        yield value
        for one in _said(value).values():
            yield from _structs(one)
    elif isinstance(value, tuple):
        for one in value:
            yield from _structs(one)


def _said(value: msgspec.Struct) -> dict[str, Any]:
    """Return the fields that are not at their default."""
    found = {}
    for field in fields(value):
        now, default = getattr(value, field.name), field.default
        if default is msgspec.NODEFAULT and field.default_factory is not msgspec.NODEFAULT:
            default = field.default_factory()
        if field.required or now != default:
            found[field.name] = now
    return found


def _code(value: Any, lines: bool = False) -> str:
    """Return a value as Python."""
    if isinstance(value, msgspec.Struct):
        parts = [f"{name}={_code(one)}" for name, one in _said(value).items()]
        name = type(value).__name__
        if lines:
            return "\n".join([f"{name}(", *(f"    {part}," for part in parts), ")"])
        return f"{name}({', '.join(parts)})"
    if isinstance(value, tuple):
        inside = ", ".join(map(_code, value))
        return f"({inside},)" if len(value) == 1 else f"({inside})"
    return repr(value)
