"""Which sessions compare what: the steps that a person takes, as changes of fields. Knows no Qt."""

from functools import cache
from typing import Any

from msgspec.structs import replace

from app.session import ComparedBy, Method, Session, Substance

MOST = 4
"""As many as the window's controls offer; a session may name more."""
LETTERS = "ABCDEFGH"
MIDDLE = 0.5
"""Where a divider begins."""
# The plainest of each kind, to hold others against; the second where the first is the session's.
_PLAIN: dict[ComparedBy, tuple[str, str]] = {
    "model": ("lambert", "curvature-lut"),
    "estimator": ("rusinkiewicz2004", "auto"),
    "material": ("marble", "skin1"),
}


@cache
def _plugins(by: ComparedBy) -> tuple[str, ...]:
    """Ask once what is installed: it takes 20 ms, and a form follows every move of the camera."""
    if by == "model":
        from lutcore.shading import model_registry

        return tuple(model_registry.names())
    from lutcore.estimation import estimator_registry

    return tuple(estimator_registry.names())


def names(session: Session, by: ComparedBy) -> list[str]:
    """Return the names that can be compared.

    Parameters
    ----------
    session : Session
        Its own material may have no other name.
    by : str
        See `Session.compared_by`.

    Returns
    -------
    list of str
        In the order of the lists elsewhere.
    """
    if by != "material":
        return list(_plugins(by))
    from lutcore.materials import materials

    known, own = list(materials()), _current(session, "material").name
    return known if own in known else [own, *known]


def sides(session: Session) -> tuple[Method, ...]:
    """Return what is compared, or would be.

    Parameters
    ----------
    session : Session
        Any session.

    Returns
    -------
    tuple of Method
        Two at least: what the session shows, and the plainest one.
    """
    if len(session.compared) >= 2:
        return session.compared
    own = _current(session, session.compared_by)
    plain, other = _PLAIN[session.compared_by]
    return own, Method(other if own.name == plain else plain)


def _current(session: Session, by: ComparedBy) -> Method:
    if by == "model":
        return session.model
    if by == "estimator":
        return session.estimator
    own = session.material
    return Method(own.name if isinstance(own, Substance) else own)


def entered(session: Session, wiped: bool | None = None) -> dict[str, Any]:
    """Return the changes that show a comparison.

    Parameters
    ----------
    session : Session
        Before.
    wiped : bool, optional
        Whether on one surface, which leaves the first two; as it was where it is left out.

    Returns
    -------
    dict
        Fields of the session.
    """
    wiped = session.wipe is not None if wiped is None else wiped
    compared = sides(session)
    changes: dict[str, Any] = {"view": "compare", "compared": compared[:2] if wiped else compared}
    changes["wipe"] = (MIDDLE if session.wipe is None else session.wipe) if wiped else None
    if session.compared_by == "estimator" and session.quantity in ("all", "disagreement"):
        changes["quantity"] = "curvedness"
    return changes


def turned_to(session: Session, by: ComparedBy) -> dict[str, Any]:
    """Return the changes that compare things of another kind.

    Parameters
    ----------
    session : Session
        Before.
    by : str
        The kind.

    Returns
    -------
    dict
        Fields of the session.
    """
    other = replace(session, compared_by=by, compared=())
    # A range that was typed in belongs to what was shown.
    return entered(other) | {"compared_by": by, "range": None}


def with_side(session: Session, index: int, method: Method | None) -> dict[str, Any]:
    """Return the changes that put something in one place, and show it.

    Parameters
    ----------
    session : Session
        Before.
    index : int
        Of the place, from 0.
    method : Method or None
        What to put there; None leaves it out, which the first two cannot be.

    Returns
    -------
    dict
        Fields of the session.
    """
    compared = list(sides(session))
    if method is None:
        del compared[max(index, 2) : max(index, 2) + 1]
    elif index < len(compared):
        compared[index] = method
    else:
        compared.append(method)
    changes = entered(replace(session, compared=tuple(compared)), wiped=False)
    if len(compared) == 2:
        changes["wipe"] = session.wipe
    return changes


def swapped(session: Session) -> dict[str, Any]:
    """Return the changes that exchange the first two.

    Parameters
    ----------
    session : Session
        Before.

    Returns
    -------
    dict
        Fields of the session.
    """
    first, second, *others = sides(session)
    return {"compared": (second, first, *others)}
