"""What is known of one point of a surface: its curvature with error bars, each model's colour."""

from dataclasses import dataclass, replace

import numpy as np

from app.pipeline import Pipeline
from app.session import Camera, Method, Session, Vector
from lutcore.arrays import FloatArray

COLUMNS = (
    "vertex",
    "x",
    "y",
    "z",
    "k1",
    "k2",
    "k1_error",
    "k2_error",
    "error",
    "mean",
    "gauss",
    "shape_index",
    "curvedness",
    "scale",
)


@dataclass(frozen=True)
class Reading:
    """What a model gives at a vertex.

    Parameters
    ----------
    model : str
        Its name, with its parameters.
    color : tuple of 3 ints
        As the picture shows it, sRGB, 0 to 255.
    exitance : tuple of 3 floats
        Radiant exitance, linear RGB.
    error : float or None
        Predicted error in units of R_d and the largest irradiance, of the channel that is worst;
        None where the model predicts none.
    """

    model: str
    color: tuple[int, int, int]
    exitance: Vector
    error: float | None


@dataclass(frozen=True)
class Probe:
    """What is known of a vertex.

    Parameters
    ----------
    mesh : str
        The session's mesh.
    vertex : int
        Its index.
    position : tuple of 3 floats
        Mesh units.
    values : dict of str to float
        By name of the quantity, as `app.quantities` says, and the sigmas of k1 and of k2 alone,
        k1_error and k2_error; in millimetres.
    readings : tuple of Reading
        One for each local model; empty where they were not asked for.
    """

    mesh: str
    vertex: int
    position: Vector
    values: dict[str, float]
    readings: tuple[Reading, ...] = ()

    def row(self) -> dict[str, float | int | str]:
        """Return all numbers by name, for a table.

        Returns
        -------
        dict of str to number or str
            `COLUMNS`, then for each model its colour as ``#rrggbb`` and its predicted error.
        """
        x, y, z = self.position
        row: dict[str, float | int | str] = {"vertex": self.vertex, "x": x, "y": y, "z": z}
        row |= self.values
        for one in self.readings:
            row[f"{one.model} color"] = "#{:02x}{:02x}{:02x}".format(*one.color)
            row[f"{one.model} error"] = "" if one.error is None else one.error
        return row


def nearest_vertex(
    session: Session, pipeline: Pipeline, start: FloatArray, direction: FloatArray
) -> int | None:
    """Return the vertex that lies nearest to where a line of sight meets the surface.

    Parameters
    ----------
    session : Session
        Its mesh is used.
    pipeline : Pipeline
        Where it comes from.
    start, direction : ndarray, shape=(3,)
        The line, mesh units; see `app.gui.orbit.ray`.

    Returns
    -------
    int or None
        A corner of the triangle that is met; None if none is.
    """
    from lutcore.picking import first_hit

    mesh = pipeline.subject(session).mesh
    hit = first_hit(mesh, start, direction)
    if hit is None:
        return None
    corners = mesh.faces[hit.face]
    distance = np.linalg.norm(mesh.vertices[corners] - hit.position, axis=1)
    return int(corners[np.argmin(distance)])


def probe(session: Session, pipeline: Pipeline, vertex: int) -> Probe:
    """Return the curvature at a vertex.

    Parameters
    ----------
    session : Session
        Its mesh and estimator are used.
    pipeline : Pipeline
        Where arrays come from.
    vertex : int
        Index of the vertex.

    Returns
    -------
    Probe
        Without readings.
    """
    from app.quantities import QUANTITIES

    subject, curvatures = pipeline.subject(session), pipeline.curvatures(session)
    size = pipeline.mm_per_unit(session)
    values = {
        name: float(quantity.values(curvatures, size)[vertex])
        for name, quantity in QUANTITIES.items()
        if quantity.attribute
    }
    alone = {"k1_error": curvatures.error1, "k2_error": curvatures.error2}
    values |= {name: float(bars[vertex]) / size for name, bars in alone.items()}
    x, y, z = (float(one) for one in subject.mesh.vertices[vertex])
    return Probe(session.mesh, vertex, (x, y, z), values)


def with_readings(
    found: Probe, session: Session, pipeline: Pipeline, camera: Camera, exposure: float
) -> Probe:
    """Return the same with what each local model gives there, in the shadows that are cast.

    Parameters
    ----------
    found : Probe
        Of `probe`.
    session : Session
        Its material, lights, shadows and detail are used.
    pipeline : Pipeline
        Where arrays come from.
    camera : Camera
        Where the surface is seen from.
    exposure : float
        The picture's.

    Returns
    -------
    Probe
        With `readings`, the session's own model first.
    """
    from app.camera import axes
    from lutcore.blend import at
    from lutcore.exitance import exitance
    from lutcore.prediction import Scene
    from lutcore.shading import shading_models
    from lutcore.tolerance import relative

    frame = axes(camera)
    inputs = pipeline.shadowed(session, frame)
    assert inputs.curvatures is not None
    chosen = np.array([found.vertex])
    scene = Scene.of(inputs, inputs.curvatures)
    irradiance, scene = scene.irradiance, scene.at(chosen)
    here = at(inputs, chosen)
    seen = _seen(session, pipeline, camera, found.vertex)
    others = [Method(name) for name in shading_models() if name != session.model.name]
    readings = []
    for method in (session.model, *others):
        model = pipeline.settled(session, method, frame)
        if not model.local:
            continue
        # A blend knows from the whole mesh what it is at a vertex.
        light = exitance(model, inputs)[chosen] if model.joint else exitance(model, here)
        errors = model.predicted_error(scene)
        error = None if errors is None else float(relative(errors, irradiance)[0])
        readings.append(_reading(method, light, light * seen, exposure, error))
    return replace(found, readings=tuple(readings))


def _seen(session: Session, pipeline: Pipeline, camera: Camera, vertex: int) -> FloatArray:
    """Return the factor from exitance to what the picture shows, as `app.picture` has it."""
    from app.leaving import leaving

    found = leaving(session, pipeline, camera)[vertex]
    return np.asarray(np.broadcast_to(found, (3,)))


def _reading(
    method: Method, light: FloatArray, shown: FloatArray, exposure: float, error: float | None
) -> Reading:
    from lutcore.color import srgb_bytes

    red, green, blue = (int(one) for one in srgb_bytes(shown, exposure)[0])
    r, g, b = (float(one) for one in light[0])
    return Reading(method.label, (red, green, blue), (r, g, b), error)
