"""From a session to its picture: which surfaces, from where, in which colours."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app import camera as cameras
from app.backend import Backend
from app.colormaps import PAPER, table
from app.pipeline import Pipeline, Subject
from app.render import STRIP, Image, Panel, draw
from app.scene import ColorScale, Surface
from app.session import Camera, Method, Session
from app.shown import names_shown, shown
from lutcore.arrays import FloatArray
from lutcore.color import auto_exposure, srgb_bytes, srgb_decode
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.fresnel import transmittance

_BAR_PIXELS_PER_HEIGHT = 0.16
_GRID_BAR = 0.26
_LEAST_BAR = 110.0
_MOST_BAR = 0.35
_LEAST_WIDTH = 32
# Panels side by side where each quantity has its own: eight fill two rows, nine three.
_COLUMNS = (4, 3, 1)


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
    ranges : dict of str to tuple of 2 floats
        Ends of the colour bars by quantity, ``ciede2000`` for a difference.
    difference : dict of str to dict, or None
        By model the mean, 99th percentile and maximum over the vertices of CIEDE2000 against the
        first one, where it was asked for.
    backend : Backend
        What drew it.
    """

    image: Image
    camera: Camera
    exposure: float | None
    ranges: dict[str, tuple[float, float]]
    difference: dict[str, dict[str, float]] | None
    backend: Backend

    @property
    def range(self) -> tuple[float, float] | None:
        """Ends of the colour bar, where there is one and only one."""
        return next(iter(self.ranges.values())) if len(self.ranges) == 1 else None


@dataclass(frozen=True, eq=False)
class Composition:
    """What a picture holds, before it is drawn: a window draws the same.

    Parameters
    ----------
    session : Session
        What was asked for.
    panels : tuple of Panel
        From left to right, and row by row from the top.
    rows : int
        Equally high rows.
    camera : Camera
        Of all panels with a mesh.
    exposure : float or None
        The exposure, where something was shaded.
    ranges : dict of str to tuple of 2 floats
        See `Picture`.
    difference : dict of str to dict, or None
        See `Picture`.
    """

    session: Session
    panels: tuple[Panel, ...]
    rows: int
    camera: Camera
    exposure: float | None
    ranges: dict[str, tuple[float, float]]
    difference: dict[str, dict[str, float]] | None


def compose(session: Session, pipeline: Pipeline) -> Composition:
    """Return what the picture of a session holds, all colours computed.

    Parameters
    ----------
    session : Session
        Any session.
    pipeline : Pipeline
        Where arrays come from.

    Returns
    -------
    Composition
        For `app.render.draw`, or for a window.

    Raises
    ------
    MeshError, ParameterError
        If the mesh or a parameter does not allow it.
    """
    return _Studio(session, pipeline).composition()


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
    made = compose(session, pipeline)
    pipeline.progress(0.95, "drawing")
    drawn = draw(made.panels, session.size, session.background, made.rows)
    return Picture(
        drawn.image, made.camera, made.exposure, made.ranges, made.difference, drawn.backend
    )


def _grid(session: Session) -> tuple[int, int]:
    """Return how many surfaces lie side by side, and in how many rows."""
    if session.view == "curvature":
        count = len(names_shown(session))
        columns = next(columns for columns in _COLUMNS if count % columns == 0)
        return columns, count // columns
    if session.view == "figure":
        if session.quantity == "all":
            raise ParameterError("a figure shows one quantity; choose one instead of all")
        return 2, 1
    if session.view != "compare":
        return 1, 1
    if _below(session):
        return len(session.compared), 2
    return len(session.compared) + session.difference, 1


def _below(session: Session) -> bool:
    """Tell whether differences lie below the models: where there are several."""
    return session.view == "compare" and session.difference and len(session.compared) > 2


