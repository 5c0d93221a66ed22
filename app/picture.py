"""From a session to its picture: which surfaces, from where, in which colours."""

import dataclasses
from dataclasses import dataclass

import numpy as np
from msgspec.structs import replace

from app import camera as cameras
from app.backend import Backend
from app.colormaps import PAPER, table
from app.comparison import Place, Single, compared
from app.composition import Composition
from app.contestants import alone, bars, check, labels, tiles
from app.differences import Difference
from app.fading import faded
from app.leaving import leaving, view_of
from app.pipeline import Pipeline
from app.render import STRIP, Image, Panel, draw
from app.scene import ColorScale, Surface
from app.session import Camera, Method, Session
from app.settling import settled
from app.shown import names_shown, shown
from app.steps.subject import Subject
from app.texturing import Coat
from lutcore.arrays import FloatArray
from lutcore.color import product_bytes, product_exposure
from lutcore.errors import ParameterError
from lutcore.shading import AUTO

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
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB, the first row at the top.
    camera : Camera
        Where it was taken from.
    exposure : float or None
        The exposure, where something was shaded.
    ranges : dict of str to tuple of 2 floats
        Ends of the colour bars by quantity, ``ciede2000`` for a difference of colours and
        ``difference`` for one of a quantity.
    difference : dict of str to Difference, or None
        How far each of the compared is from the first, where it was asked for: CIEDE2000, or in
        the unit of the quantity that estimators are compared by.
    backend : Backend
        What drew it.
    """

    image: Image
    camera: Camera
    exposure: float | None
    ranges: dict[str, tuple[float, float]]
    difference: dict[str, Difference] | None
    backend: Backend

    @property
    def range(self) -> tuple[float, float] | None:
        """Ends of the colour bar, where there is one and only one."""
        return next(iter(self.ranges.values())) if len(self.ranges) == 1 else None


def compose(
    session: Session, pipeline: Pipeline, held: float | None = None, drafted: bool = False
) -> Composition:
    """Return what the picture of a session holds, all colours computed.

    Parameters
    ----------
    session : Session
        Any session.
    pipeline : Pipeline
        Where arrays come from.
    held : float, optional
        Exposure where the session leaves it open: while a light is dragged, one that follows it
        would flicker.
    drafted : bool
        Whether nearly the right colours are enough, for a light that is dragged; see
        `Pipeline.exitance`.

    Returns
    -------
    Composition
        For `app.render.draw`, or for a window.

    Raises
    ------
    MeshError, ParameterError
        If the mesh or a parameter does not allow it.
    """
    with pipeline.still():
        return _Studio(session, pipeline, held, drafted).composition()


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
    return picture_of(made)


def picture_of(made: Composition) -> Picture:
    """Draw what was composed.

    Parameters
    ----------
    made : Composition
        From `compose`.

    Returns
    -------
    Picture
        See `render`.

    Raises
    ------
    DrawingError
        If this machine has no working OpenGL.
    """
    session = made.session
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
    return tiles(session) if session.view == "compare" else (1, 1)


class _Studio:
    """One session on its way to a picture."""

    def __init__(
        self, session: Session, pipeline: Pipeline, held: float | None, drafted: bool
    ) -> None:
        self.session = session
        self.pipeline = pipeline
        self.drafted = drafted
        self.subject: Subject = pipeline.subject(session)
        check(session)
        self.columns, self.rows = _grid(session)
        comparing = session.view == "compare"
        share = _BAR_PIXELS_PER_HEIGHT if self.rows == 1 else _GRID_BAR
        height = session.size[1] / self.rows
        if comparing:  # whose bars go over all rows
            share, height = _BAR_PIXELS_PER_HEIGHT, session.size[1]
        bar = max(share * height, _LEAST_BAR)
        counts = {"curvature": self.columns, "figure": 1}
        count = bars(session) if comparing else counts.get(session.view, 0)
        self.bar_share = min(bar / session.size[0], _MOST_BAR / max(count, 1))
        self.width = (1.0 - self.bar_share * count) / self.columns
        if self.width * session.size[0] < _LEAST_WIDTH:
            raise ParameterError(
                f"a picture {session.size[0]} pixels wide leaves less than {_LEAST_WIDTH} for "
                "each surface; make it wider"
            )
        aspect = self.width * session.size[0] / (session.size[1] * (1.0 / self.rows - STRIP))
        self.camera = view_of(session, pipeline, aspect)
        self.axes = cameras.axes(self.camera)
        self.exposure: float | None = held if session.exposure is None else session.exposure
        self.ranges: dict[str, tuple[float, float]] = {}
        self.difference: dict[str, Difference] | None = None

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
        material = self.pipeline.material(self.session).name
        size = self.pipeline.mm_per_unit(self.session)
        caption = f"{material}, {self._named(model)}, {size:g} mm per unit"
        return Panel(self._lit(model, caption), self.width, self.camera)

    def _lit(self, model: Method, caption: str) -> Surface:
        """Show a model's light; a texture is drawn by the pixel."""
        if self.exposure is None:
            self.exposure = self._exposure(model)
        light = self.pipeline.exitance(self.session, model, self.axes, self.drafted)
        rgb = product_bytes(light, self._leaving(), self.exposure)
        facing = self.pipeline.facing(self.session)
        surface = Surface(self.subject.mesh, facing, rgb, caption=caption)
        texture = self.subject.loaded.texture
        if texture is None or not self.session.albedo:
            return surface
        light = light * self._leaving(textured=False) * self.exposure
        return dataclasses.replace(surface, coat=Coat(texture, light.astype(np.float32)))

    def _named(self, model: Method) -> str:
        if model.name != AUTO:
            return model.name
        found = settled(self.pipeline.settled(self.session, model, self.axes))
        return f"{model.name}: {found.label}"

    def _exposure(self, model: Method) -> float:
        # Kolchin 2007, eq. 6: L_o = F_t(N_o . w_o) / pi times the exitance.
        light = self.pipeline.exitance(self.session, model, self.axes)
        return product_exposure(light, self._leaving())

    def _leaving(self, textured: bool = True) -> FloatArray:
        return leaving(self.session, self.pipeline, self.camera, textured)

    def _curvature(self, name: str) -> list[Panel]:
        found = shown(self.session, self.pipeline, name)
        self.ranges[name] = found.low, found.high
        colors = table(self.session.colormap or PAPER)
        if self.session.flip:
            colors = colors[::-1]
        alone = self.columns == 1 or self.session.view == "figure"
        title, caption = (found.quantity.title, "") if alone else ("", found.quantity.heading)
        strokes = self.pipeline.strokes(self.session) if self.session.strokes else None
        if self.session.strokes and strokes is None:
            none = f"{self.session.estimator.name} gives no directions"
            caption = f"{caption} ({none})" if caption else none
        scale = ColorScale(colors, found.low, found.high, title)
        # Infinite errors are drawn at the end of the scale.
        values = np.nan_to_num(found.values, posinf=found.high)
        measured = self.pipeline.curvatures(self.session)
        surface = Surface(
            self.subject.mesh,
            measured.normals,
            rgb=faded(values, scale, measured) if self.session.fade else None,
            values=values,
            scale=scale,
            lit=not self.session.flat,
            caption=caption,
            strokes=strokes,
        )
        return [Panel(surface, self.width, self.camera), Panel(scale, self.bar_share)]

    def _comparison(self) -> list[Panel]:
        place = Place(self.camera, self.width, self.bar_share)
        singles = self._curved() if self.session.compared_by == "estimator" else self._colored()
        made = compared(self.session, singles, place)
        self.difference = made.difference
        self.ranges |= made.ranges
        return list(made.panels)

    def _colored(self) -> list[Single]:
        """Shade what is compared under one exposure: a darker one is to look darker."""
        studios = [self._studio(one) for one in alone(self.session)]
        if self.exposure is None:
            # Models are of one material, so nearly as bright as the first. Among materials the
            # brightest decides: what is clipped could not be compared.
            counted = studios if self.session.compared_by == "material" else studios[:1]
            self.exposure = min(one._exposure(one.session.model) for one in counted)
        everywhere = np.ones(len(self.subject.mesh.vertices), dtype=bool)
        singles = []
        for one, label in zip(studios, labels(self.session), strict=True):
            one.exposure = self.exposure
            model = one.session.model
            left_open = model.name == AUTO and self.session.compared_by == "model"
            caption = one._named(model) if left_open else label
            singles.append(Single(one._lit(model, caption), everywhere))
        return singles

    def _curved(self) -> list[Single]:
        """Measure with each estimator, all in one range that is wide enough for each."""
        name = self.session.quantity
        sessions = alone(self.session)
        found = [shown(one, self.pipeline, name) for one in sessions]
        ends = min(one.low for one in found), max(one.high for one in found)
        self.ranges[name] = ends
        singles = []
        for session, label in zip(sessions, labels(self.session), strict=True):
            studio = self._studio(replace(session, range=ends))
            surface = studio._curvature(name)[0].content
            assert isinstance(surface, Surface)
            said = f"{label} ({surface.caption})" if surface.caption else label
            surface = dataclasses.replace(surface, caption=said)
            singles.append(Single(surface, self.pipeline.curvatures(studio.session).estimated))
        return singles

    def _studio(self, session: Session) -> "_Studio":
        placed = replace(session, camera=self.camera)
        return _Studio(placed, self.pipeline, None, self.drafted)
