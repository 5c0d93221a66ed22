"""Help: what the keys do, everything by name, and what this program is."""

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtGui import QFontMetrics, QKeySequence
from qtpy.QtWidgets import QDialog, QLabel, QMessageBox, QScrollArea, QVBoxLayout

from app.gui.actions import MENUS, Action
from app.gui.fitting import fit

if TYPE_CHECKING:
    from app.gui.window import Window

ORDER = 10
_LETTERS = 90
_MOUSE = (
    ("Left drag", "turn; with Ctrl roll, with Shift shift"),
    ("Right drag", "shift"),
    ("Wheel", "nearer, farther"),
    ("L or Alt and drag", "turn the chosen light"),
)


def actions(window: "Window") -> list[Action]:
    """Return the actions of this menu.

    Parameters
    ----------
    window : Window
        What they act on.

    Returns
    -------
    list of Action
        In the order of the menu.
    """
    return [
        Action(
            "help.palette",
            "Help",
            "Command palette\N{HORIZONTAL ELLIPSIS}",
            "Do anything by typing a few letters of its name",
            partial(_palette, window),
            "Ctrl+Shift+P",
        ),
        Action(
            "help.keys",
            "Help",
            "Keys\N{HORIZONTAL ELLIPSIS}",
            "Show what every key and mouse button does",
            partial(_keys, window),
            "H",
        ),
        Action(
            "help.shortcuts",
            "Help",
            "Change shortcuts\N{HORIZONTAL ELLIPSIS}",
            "Give actions other keys",
            partial(_shortcuts, window),
        ),
        Action(
            "help.about",
            "Help",
            "About\N{HORIZONTAL ELLIPSIS}",
            "Show the version, and what draws",
            partial(_about, window),
        ),
    ]


def _palette(window: "Window") -> None:
    from app.gui.palette import Palette

    palette = Palette(window)
    palette.open()
    palette.line.setFocus()


def keys_text(window: "Window") -> str:
    """Return the cheat sheet.

    Parameters
    ----------
    window : Window
        Its actions, with the keys that they have now.

    Returns
    -------
    str
        Rich text: a table for each menu.
    """
    parts = [_table("Mouse", _MOUSE)]
    for menu in MENUS:
        rows = []
        for one in window.actions_:
            keys = window.qactions[one.name].shortcut()
            if one.menu.split("/")[0] == menu and not keys.isEmpty():
                said = keys.toString(QKeySequence.SequenceFormat.NativeText)
                rows.append((said, one.doc))
        if rows:
            parts.append(_table(menu, rows))
    return "".join(parts)


def _table(title: str, rows: Sequence[tuple[str, str]]) -> str:
    lines = (
        f'<tr><td style="padding-right: 16px"><b>{what}</b></td><td>{doc}</td></tr>'
        for what, doc in rows
    )
    return f"<h3>{title}</h3><table>{''.join(lines)}</table>"


def _keys(window: "Window") -> None:
    sheet = QDialog(window)
    sheet.setWindowTitle("Keys")
    text = QLabel(keys_text(window), sheet)
    text.setMargin(12)
    scroll = QScrollArea(sheet)
    scroll.setWidget(text)
    scroll.setWidgetResizable(True)
    column = QVBoxLayout(sheet)
    column.addWidget(scroll)
    text.setWordWrap(True)
    wide = QFontMetrics(text.font()).averageCharWidth() * _LETTERS
    fit(sheet, min(wide, window.width()), window.height() * 0.8)
    sheet.open()


def _shortcuts(window: "Window") -> None:
    from app.gui.shortcut_editor import ShortcutEditor

    ShortcutEditor(window).open()


def _about(window: "Window") -> None:
    from app.versions import versions

    backend = window.canvas.backend
    lines = [f"{name} {version}" for name, version in versions(window.controller.session).items()]
    if backend is not None:
        lines.append(backend.label)
    box = QMessageBox(window)
    box.setWindowTitle("About Curvelight")
    box.setText("Curvelight: curvature of scanned surfaces, and translucent shading from it.")
    box.setInformativeText("\n".join([*lines, "GPL-3.0-or-later"]))
    box.open()
