"""Which model a scene was shaded with, where it was left open: named, recorded and taken again."""

import hashlib
from dataclasses import fields
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from app.contestants import alone
from app.session import Directional, Method, Session, Settled
from lutcore.arrays import FloatArray
from lutcore.blend import Blend
from lutcore.parameters import create
from lutcore.shading import AUTO, ShadingModel, model_registry

if TYPE_CHECKING:
    from app.pipeline import Pipeline

_DIGITS = 6


def settled(model: ShadingModel) -> Settled:
    """Name a model that `lutcore.shading.ShadingModel.settled` returned.

    Parameters
    ----------
    model : ShadingModel
        A registered model, or a blend of two.

    Returns
    -------
    Settled
        Its name, with the parameters that are not at their default.
    """
    if isinstance(model, Blend):
        return Settled(_method(model.good), _method(model.cheap), model.limit, model.exposure)
    return Settled(_method(model))


def model_of(one: Settled) -> ShadingModel:
    """Return the model that was named.

    Parameters
    ----------
    one : Settled
        From `settled`.

    Returns
    -------
    ShadingModel
        The same.

    Raises
    ------
    ParameterError
        If a name does not exist here, or a parameter is out of range.
    """
    good = _created(one.method)
    if one.cheaper is None or one.limit is None:
        return good
    return Blend(_created(one.cheaper), good, one.limit, one.exposure)


def taken(
    session: Session, pipeline: "Pipeline", model: Method, axes: FloatArray
) -> Settled | None:
    """Return what the session says that `auto` came to in its scene.

    Parameters
    ----------
    session : Session
        Everything but its own model is used.
    pipeline : Pipeline
        Where its mesh comes from.
    model : Method
        The shading model.
    axes : ndarray, shape=(3, 3)
        The camera's axes, for lights that move with it.

    Returns
    -------
    Settled or None
        None where it does not say so, or of another scene.
    """
    if model.name != AUTO or not session.settled:
        return None
    scene = _scene(session, pipeline, model, axes)
    return next((one for one in session.settled if one.scene == scene), None)


def recorded(session: Session, pipeline: "Pipeline", axes: FloatArray) -> Session:
    """Return a session that says what `auto` came to, for machines where models cost otherwise.

    Parameters
    ----------
    session : Session
        Any session; what it says of scenes that it does not draw is left out.
    pipeline : Pipeline
        The one that drew it.
    axes : ndarray, shape=(3, 3)
        The camera's axes, for lights that move with it.

    Returns
    -------
    Session
        With an entry for each scene that is shaded with `auto`.

    Raises
    ------
    MeshError, ParameterError
        If it cannot be drawn.
    """
    found: dict[str, Settled] = {}
    for one in alone(session):
        if one.view != "curvature" and one.model.name == AUTO:
            scene = _scene(one, pipeline, one.model, axes)
            chosen = pipeline.settled(one, one.model, axes)
            found[scene] = replace(settled(chosen), scene=scene)
    return replace(session, settled=tuple(found.values()))


def _scene(session: Session, pipeline: "Pipeline", model: Method, axes: FloatArray) -> str:
    """Return what tells a scene from others on every machine, as a short hash."""
    moving = any(isinstance(one, Directional) and one.frame == "camera" for one in session.lights)
    parts: tuple[object, ...] = (
        pipeline.subject(session).loaded.digest,
        session.volume,
        session.repairs,
        pipeline.mm_per_unit(session),
        session.material,
        session.profile,
        session.estimator,
        session.scale,
        session.lights,
        model,
        # + 0.0 makes -0.0 the same.
        (np.round(axes, _DIGITS) + 0.0).tolist() if moving else None,
    )
    if session.casts != "off":  # what was recorded without them holds; films say on for auto
        parts = (*parts, "shadows")
    text = msgspec.json.encode(parts, order="sorted")
    return hashlib.sha256(text).hexdigest()[:16]


def _created(method: Method) -> ShadingModel:
    plugin = model_registry.get(method.name)
    return create(plugin, f"shading model {method.name!r}", dict(method.parameters))


def _method(model: ShadingModel) -> Method:
    values = {field.name: (getattr(model, field.name), field.default) for field in fields(model)}
    changed = {name: value for name, (value, default) in values.items() if value != default}
    return Method(model_registry.name_of(type(model)), changed)
