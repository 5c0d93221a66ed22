"""Windows and dialogs no larger than the screen: at 200 % a small one has 640 x 400 units."""

from qtpy.QtWidgets import QWidget

# What the system's own frame and title may take.
_FRAME = 8
_TITLE = 30


def fit(widget: QWidget, width: float, height: float) -> None:
    """Make a window as large as it wants to be, but let it lie on its screen.

    Parameters
    ----------
    widget : QWidget
        A window or a dialog.
    width, height : float
        What it wants, in units that the display's scale turns into pixels.
    """
    room = widget.screen().availableGeometry()
    most = max(room.width() - _FRAME, 1), max(room.height() - _TITLE, 1)
    widget.resize(min(round(width), most[0]), min(round(height), most[1]))
