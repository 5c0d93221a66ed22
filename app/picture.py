"""From a session to its picture: which surfaces, from where, in which colours."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app import camera as cameras
from app.colormaps import PAPER, table
from app.pipeline import Pipeline, Subject
from app.quantities import QUANTITIES, robust_range
from app.render import STRIP, Image, Panel, draw
from app.scene import ColorScale, Surface
from app.session import Camera, Method, Session
from lutcore.arrays import FloatArray
from lutcore.color import auto_exposure, srgb_bytes, srgb_decode
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.fresnel import transmittance

_BAR_PIXELS_PER_HEIGHT = 0.16
_LEAST_BAR = 110.0
_MOST_BAR = 0.35
_LEAST_WIDTH = 32


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture and what a caller may want to say of it.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3)
        sRGB, the first row at the top.
    camera : Camera
        Where it was taken from.
    exposure : float or None
        The exposure, where something was shaded.
    range : tuple of 2 floats or None
        Ends of the colour bar, where there is one.
    difference : dict of str to float or None
        Mean, 99th percentile and maximum of CIEDE2000 over the vertices, where it was asked for.
    """

    image: Image
    camera: Camera
    exposure: float | None
    range: tuple[float, float] | None
    difference: dict[str, float] | None


def render(session: Session, pipeline: Pipeline) -> Picture:
    """Return the picture that a session describes.

    Parameters
    ----------
    session : Session
        Any session.
    pipeline : Pipeline
        Where arrays come from.

    Returns
    -------
    Picture
        The same for the same session and mesh, bit for bit, on one machine.

    Raises
    ------
    MeshError, ParameterError, DrawingError
        If the mesh, a parameter or the machine does not allow it.
    """
    return _Studio(session, pipeline).picture()


class _Studio:
    """One session on its way to a picture."""

    def __init__(self, session: Session, pipeline: Pipeline) -> None:
        self.session = session
        self.pipeline = pipeline
        self.subject: Subject = pipeline.subject(session)
        bar = max(_BAR_PIXELS_PER_HEIGHT * session.size[1], _LEAST_BAR)
        self.bar_share = min(bar / session.size[0], _MOST_BAR)
        self.has_bar = session.view in ("curvature", "figure") or session.difference
        self.count = {
            "shade": 1,
            "curvature": 1,
            "figure": 2,
            "compare": len(session.compared) + session.difference,
        }[session.view]
        if session.view == "compare" and len(session.compared) < 2:
            raise ParameterError("a comparison needs two models or more")
        self.width = (1.0 - self.bar_share * self.has_bar) / self.count
        if self.width * session.size[0] < _LEAST_WIDTH:
            raise ParameterError(
                f"a picture {session.size[0]} pixels wide leaves less than {_LEAST_WIDTH} for "
                "each surface; make it wider"
            )
        aspect = self.width * session.size[0] / (session.size[1] * (1.0 - STRIP))
        self.camera = cameras.camera_of(session.camera, self.subject, aspect)
        self.axes = cameras.axes(self.camera)
        self.exposure: float | None = session.exposure
        self.range: tuple[float, float] | None = None
        self.difference: dict[str, float] | None = None

    def picture(self) -> Picture:
        """Draw."""
        view = self.session.view
        panels: list[Panel] = []
        if view in ("shade", "figure"):
            panels.append(self._shaded(self.session.model))
        if view == "compare":
            panels += self._comparison()
        if view in ("curvature", "figure"):
            panels += self._curvature()
        self.pipeline.progress(0.95, "drawing")
        image = draw(panels, self.session.size, self.session.background)
        return Picture(image, self.camera, self.exposure, self.range, self.difference)

    def _shaded(self, model: Method) -> Panel:
        linear = self._linear(model)
        rgb = self._display(linear)
        material = self.pipeline.material(self.session).name
        size = self.pipeline.mm_per_unit(self.session)
        caption = f"{material}, {model.name}, {size:g} mm per unit"
        return Panel(self._surface(rgb=rgb, caption=caption), self.width, self.camera)

    def _linear(self, model: Method) -> FloatArray:
        """Light towards the camera, times pi: exitance, exit Fresnel factor, albedo."""
        exitance = self.pipeline.exitance(self.session, model, self.axes)
        # Kolchin 2007, eq. 6: L_o = F_t(N_o . w_o) / pi times the exitance.
        linear = exitance * self._exit_transmittance()[:, None]
        colors = self.subject.loaded.colors
        if self.session.albedo and colors is not None:
            linear *= srgb_decode(colors)
        return linear

    def _exit_transmittance(self) -> FloatArray:
        normals = self._curvatures().normals
        if self.camera.height is None:
            towards = np.asarray(self.camera.position) - self.subject.mesh.vertices
            towards /= np.linalg.norm(towards, axis=1, keepdims=True)
            cosine = np.einsum("ij,ij->i", normals, towards)
        else:
            cosine = normals @ self.axes[2]
        # A surface seen from behind, through a hole, is shown as its front would be.
        return transmittance(np.abs(cosine), self.pipeline.material(self.session).eta)

    def _display(self, linear: FloatArray) -> NDArray[np.uint8]:
        if self.exposure is None:
            self.exposure = auto_exposure(linear)
        return srgb_bytes(linear, self.exposure)

    def _curvatures(self) -> PrincipalCurvatures:
        return self.pipeline.curvatures(self.session)

    def _curvature(self) -> list[Panel]:
        name = self.session.quantity
        size = self.pipeline.mm_per_unit(self.session)
        values = QUANTITIES[name].values(self._curvatures(), size)
        self.range = self.session.range or robust_range(values, self.session.symmetric)
        colors = table(self.session.colormap or PAPER)
        if self.session.flip:
            colors = colors[::-1]
        scale = ColorScale(colors, *self.range, QUANTITIES[name].title)
        # Infinite errors are drawn at the end of the scale.
        shown = np.nan_to_num(values, posinf=self.range[1])
        surface = self._surface(values=shown, scale=scale, lit=not self.session.flat)
        return [Panel(surface, self.width, self.camera), Panel(scale, self.bar_share)]

    def _comparison(self) -> list[Panel]:
        linear = [self._linear(model) for model in self.session.compared]
        shown = [self._display(light) for light in linear]
        panels = [
            Panel(self._surface(rgb=rgb, caption=model.name), self.width, self.camera)
            for rgb, model in zip(shown, self.session.compared, strict=True)
        ]
        return panels + (self._difference(shown[0], shown[1]) if self.session.difference else [])

    def _difference(self, one: NDArray[np.uint8], other: NDArray[np.uint8]) -> list[Panel]:
        from lutcore.metrics import ciede2000

        values = ciede2000(one, other)
        self.difference = {
            "mean": float(values.mean()),
            "p99": float(np.percentile(values, 99.0)),
            "max": float(values.max()),
        }
        self.range = self.session.range or (0.0, max(1.0, self.difference["p99"]))
        scale = ColorScale(table(self.session.colormap or "magma"), *self.range, "CIEDE2000")
        first, second = (model.name for model in self.session.compared[:2])
        surface = self._surface(values=values, scale=scale, caption=f"{second} against {first}")
        return [Panel(surface, self.width, self.camera), Panel(scale, self.bar_share)]

    def _surface(
        self,
        *,
        rgb: NDArray[np.uint8] | None = None,
        values: FloatArray | None = None,
        scale: ColorScale | None = None,
        lit: bool = False,
        caption: str = "",
    ) -> Surface:
        normals = self._curvatures().normals
        return Surface(self.subject.mesh, normals, rgb, values, scale, lit, caption)
