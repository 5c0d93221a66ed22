"""Keys that a control needs although the window has shortcuts on them."""

from collections.abc import Sequence

from qtpy.QtCore import QEvent, Qt
from qtpy.QtGui import QKeyEvent


def kept(event: QEvent, keys: Sequence[Qt.Key]) -> bool:
    """Claim a key before the window's shortcuts do; for a widget's ``event``.

    Parameters
    ----------
    event : QEvent
        Any event.
    keys : sequence of Qt.Key
        What the widget needs, without Control.

    Returns
    -------
    bool
        Whether it was claimed: the same key then comes as a press.
    """
    if not isinstance(event, QKeyEvent) or event.type() != QEvent.Type.ShortcutOverride:
        return False
    if event.key() not in keys or event.modifiers() & Qt.KeyboardModifier.ControlModifier:
        return False
    event.accept()
    return True
