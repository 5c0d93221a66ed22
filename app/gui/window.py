"""The main window: a view, docks around it, menus above, and what goes on below."""

from collections.abc import Callable
from functools import partial
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtGui import QAction, QCloseEvent
from qtpy.QtWidgets import QMainWindow, QMenu, QVBoxLayout, QWidget

from app.composition import Composition
from app.gui import docks, menus
from app.gui.actions import MENUS, Action, Actions
from app.gui.background import Background
from app.gui.banner import Banner
from app.gui.canvas import Canvas
from app.gui.coarse import coarse
from app.gui.comparing import Comparing
from app.gui.controller import SESSION_SUFFIX, Controller, Outcome
from app.gui.faults import Faults
from app.gui.fitting import fit
from app.gui.journal import Journal
from app.gui.keys import Keys
from app.gui.layout import Layout
from app.gui.light_tool import LightTool
from app.gui.lights import Lights
from app.gui.open_menus import add_open_menus
from app.gui.pixel_path import PixelPath
from app.gui.poster import Poster
from app.gui.progress_bar import ProgressBar
from app.gui.rescue import Rescue
from app.gui.settings import Settings
from app.gui.shortcuts import Shortcuts
from app.gui.status import Status
from app.gui.unit_bar import UnitBar
from app.gui.units import Units
from app.gui.unsaved import Answer, ask, may_leave
from app.gui.vision import Vision
from app.session import Camera, Session
from app.steps.subject import Subject

# About as many triangles as a software renderer turns smoothly.
_COARSE = 30_000


