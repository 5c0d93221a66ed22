"""What a comparison compares, each as the session that draws it alone; and how they lie."""

from msgspec.structs import replace

from app.session import Session, Substance
from lutcore.errors import ParameterError

_PANEL = 800
# In a row, four would be half as large as in a square.
_SQUARE = 4


def alone(session: Session) -> tuple[Session, ...]:
    """Return the sessions that a session's picture is put together from.

    Parameters
    ----------
    session : Session
        Any session.

    Returns
    -------
    tuple of Session
        In a comparison one for each of `Session.compared`, whose own picture has the same colours
        if camera, exposure and range are given to it, with the shadows that all have; else the
        session itself.

    Raises
    ------
    ParameterError
        If a material is given parameters: it has none.
    """
    if session.view != "compare":
        return (session,)
    session = replace(session, shadows=session.casts)
    return tuple(_with(session, index) for index in range(len(session.compared)))


def labels(session: Session) -> tuple[str, ...]:
    """Return what the compared ones are called.

    Parameters
    ----------
    session : Session
        Its `compared` are used.

    Returns
    -------
    tuple of str
        Their names, with parameters that are not at their default.
    """
    return tuple(method.label for method in session.compared)


def _with(session: Session, index: int) -> Session:
    method = session.compared[index]
    if session.compared_by == "model":
        return replace(session, view="shade", model=method)
    if session.compared_by == "estimator":
        # As a measurement: the scale that is best for shading is the same for all.
        return replace(session, view="curvature", estimator=method)
    if method.parameters:
        raise ParameterError(f"material {method.name!r} has no parameters to set")
    own = session.material
    kept = isinstance(own, Substance) and own.name == method.name
    return replace(session, view="shade", material=own if kept else method.name)


def check(session: Session) -> None:
    """Make sure that a session says a comparison.

    Parameters
    ----------
    session : Session
        Any session.

    Raises
    ------
    ParameterError
        If its view is a comparison, and too few or too many are compared, or no one quantity.
    """
    if session.view != "compare":
        return
    count, kind = len(session.compared), session.compared_by
    if count < 2:
        raise ParameterError(f"a comparison needs two {kind}s or more")
    if session.wipe is not None and count != 2:
        raise ParameterError(f"a wipe is between two {kind}s, and {count} are compared")
    if kind == "estimator" and session.quantity in ("all", "disagreement"):
        raise ParameterError(
            f"quantity = {session.quantity!r} is not one number of one estimator; "
            "compare estimators by another, such as curvedness"
        )


def has_bar(session: Session) -> bool:
    """Tell whether the compared surfaces show a quantity that a colour bar explains.

    Parameters
    ----------
    session : Session
        A comparison.

    Returns
    -------
    bool
        True for estimators.
    """
    return session.compared_by == "estimator"


def below(session: Session) -> bool:
    """Tell whether differences lie below what is compared: where there are several.

    Parameters
    ----------
    session : Session
        Any session.

    Returns
    -------
    bool
        False where they lie beside it, or there are none.
    """
    return session.view == "compare" and session.difference and len(session.compared) > 2


def tiles(session: Session) -> tuple[int, int]:
    """Return how many surfaces of a comparison lie side by side, and in how many rows.

    Parameters
    ----------
    session : Session
        A comparison.

    Returns
    -------
    columns, rows : int
        Differences included; where they lie below, a colour bar stands below the first.
    """
    if below(session):
        return len(session.compared), 2
    count = len(session.compared) if session.wipe is None else 1
    if count == _SQUARE:
        return 2, 2
    return count + session.difference, 1


def bars(session: Session) -> int:
    """Return how many colour bars stand in the first row of a comparison.

    Parameters
    ----------
    session : Session
        A comparison.

    Returns
    -------
    int
        Each takes some of the width.
    """
    return has_bar(session) + (session.difference and not below(session))


def size(session: Session) -> tuple[int, int]:
    """Return a good size for the picture of a comparison.

    Parameters
    ----------
    session : Session
        A comparison.

    Returns
    -------
    width, height : int
        Pixels.
    """
    columns, rows = tiles(session)
    return _PANEL * max(columns, 1), _PANEL * rows
