"""The window's cost: a frame beside a plain Gouraud one, and what a light that is dragged costs.

``python -m tests.bench.window [--json]`` needs a screen (DISPLAY). Both draw the same mesh from
the same camera into windows of the same size, without multisampling, taking turns; the least time
of several frames counts. A light drag is what the window does while the mouse moves: colours
computed anew from the session and sent to the renderer, beside the frame that follows. A swipe is
a frame of two models on one surface after its divider was moved, beside a frame of one. A frame per
pixel is one of the fragment shader, with a light that moved, beside a plain one.

Where others use the machine too, seconds tell little: the last column is the ratio of the time that
processors spent, of all threads together. On a software renderer that is the whole cost.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from app.pipeline import Pipeline
from app.session import Directional, Method, Session
from tests.bench.pictures import million_triangles

_SIZE = (1024, 768)
_FRAMES = 15
_LIMITS = {
    "frame": 1.0,
    "light drag": 0.15,
    "light drag, plain frame": 0.15,
    "swipe": 1.4,
    "frame per pixel": 1.3,
}


class Ours:
    """The view of a session, in a window on the screen."""

    def __init__(self, session: Session, pipeline: Pipeline) -> None:
        import vtkmodules.vtkRenderingFreeType
        import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
        from vtkmodules.vtkRenderingCore import vtkRenderWindow

        from app.picture import compose
        from app.render import fill

        self.pipeline, self.session = pipeline, session
        self.made = compose(session, pipeline)
        self.window = vtkRenderWindow()
        self.window.SetMultiSamples(0)
        self.window.SetSize(*_SIZE)
        self.origin = self.made.camera.target
        panels = self.made.panels
        self.drawn = fill(self.window, panels, _SIZE, session.background, 1, self.origin)
        self.draw()

    def draw(self) -> None:
        """Draw a frame to its end."""
        self.window.Render()
        self.window.WaitForCompletion()

    def turn_light(self, step: int) -> None:
        """Compute and send the colours of another direction, as at one move of the mouse."""
        from app.picture import compose
        from app.scene import recolor

        first, *others = self.session.lights
        assert isinstance(first, Directional)
        x, y, z = first.direction
        moved = replace(first, direction=(x, y + 0.01 * step, z))
        session = replace(self.session, lights=(moved, *others), camera=self.made.camera)
        made = compose(session, self.pipeline, self.made.exposure, drafted=True)
        recolor(self.drawn[0].actor, made.panels[0].content)


class Plain:
    """The same mesh in PyVista, smoothly shaded by a light of its own."""

    def __init__(self, ours: Ours) -> None:
        import numpy as np
        import pyvista

        mesh, camera = ours.made.panels[0].content.mesh, ours.made.camera
        faces = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces])
        self._plotter = pyvista.Plotter(window_size=_SIZE)
        self._plotter.add_mesh(pyvista.PolyData(mesh.vertices, faces), smooth_shading=True)
        view = self._plotter.camera
        view.position, view.focal_point, view.up = camera.position, camera.target, camera.up
        view.view_angle = camera.angle
        self._plotter.show(auto_close=False, interactive=False)
        self.window = self._plotter.render_window
        self.window.SetMultiSamples(0)
        self.draw()

    def draw(self) -> None:
        """Draw a frame to its end."""
        self.window.Render()
        self.window.WaitForCompletion()


@dataclass(frozen=True)
class Cost:
    """What a call takes: seconds on the clock, and of processors, all threads together."""

    seconds: float
    busy: float

    def __add__(self, other: "Cost") -> "Cost":
        """Return what both take, one after the other."""
        return Cost(self.seconds + other.seconds, self.busy + other.busy)

    def beyond(self, other: "Cost") -> "Cost":
        """Return what it takes longer than another."""
        return Cost(max(self.seconds - other.seconds, 0.0), max(self.busy - other.busy, 0.0))


def least(*calls: Callable[[int], object]) -> list[Cost]:
    """Return the least cost of each call, the calls taking turns."""
    found: list[list[tuple[float, float]]] = [[] for _ in calls]
    for frame in range(1, _FRAMES + 1):
        for call, costs in zip(calls, found, strict=True):
            start, busy = time.perf_counter(), time.process_time()
            call(frame)
            costs.append((time.perf_counter() - start, time.process_time() - busy))
    return [Cost(*map(min, zip(*costs, strict=True))) for costs in found]


def row(what: str, label: str, ours: Cost, beside: Cost) -> dict[str, Any]:
    """Return a row of the table."""
    return {
        "what": what,
        "mesh": label,
        "ours": ours.seconds,
        "beside": beside.seconds,
        "ratio": ours.seconds / beside.seconds,
        "busy_ratio": ours.busy / beside.busy,
    }


def frame(label: str, ours: Ours, plain: Plain) -> dict[str, Any]:
    """Return the row of a frame: ours over a plain one."""
    own, other = least(lambda _: ours.draw(), lambda _: plain.draw())
    return row("frame", label, own, other)


def frame_per_pixel(label: str, ours: Ours, plain: Plain) -> dict[str, Any]:
    """Return the row of a frame of the shader after a light was moved: ours over a plain one."""
    from app.camera import axes
    from app.shader.drawing import PixelLight
    from app.shader.look import look_of

    session, made = ours.session, ours.made
    look = look_of(session, ours.pipeline, axes(made.camera))
    actors = [(ours.drawn[0].actor, None)]
    light = PixelLight(look, actors, ours.origin, session, made.camera, made.exposure or 1.0)

    def drag(step: int) -> None:
        first, *others = session.lights
        moved = replace(first, direction=(0.9, 0.3 + 0.01 * step, 0.3))
        light.move(replace(session, lights=(moved, *others)), made.camera, made.exposure or 1.0)
        ours.draw()

    own, other = least(drag, lambda _: plain.draw())
    light.remove()
    ours.draw()
    return row("frame per pixel", label, own, other)


def light_drag(label: str, ours: Ours, plain: Plain) -> list[dict[str, Any]]:
    """Return rows of a light that is dragged: computing and sending over a frame of ours or plain.

    What is sent goes to the graphics card with the frame that follows: what that one takes longer
    than the same frame drawn again is counted too.
    """
    again = [lambda _: ours.draw(), lambda _: ours.draw(), lambda _: plain.draw()]
    computed, first, drawn, other = least(ours.turn_light, *again)
    sent = computed + first.beyond(drawn)
    return [
        row("light drag", label, sent, drawn),
        row("light drag, plain frame", label, sent, other),
    ]


def swipe(label: str, ours: Ours) -> dict[str, Any]:
    """Return the row of a divider that is dragged between two models: its frame over one of one."""
    from app import wipe_shader

    compared = (Method("curvature-lut"), Method("lambert"))
    pair = replace(
        ours.session, view="compare", compared=compared, wipe=0.5, camera=ours.made.camera
    )
    both = Ours(pair, ours.pipeline)

    def drag(step: int) -> None:
        wipe_shader.place(both.drawn[0].actor, step * _SIZE[0] / (_FRAMES + 1))
        both.draw()

    own, other = least(drag, lambda _: ours.draw())
    return row("swipe", label, own, other)


def rows(folder: Path) -> list[dict[str, Any]]:
    """Measure all meshes."""
    sheet = folder / "sheet.ply"
    million_triangles(sheet)
    meshes = (
        ("44k triangles", "sample:marble-face"),
        ("166k triangles", "sample:marble-face-raw"),
        ("1M triangles", str(sheet)),
    )
    found = []
    for label, mesh in meshes:
        ours = Ours(Session(mesh=mesh, size=_SIZE), Pipeline())
        plain = Plain(ours)
        found.append(frame(label, ours, plain))
        found.append(frame_per_pixel(label, ours, plain))
        if mesh == "sample:marble-face-raw":
            found += light_drag(label, ours, plain)
            found.append(swipe(label, ours))
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = rows(Path(folder))
    if arguments.json:
        print(json.dumps(found, indent=2))
        return
    print("| what | mesh | ours | beside | ratio | at most | ratio, busy |\n|-|-|-|-|-|-|-|")
    for one in found:
        print(
            f"| {one['what']} | {one['mesh']} | {1e3 * one['ours']:.1f} ms | "
            f"{1e3 * one['beside']:.1f} ms | {one['ratio']:.2f} | {_LIMITS[one['what']]} | "
            f"{one['busy_ratio']:.2f} |"
        )


if __name__ == "__main__":
    main()