class Window(QMainWindow):
    """One document in one window.

    Parameters
    ----------
    session : Session, optional
        What to begin with.
    settings : Settings, optional
        What is remembered between runs.
    """

    def __init__(self, session: Session | None = None, settings: Settings | None = None) -> None:
        super().__init__()
        self.settings = settings or Settings()
        self.ask_unsaved: Callable[[Window], Answer] = ask
        """Asks a person about unsaved changes."""
        self._poster = Poster()
        self.controller = Controller(self._poster.post, session)
        self.journal = Journal(self.controller)
        self.setAcceptDrops(True)
        fit(self, 1280, 800)
        self.canvas = Canvas(self)
        self.background = Background(self.controller)
        self.lights = Lights(self.controller, lambda: self.canvas.camera)
        self.light_tool = LightTool(self.canvas, self.controller, self.lights)
        self.canvas.tools.append(self.light_tool)
        self.banner = Banner(self)
        self.faults = Faults(self)
        middle = QWidget(self)
        column = QVBoxLayout(middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.banner)
        self.vision = Vision(self.controller)
        self.units = Units(self.controller, self.settings)
        self.unit_bar = UnitBar(middle, self.units)
        column.addWidget(self.unit_bar)
        column.addWidget(self.canvas, 1)
        self.setCentralWidget(middle)
        self.progress = ProgressBar(self, self.controller.cancel)
        self.statusBar().addPermanentWidget(self.progress)
        self._connect()
        self.pixel_path = PixelPath(self.controller, self.canvas, self.settings)
        self.statusBar().addPermanentWidget(Status(self.canvas, lambda: self.pixel_path.reason))
        self.comparing = Comparing(self.controller, self.canvas)
        self.docks = docks.add_all(self)
        self.keys = Keys(self)
        self.actions_ = Actions()
        self.shortcuts = Shortcuts(self.actions_, self.settings)
        self.shortcuts.changed.connect(self._on_shortcut)
        self.qactions: dict[str, QAction] = {}
        menus.add_all(self)
        self._make_menus()
        add_open_menus(self)
        self.layout_ = Layout(self)
        self._retitle()

    def start(self) -> None:
        """Ask for the first picture."""
        self.controller.refresh()

    def _connect(self) -> None:
        self.rescue = Rescue(self)
        controller = self.controller
        controller.previewed.connect(self._on_previewed)
        controller.shown.connect(self._on_shown)
        self.vision.changed.connect(self._on_vision)
        controller.loaded.connect(self._on_loaded)
        controller.failed.connect(self.banner.warn)
        controller.noted.connect(lambda text: self.statusBar().showMessage(text, 8000))
        controller.standing.connect(self.progress.tell)
        controller.document.changed.connect(self._on_changed)
        controller.document.history_changed.connect(self._retitle)
        self.canvas.moved.connect(controller.look)
        self.canvas.resized.connect(controller.resize)

    def _on_changed(self, session: Session, before: Session) -> None:
        if isinstance(session.camera, Camera) and session.camera != self.canvas.camera:
            self.canvas.place_camera(session.camera)
        if session.lights != before.lights:
            self.canvas.stir()

    def _on_previewed(self, grey: Composition) -> None:
        if self.controller.outcome is None:
            self.canvas.show_composition(grey, grey.camera)
            self.canvas.repaint()

    def _on_shown(self, outcome: Outcome) -> None:
        # The camera may have moved on while the colours were computed.
        newest = self.controller.session.camera
        made = outcome.composition
        camera = newest if isinstance(newest, Camera) else made.camera
        self.canvas.show_composition(self.vision.seen(made), camera)

    def _on_vision(self) -> None:
        if self.controller.outcome is not None:
            self._on_shown(self.controller.outcome)

    def _on_loaded(self, subject: Subject) -> None:
        if not self.banner.offering:
            self.banner.hide()
        self.settings.used(self.controller.session.mesh)
        self.canvas.give_coarse(None)
        make = partial(coarse, subject.mesh, _COARSE)
        self.controller.run("coarse", lambda _: make(), self.canvas.give_coarse)

    def _retitle(self) -> None:
        document = self.controller.document
        name = document.path.name if document.path else document.session.mesh.rpartition("/")[2]
        self.setWindowTitle(f"{name}[*] - Curvelight")
        self.setWindowModified(document.dirty)
        self.refresh_actions()

    def _make_menus(self) -> None:
        bar = self.menuBar()
        self.menus: dict[str, QMenu] = {}
        for title in MENUS:
            self.menus[title] = bar.addMenu(f"&{title}")
        for action in self.actions_:
            self._menu(action.menu).addAction(self._qaction(action))
        for title in MENUS:
            self.menus[title].aboutToShow.connect(self.refresh_actions)
        self.refresh_actions()

    def _menu(self, title: str) -> QMenu:
        if title not in self.menus:
            parent, _, name = title.rpartition("/")
            self.menus[title] = self._menu(parent).addMenu(name)
        return self.menus[title]

    def _qaction(self, action: Action) -> QAction:
        made = QAction(action.text, self)
        made.setObjectName(action.name)
        made.setStatusTip(action.doc)
        made.setToolTip(action.doc)
        made.setShortcut(self.shortcuts.key(action.name))
        made.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        if action.checked is not None:
            made.setCheckable(True)
        made.triggered.connect(lambda *_: self.act(action))
        self.addAction(made)
        self.qactions[action.name] = made
        return made

    def _on_shortcut(self, name: str) -> None:
        self.qactions[name].setShortcut(self.shortcuts.key(name))

    def act(self, action: Action) -> None:
        """Do an action, and show its state and that of all others.

        Parameters
        ----------
        action : Action
            One of `actions_`.
        """
        action.run()
        self.refresh_actions()

    def refresh_actions(self) -> None:
        """Show which actions can be done, and which are on."""
        for name, made in getattr(self, "qactions", {}).items():
            action = self.actions_[name]
            if action.enabled is not None:
                made.setEnabled(action.enabled())
            if action.checked is not None:
                made.setChecked(action.checked())

    def dragEnterEvent(self, event: Any) -> None:  # noqa: N802
        """Accept files."""
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event: Any) -> None:  # noqa: N802
        """Open the first file that was dropped."""
        files = [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]
        session = bool(files) and files[0].lower().endswith(SESSION_SUFFIX)
        if files and (not session or may_leave(self)):
            self.controller.open(files[0])
            event.acceptProposedAction()

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802
        """End what runs; a person is asked before what is unsaved goes."""
        if event.spontaneous() and not may_leave(self):
            event.ignore()
            return
        self.faults.remove()
        self.rescue.close()
        self.layout_.keep()
        self.controller.close()
        self.canvas.Finalize()
        super().closeEvent(event)
