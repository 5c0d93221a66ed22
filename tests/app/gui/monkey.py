"""A monkey at the window: seeded random clicks, drags, keys and files, and what came of it."""

import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import psutil
from qtpy.QtCore import QEvent, QPoint, Qt, QTimer
from qtpy.QtTest import QTest
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QWidget,
)

# Dialogs of the system and the end of the program are no business of a monkey.
_LEFT_OUT = ("file.quit",)
_DIALOG = "\N{HORIZONTAL ELLIPSIS}"
_KEYS = (Qt.Key.Key_Right, Qt.Key.Key_Left, Qt.Key.Key_Escape, Qt.Key.Key_B)
_BUTTONS = (Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton, Qt.MouseButton.MiddleButton)


@dataclass
class Findings:
    """What the monkey found.

    Parameters
    ----------
    longest : float
        Longest time that the window's thread was away from its events, seconds.
    worst : str
        What was done then.
    memory : list of int
        Resident bytes after each action.
    done : list of str
        What was done.
    """

    longest: float = 0.0
    worst: str = ""
    memory: list[int] = field(default_factory=list)
    done: list[str] = field(default_factory=list)

    def growth(self, settled: int) -> float:
        """Return how much memory grew after some first actions, as a share."""
        later = np.array(self.memory[settled:], float)
        tenth = max(len(later) // 10, 1)
        return float(np.median(later[-tenth:]) / np.median(later[:tenth]) - 1.0)


class Monkey:
    """Does random things to a window.

    Parameters
    ----------
    window : Window
        Shown, with a picture.
    meshes : sequence of str
        What it may open; some may be broken.
    seed : int
        The same seed does the same to the same window.
    """

    def __init__(self, window, meshes, seed: int) -> None:
        self.window, self.meshes = window, list(meshes)
        self.random = np.random.default_rng(seed)
        self.found = Findings()
        self._process = psutil.Process()
        # A menu under a button waits for an answer: a monkey gives none.
        self._closing = QTimer(window)
        self._closing.timeout.connect(_close_popup)
        self._closing.start(50)
        self._ways = {
            "action": (30, self._action),
            "drag": (20, self._drag),
            "wheel": (5, self._wheel),
            "widget": (40, self._widget),
            "open": (2, self._open),
            "key": (3, self._key),
        }

    def act(self, count: int) -> Findings:
        """Do some random things, one after another, without waiting for what they ask for."""
        names = list(self._ways)
        weights = np.array([self._ways[name][0] for name in names], float)
        for _ in range(count):
            name = self.random.choice(names, p=weights / weights.sum())
            self._timed(str(name), self._ways[str(name)][1])
            for _ in range(int(self.random.integers(1, 4))):
                self._timed("events", self._events)
            self.found.memory.append(self._process.memory_info().rss)
        return self.found

    def _timed(self, name: str, do) -> None:
        start = time.perf_counter()
        what = do()
        spent = time.perf_counter() - start
        said = f"{name} {what or ''}".strip()
        if name != "events":
            self.found.done.append(said)
        if spent > self.found.longest:
            last = self.found.done[-1] if self.found.done else ""
            self.found.longest, self.found.worst = spent, said if what else f"{said} after {last}"

    def _events(self) -> None:
        QApplication.processEvents()
        # What a loop of events would do, too: without one nothing that is to go ever goes.
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        time.sleep(0.002)

    def _action(self) -> str:
        allowed = [
            one
            for one in self.window.actions_
            if one.name not in _LEFT_OUT
            and not one.text.endswith(_DIALOG)
            and (one.enabled is None or one.enabled())
        ]
        one = allowed[self.random.integers(len(allowed))]
        self.window.act(one)
        return one.name

    def _at(self, widget: QWidget) -> QPoint:
        x, y = self.random.random(2)
        return QPoint(int(x * max(widget.width() - 1, 1)), int(y * max(widget.height() - 1, 1)))

    def _drag(self) -> str:
        canvas = self.window.canvas
        button = _BUTTONS[self.random.integers(3)]
        QTest.mousePress(canvas, button, pos=self._at(canvas))
        for _ in range(int(self.random.integers(0, 4))):
            QTest.mouseMove(canvas, self._at(canvas))
        QTest.mouseRelease(canvas, button, pos=self._at(canvas))
        return button.name

    def _wheel(self) -> None:
        from qtpy.QtCore import QPointF
        from qtpy.QtGui import QWheelEvent

        canvas = self.window.canvas
        at = QPointF(self._at(canvas))
        turn = QPoint(0, int(self.random.choice([-120, 120])))
        event = QWheelEvent(
            at, canvas.mapToGlobal(at), QPoint(), turn, Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(canvas, event)

    def _widget(self) -> str:
        kinds = (QAbstractButton, QAbstractSlider, QAbstractSpinBox, QComboBox)
        docks = [dock.content for dock in self.window.docks.values() if dock.content is not None]
        parts = [part for dock in docks for part in dock.findChildren(QWidget)]
        parts = [one for one in parts if one.isVisible() and one.isEnabled()]
        known = [one for one in parts if isinstance(one, kinds)] or parts
        if not known:
            return "none"
        some = known if self.random.random() < 0.8 else parts
        widget = some[self.random.integers(len(some))]
        label = widget.accessibleName() or type(widget).__name__
        if isinstance(widget, QComboBox):
            widget.setCurrentIndex(int(self.random.integers(max(widget.count(), 1))))
            widget.activated.emit(widget.currentIndex())
        elif isinstance(widget, QAbstractSlider):
            widget.setValue(int(self.random.integers(widget.minimum(), widget.maximum() + 1)))
        elif isinstance(widget, QAbstractSpinBox):
            (widget.stepUp if self.random.random() < 0.5 else widget.stepDown)()
        elif isinstance(widget, QAbstractButton) and widget.text().endswith(
            "\N{HORIZONTAL ELLIPSIS}"
        ):
            return f"left {label} alone"
        else:
            QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=self._at(widget))
        return label

    def _open(self) -> str:
        mesh = self.meshes[self.random.integers(len(self.meshes))]
        self.window.controller.open(mesh)
        return Path(mesh).name

    def _key(self) -> None:
        key = _KEYS[self.random.integers(len(_KEYS))]
        QTest.keyClick(self.window, key)


def _close_popup() -> None:
    for waiting in (QApplication.activePopupWidget(), QApplication.activeModalWidget()):
        if waiting is not None:
            waiting.close()


def without_dialogs(patch) -> None:
    """Let every dialog of the system be dismissed at once.

    Parameters
    ----------
    patch : callable
        Takes an object, a name and a value, as ``monkeypatch.setattr``.
    """
    from qtpy.QtWidgets import QColorDialog, QDialog, QFileDialog, QInputDialog, QMessageBox

    for name in ("getOpenFileName", "getSaveFileName", "getOpenFileNames"):
        patch(QFileDialog, name, staticmethod(lambda *a, **k: ("", "")))
    patch(QFileDialog, "getExistingDirectory", staticmethod(lambda *a, **k: ""))
    patch(QDialog, "exec", lambda self: 0)
    patch(QMessageBox, "exec", lambda self: 0)
    patch(QColorDialog, "exec", lambda self: 0)
    for name in ("getText", "getDouble", "getInt", "getItem"):
        patch(QInputDialog, name, staticmethod(lambda *a, **k: (0, False)))
