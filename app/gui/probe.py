"""The probe: what is under the mouse, and what was pinned. Knows no Qt."""

import csv
import io
from collections.abc import Callable

from psygnal import Signal

from app.gui import orbit
from app.gui.controller import Controller
from app.probing import COLUMNS, Probe, nearest_vertex, probe, with_readings
from app.session import Camera, Session
from lutcore.progress import Progress


class Probing:
    """Asks what is under the mouse, off the window's thread; the newest question counts.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    found = Signal(object)
    """Emitted with the Probe under the mouse, None where there is nothing."""
    pins_changed = Signal()
    """Emitted when a pin was set or removed."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.current: Probe | None = None
        self.pins: list[Probe] = []
        controller.shown.connect(self._on_shown)

    def look(self, camera: Camera, right: float, up: float) -> None:
        """Ask for what is under the mouse.

        Parameters
        ----------
        camera : Camera
            Of the view.
        right, up : float
            Where the mouse is; see `app.gui.orbit.ray`.
        """
        self._ask("probe", camera, right, up, self._show)

    def pin(self, camera: Camera, right: float, up: float) -> None:
        """Keep what is under the mouse now in the table, wherever it goes meanwhile.

        Parameters
        ----------
        camera : Camera
            Of the view.
        right, up : float
            See `look`.
        """
        self._ask("pin", camera, right, up, self._pin)

    def _ask(
        self,
        key: str,
        camera: Camera,
        right: float,
        up: float,
        done: Callable[[Probe | None], None],
    ) -> None:
        outcome = self._controller.outcome
        if outcome is None:
            return
        session, pipeline = outcome.session, self._controller.pipeline
        start, direction = orbit.ray(camera, right, up)
        exposure = outcome.composition.exposure

        def ask(progress: Progress) -> Probe | None:
            vertex = nearest_vertex(session, pipeline, start, direction)
            if vertex is None:
                return None
            found = probe(session, pipeline, vertex)
            if exposure is None:  # nothing is shaded in this view
                return found
            return with_readings(found, session, pipeline, camera, exposure)

        self._controller.run(key, ask, done)

    def leave(self) -> None:
        """Forget what is under the mouse: it left the view."""
        self._show(None)

    def _pin(self, found: Probe | None) -> None:
        self._show(found)
        if found is None:
            return
        # A vertex is pinned once.
        kept = [one for one in self.pins if (one.mesh, one.vertex) != (found.mesh, found.vertex)]
        self.pins = [*kept, found]
        self.pins_changed.emit()

    def unpin(self, index: int | None = None) -> None:
        """Remove a pin.

        Parameters
        ----------
        index : int, optional
            Its place in `pins`; all if left out.
        """
        if index is None:
            self.pins = []
        else:
            del self.pins[index]
        self.pins_changed.emit()

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Return the pins as a table.

        Returns
        -------
        head : list of str
            `app.probing.COLUMNS`, then what the models say.
        rows : list of list of str
            One for each pin; empty cells where a pin does not have a value.
        """
        rows = [one.row() for one in self.pins]
        more = dict.fromkeys(name for row in rows for name in row if name not in COLUMNS)
        head = [*COLUMNS, *more]
        return head, [[_text(row.get(name, "")) for name in head] for row in rows]

    def as_csv(self) -> str:
        """Return the pins as comma-separated values.

        Returns
        -------
        str
            With a line of names; numbers with all their digits.
        """
        head, _ = self.table()
        out = io.StringIO()
        writer = csv.DictWriter(out, head, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(one.row() for one in self.pins)
        return out.getvalue()

    def _show(self, found: Probe | None) -> None:
        self.current = found
        self.found.emit(found)

    def _on_shown(self, outcome: object) -> None:
        session: Session = self._controller.session
        kept = [one for one in self.pins if one.mesh == session.mesh]
        if len(kept) != len(self.pins):
            self.pins = kept
            self.pins_changed.emit()


def _text(value: float | int | str) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
