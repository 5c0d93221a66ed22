"""A session's lights in world coordinates."""

from typing import TYPE_CHECKING

from app.session import Cone, Directional, Point, Session
from lutcore.arrays import FloatArray

if TYPE_CHECKING:
    from lutcore.lights import Light


def world_lights(session: Session, axes: FloatArray) -> "list[Light]":
    """Return the session's lights in world coordinates.

    Parameters
    ----------
    session : Session
        Its lights are used.
    axes : ndarray, shape=(3, 3)
        The camera's axes, for lights that move with it.

    Returns
    -------
    list of DirectionalLight, PointLight and ConeLight
        As `lutcore.shade` takes them.
    """
    from lutcore.lights import ConeLight, DirectionalLight, PointLight

    lights: list[Light] = []
    for light in session.lights:
        if isinstance(light, Directional):
            direction = axes.T @ light.direction if light.frame == "camera" else light.direction
            lights.append(DirectionalLight(direction, light.irradiance))
        elif isinstance(light, Point):
            lights.append(PointLight(light.position, light.intensity))
        elif isinstance(light, Cone):
            lights.append(ConeLight(light.position, light.direction, light.intensity, light.angle))
    return lights
