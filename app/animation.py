"""Sessions that move: what turns, by how much, and what stays the same in every frame.

A turntable turns the object: camera and lights stay, so shading is made again for each frame. In
the object's own axes, camera and lights turn the other way. A light sweep turns the lights and
leaves the rest. Both go round once, about the camera's up axis through what it looks at, and end
where they began, so that they can be repeated.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from msgspec.structs import replace

from app import camera as cameras
from app.animation_framing import framed
from app.animation_motion import Motion
from app.comparison import CIEDE2000
from app.picture import Picture, compose, render
from app.pipeline import Pipeline
from app.render import Image
from app.session import Camera, Cone, Directional, Point, Session, Vector
from app.settling import settled
from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError
from lutcore.progress import part
from lutcore.shading import AUTO

Light = Directional | Point | Cone
_PROBES = 8


@dataclass(frozen=True, eq=False)
class Scene:
    """An animation whose camera, exposure and ranges are settled for all frames.

    Parameters
    ----------
    asked : Session
        The picture that moves, as it was asked for.
    session : Session
        The first frame: it says its camera and its exposure, and the range of differences.
    motion : Motion
        What turns.
    centre : ndarray, shape=(3,)
        A point of the axis.
    axis : ndarray, shape=(3,)
        Up, of unit length.
    """

    asked: Session
    session: Session
    motion: Motion
    centre: FloatArray
    axis: FloatArray

    def frame(self, index: int) -> Session:
        """Return the session of a frame.

        Parameters
        ----------
        index : int
            From 0; the count of frames is the first one again.

        Returns
        -------
        Session
            What to render.
        """
        from scipy.spatial.transform import Rotation

        angle = 2.0 * np.pi * index / self.motion.count
        turned = self.motion.turns_object
        rotation = Rotation.from_rotvec((-angle if turned else angle) * self.axis).as_matrix()
        camera = self.session.camera
        assert isinstance(camera, Camera)
        frame = cameras.axes(camera)
        lights = tuple(
            self._turned(light, rotation, None if turned else frame)
            for light in self.session.lights
        )
        if turned:
            camera = replace(
                camera,
                position=self._around(rotation, camera.position),
                target=self._around(rotation, camera.target),
                up=_vector(rotation @ camera.up),
            )
        return replace(self.session, camera=camera, lights=lights)

    def _turned(self, light: Light, rotation: FloatArray, frame: FloatArray | None) -> Light:
        """Turn a light; one that is fixed to the camera only where the camera's axes are given."""
        if isinstance(light, Directional):
            if light.frame == "world":
                return replace(light, direction=_vector(rotation @ light.direction))
            if frame is None:
                return light
            turned = rotation @ frame.T @ np.asarray(light.direction)
            return replace(light, direction=_vector(turned), frame="world")
        light = replace(light, position=self._around(rotation, light.position))
        if isinstance(light, Cone):
            light = replace(light, direction=_vector(rotation @ light.direction))
        return light

    def _around(self, rotation: FloatArray, point: Vector) -> Vector:
        return _vector(self.centre + rotation @ (np.asarray(point) - self.centre))


def stage(session: Session, pipeline: Pipeline, motion: Motion) -> Scene:
    """Settle what all frames of an animation share.

    A camera that the session does not give is set so far away that the object stays in the
    picture as it turns. An exposure that it does not give is the least of those that eight frames
    over the turn would choose for themselves: the brightest one is as bright as a single picture
    would be, and none is brighter. Differences of models get the widest range of the eight. What
    the first frame's `auto` chooses shades them all, and shadows are cast where they may matter.

    Parameters
    ----------
    session : Session
        The picture that moves.
    pipeline : Pipeline
        Where arrays come from.
    motion : Motion
        What turns.

    Returns
    -------
    Scene
        Ready for `frames`.

    Raises
    ------
    ParameterError
        If lights shall turn in a picture that has none.
    """
    measured = session.view == "curvature" or (
        session.view == "compare" and session.compared_by == "estimator"
    )
    if measured and not motion.turns_object:
        raise ParameterError("curvature is drawn without lights; use --turntable")
    asked, first = session, compose(session, pipeline)
    if not measured:
        session = _decided(session, pipeline, first.camera)
    camera = first.camera
    centre = np.asarray(camera.target)
    axis = np.asarray(camera.up) / np.linalg.norm(camera.up)
    if motion.turns_object and not isinstance(session.camera, Camera):
        camera = framed(first, pipeline, centre, axis)
    scene = Scene(asked, replace(session, camera=camera), motion, centre, axis)
    if measured:
        return scene
    probes = [
        compose(scene.frame(round(i * motion.count / _PROBES)), pipeline) for i in range(_PROBES)
    ]
    exposures = [probe.exposure for probe in probes if probe.exposure is not None]
    ranges = [probe.ranges[CIEDE2000] for probe in probes if CIEDE2000 in probe.ranges]
    fixed = replace(scene.session, exposure=min(exposures))
    if ranges:
        lows, highs = zip(*ranges, strict=True)
        fixed = replace(fixed, range=(min(lows), max(highs)))
    return Scene(asked, fixed, motion, centre, axis)


def frames(scene: Scene, pipeline: Pipeline, every: int = 1) -> Iterator[Picture]:
    """Draw the frames of an animation, one after another.

    Parameters
    ----------
    scene : Scene
        See `stage`.
    pipeline : Pipeline
        Where arrays come from: curvature is computed once, shading for each frame.
    every : int
        Draw only each so many.

    Yields
    ------
    Picture
        One after another.
    """
    told, count = pipeline.progress, scene.motion.count
    try:
        for index in range(0, count, every):
            pipeline.progress = part(told, index / count, (index + every) / count)
            yield render(scene.frame(index), pipeline)
    finally:
        pipeline.progress = told


def palette_frames(scene: Scene, pipeline: Pipeline) -> Iterator[Image]:
    """Draw a few frames over the whole turn, whose colours stand for all.

    Parameters
    ----------
    scene, pipeline
        See `frames`.

    Returns
    -------
    iterator of ndarray of uint8, shape=(height, width, 3)
        Their pixels.
    """
    few = frames(scene, pipeline, max(1, scene.motion.count // _PROBES))
    return (picture.image for picture in few)


def _decided(session: Session, pipeline: Pipeline, camera: Camera) -> Session:
    """Decide once what would else be decided anew, and flicker, in each frame."""
    if session.model.name == AUTO and session.view != "compare":
        # Before shadows are: what the session says of its scene is said of it as it was asked for.
        chosen = settled(pipeline.settled(session, session.model, cameras.axes(camera)))
        session = replace(session, model=chosen.method, shadows=session.casts)
    if session.casts == "auto":
        session = replace(session, shadows="on")
    return session


def _vector(array: FloatArray) -> Vector:
    x, y, z = (float(one) for one in array)
    return x, y, z