class _Studio:
    """One session on its way to a picture."""

    def __init__(self, session: Session, pipeline: Pipeline) -> None:
        self.session = session
        self.pipeline = pipeline
        self.subject: Subject = pipeline.subject(session)
        self.below = _below(session)
        self.has_bar = session.view in ("curvature", "figure") or session.difference
        self.has_bar = self.has_bar and not self.below
        self.columns, self.rows = _grid(session)
        share = _BAR_PIXELS_PER_HEIGHT if self.rows == 1 else _GRID_BAR
        bar = max(share * session.size[1] / self.rows, _LEAST_BAR)
        bars = self.columns if session.view == "curvature" else int(self.has_bar)
        self.bar_share = min(bar / session.size[0], _MOST_BAR / max(bars, 1))
        if session.view == "compare" and len(session.compared) < 2:
            raise ParameterError("a comparison needs two models or more")
        self.width = (1.0 - self.bar_share * bars) / self.columns
        if self.width * session.size[0] < _LEAST_WIDTH:
            raise ParameterError(
                f"a picture {session.size[0]} pixels wide leaves less than {_LEAST_WIDTH} for "
                "each surface; make it wider"
            )
        aspect = self.width * session.size[0] / (session.size[1] * (1.0 / self.rows - STRIP))
        self.camera = cameras.camera_of(session.camera, self.subject, aspect)
        self.axes = cameras.axes(self.camera)
        self.exposure: float | None = session.exposure
        self.ranges: dict[str, tuple[float, float]] = {}
        self.difference: dict[str, dict[str, float]] | None = None

    def composition(self) -> Composition:
        """Compute all colours."""
        view = self.session.view
        panels: list[Panel] = []
        if view in ("shade", "figure"):
            panels.append(self._shaded(self.session.model))
        if view == "compare":
            panels += self._comparison()
        if view in ("curvature", "figure"):
            panels += [
                panel for name in names_shown(self.session) for panel in self._curvature(name)
            ]
        return Composition(
            self.session,
            tuple(panels),
            self.rows,
            self.camera,
            self.exposure,
            self.ranges,
            self.difference,
        )

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

    def _curvature(self, name: str) -> list[Panel]:
        found = shown(self.session, self.pipeline, name)
        self.ranges[name] = found.low, found.high
        colors = table(self.session.colormap or PAPER)
        if self.session.flip:
            colors = colors[::-1]
        alone = self.columns == 1 or self.session.view == "figure"
        title, caption = (found.quantity.title, "") if alone else ("", found.quantity.heading)
        scale = ColorScale(colors, found.low, found.high, title)
        # Infinite errors are drawn at the end of the scale.
        values = np.nan_to_num(found.values, posinf=found.high)
        lit = not self.session.flat
        surface = self._surface(values=values, scale=scale, lit=lit, caption=caption)
        return [Panel(surface, self.width, self.camera), Panel(scale, self.bar_share)]

    def _comparison(self) -> list[Panel]:
        linear = [self._linear(model) for model in self.session.compared]
        shown = [self._display(light) for light in linear]
        panels = [
            Panel(self._surface(rgb=rgb, caption=model.label), self.width, self.camera)
            for rgb, model in zip(shown, self.session.compared, strict=True)
        ]
        return panels + (self._differences(shown) if self.session.difference else [])

    def _differences(self, shown: Sequence[NDArray[np.uint8]]) -> list[Panel]:
        """Draw how far models are from the first: one beside them, several below."""
        from lutcore.metrics import ciede2000

        first, *others = self.session.compared
        values = [ciede2000(shown[0], other) for other in shown[1 : None if self.below else 2]]
        self.difference = {
            model.label: {
                "mean": float(one.mean()),
                "p99": float(np.percentile(one, 99.0)),
                "max": float(one.max()),
            }
            for one, model in zip(values, others, strict=False)
        }
        most = max(one["p99"] for one in self.difference.values())
        ends = self.session.range or (0.0, max(1.0, most))
        self.ranges["ciede2000"] = ends
        scale = ColorScale(table(self.session.colormap or "magma"), *ends, "CIEDE2000")
        maps = [
            self._surface(values=one, scale=scale, caption=f"{model.name} against {first.name}")
            for one, model in zip(values, others, strict=False)
        ]
        panels = [Panel(surface, self.width, self.camera) for surface in maps]
        bar = Panel(scale, self.width if self.below else self.bar_share)
        return [bar, *panels] if self.below else [*panels, bar]

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
