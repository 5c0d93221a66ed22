"""The session of one output: what the single commands would take, where nobody says it."""

from typing import Any

import msgspec
from msgspec.structs import replace

from app import contestants
from app.batch.job import Fields
from app.session import Method, Session
from lutcore.errors import ParameterError

# As `curvelight figure`, `compare`, `curvature --quantity all` and `curvature -o X.html` have them.
_FIGURE, _REPORT = (1700, 1000), (1800, 900)
_GRID, _GRID_OF_NINE = (2200, 1100), (1800, 1650)
_VIEWS = {"report": "curvature"}
# What only some outputs show; the others' sessions do not say it.
_ONLY_FOR = {
    "compared": ("compare",),
    "compared_by": ("compare",),
    "wipe": ("compare",),
    "difference": ("compare",),
    "peers": ("curvature", "report"),
}
_FEWEST = 2


def session_of(fields: Fields, output: str, mesh: str) -> Session:
    """Return the session that draws one output of one mesh.

    Parameters
    ----------
    fields : dict
        What was said, checked by `app.batch.job_file.checked`.
    output : str
        Of `app.batch.job.OUTPUTS`.
    mesh : str
        The mesh.

    Returns
    -------
    Session
        With the frame and the quantity that the single command would take.
    """
    view = _VIEWS.get(output, output)
    fields = {
        name: value for name, value in fields.items() if output in _ONLY_FOR.get(name, (output,))
    }
    try:
        session = msgspec.convert(fields | {"mesh": mesh, "view": view}, Session)
    except (msgspec.ValidationError, ValueError) as error:
        # Each part was checked, so it is what they come to together.
        raise ParameterError(f"{output} of {mesh}: {error}") from None
    if output == "report":
        session = replace(session, quantity="all")
    elif output == "curvature" and session.peers and "quantity" not in fields:
        session = replace(session, quantity="disagreement")
    size = _size(session, output)
    return session if size is None or "size" in fields else replace(session, size=size)


def _size(session: Session, output: str) -> tuple[int, int] | None:
    if output == "figure":
        return _FIGURE
    if output == "report":
        return _REPORT
    if output == "curvature" and session.quantity == "all":
        return _GRID_OF_NINE if session.peers else _GRID
    if output == "compare":
        return contestants.size(session)
    return None


def check(session: Session, output: str, known: set[bytes]) -> None:
    """Make sure, before any mesh is read, that a session names what exists.

    Parameters
    ----------
    session : Session
        See `session_of`.
    output : str
        What it draws.
    known : set of bytes
        Sessions that were looked at; this one is added.

    Raises
    ------
    ParameterError
        If a name or a parameter does not exist, or the output needs another field.
    """
    key = msgspec.json.encode(replace(session, mesh=""))
    if key in known:
        return
    known.add(key)
    if output == "compare" and len(session.compared) < _FEWEST:
        raise ParameterError("compare needs two models or more: set `compared`, or say --models")
    contestants.check(session)
    if output == "figure" and session.quantity == "all":
        raise ParameterError("a figure shows one quantity; choose one instead of all")
    if isinstance(session.camera, str):
        from app.camera import parse

        parse(session.camera)
    for part in (session, *contestants.alone(session)):
        if isinstance(part.material, str):
            from lutcore.materials import material

            material(part.material)
    _check_methods(session)


def _check_methods(session: Session) -> None:
    from lutcore.diffusion import profile_registry
    from lutcore.estimation import estimator_registry
    from lutcore.parameters import create
    from lutcore.shading import model_registry

    parts = (session, *contestants.alone(session))
    named: list[tuple[Any, tuple[Method, ...]]] = [
        (model_registry, tuple(part.model for part in parts)),
        (estimator_registry, (*(part.estimator for part in parts), *session.peers)),
        (profile_registry, (session.profile,)),
    ]
    for registry, methods in named:
        for method in methods:
            label = f"{registry.kind} {method.name!r}"
            create(registry.get(method.name), label, dict(method.parameters))
