"""What the menu File writes and copies: pictures, data, the command, the script."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtGui import QGuiApplication, QImage
from qtpy.QtWidgets import QDialog, QFileDialog

from app.gui.actions import Action
from app.gui.picture_dialog import PictureDialog
from app.gui.saving import SUFFIXES, Data, make_picture, save_data, save_picture
from app.gui.session_file import beside

if TYPE_CHECKING:
    from app.gui.window import Window
    from app.render import Image

_ASKS = "\N{HORIZONTAL ELLIPSIS}"
_PICTURE = ".png"


def actions(window: "Window") -> list[Action]:
    """Return the actions that write or copy something.

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
            "file.save_picture",
            "File",
            f"Save picture{_ASKS}",
            "Write the picture as PNG, as the command line does with the saved session",
            partial(_save_picture, window),
            "Ctrl+E",
        ),
        Action(
            "file.copy_picture",
            "File",
            "Copy picture",
            "Copy the picture, in the size of the view, to the clipboard",
            partial(copy_picture, window),
            "Ctrl+Shift+C",
        ),
        Action(
            "file.screenshot",
            "File",
            f"Screenshot of the view{_ASKS}",
            "Write what the view shows, handles and marks included, as PNG",
            partial(_screenshot, window),
            "F12",
        ),
        *(
            Action(
                f"file.save_{kind}",
                "File",
                f"Save {kind} data{_ASKS}",
                f"Write the {kind} at the vertices ({', '.join(SUFFIXES[kind])})",
                partial(_save_data, window, kind),
            )
            for kind in SUFFIXES
        ),
        Action(
            "file.copy_command",
            "File",
            "Copy as command line",
            "Copy the command that draws this picture",
            partial(copy_command, window),
        ),
        Action(
            "file.copy_script",
            "File",
            "Copy as Python script",
            "Copy a Python script that draws this picture",
            partial(copy_script, window),
        ),
    ]


def copy_picture(window: "Window") -> None:
    """Copy the picture, in the size of the view, to the clipboard.

    Parameters
    ----------
    window : Window
        Shows the session.
    """

    def copied(image: "Image") -> None:
        height, width = image.shape[:2]
        QGuiApplication.clipboard().setImage(_qimage(image))
        window.controller.noted.emit(f"copied a picture of {width} x {height} pixels")

    make_picture(window.controller, _view_size(window), lambda made: copied(made.image))


def save_screenshot(window: "Window", path: Path) -> None:
    """Write what the view shows as PNG; it says nothing of how it was made.

    Parameters
    ----------
    window : Window
        Its view.
    path : Path
        Where to.
    """
    from PIL import Image as Pillow

    from app.render import grab
    from app.writing import WriteError, replacing

    window.canvas.draw()
    image = grab(window.canvas.window_, _view_size(window))
    try:
        with replacing(path) as beside_it:
            Pillow.fromarray(image).save(beside_it, format="PNG", compress_level=1)
    except WriteError as error:
        window.controller.failed.emit(str(error))
    else:
        window.controller.noted.emit(f"wrote {path}")


def copy_command(window: "Window") -> None:
    """Copy the command that draws this picture, to be pasted into a shell.

    Parameters
    ----------
    window : Window
        Its session; where flags cannot say all of it, the file that it is saved in is named.
    """
    from app.command_line import command_line, command_of_file

    document, controller = window.controller.document, window.controller
    output = beside(window, _PICTURE).name
    text = command_line(document.session, output)
    if text is None:
        if document.path is None or not document.holds(document.path):
            controller.noted.emit(
                "flags cannot say all of this session: save it (Ctrl+S), then copy again"
            )
            return
        text = command_of_file(document.session, document.path, output)
    QGuiApplication.clipboard().setText(text)
    controller.noted.emit(f"copied: {text}")


def copy_script(window: "Window") -> None:
    """Copy a Python script that draws this picture.

    Parameters
    ----------
    window : Window
        Its session.
    """
    from app.scripting import script

    text = script(window.controller.session, beside(window, _PICTURE).name)
    QGuiApplication.clipboard().setText(text)
    window.controller.noted.emit("copied a Python script that draws this picture")


def _save_picture(window: "Window") -> None:
    controller = window.controller
    background = window.background
    dialog = PictureDialog(
        window, controller.session.size, _view_size(window), background.transparent
    )
    if dialog.exec() != QDialog.DialogCode.Accepted:
        return
    path = _asked(window, "Save picture", "PNG pictures (*.png)", (_PICTURE,), "")
    fields = {"size": dialog.chosen, "background": background.named(dialog.clear.isChecked())}
    if path is not None and controller.change("picture", **fields):
        save_picture(controller, path)


def _screenshot(window: "Window") -> None:
    path = _asked(window, "Save screenshot", "PNG pictures (*.png)", (_PICTURE,), "-view")
    if path is not None:
        save_screenshot(window, path)


def _save_data(window: "Window", kind: Data) -> None:
    suffixes = SUFFIXES[kind]
    patterns = " ".join(f"*{one}" for one in suffixes)
    path = _asked(window, f"Save {kind} data", f"Data ({patterns})", suffixes, f"-{kind}")
    if path is not None:
        save_data(window.controller, path, kind)


def _asked(
    window: "Window", title: str, pattern: str, suffixes: tuple[str, ...], tail: str
) -> Path | None:
    """Ask for a file; one without an ending gets the first."""
    proposed = str(beside(window, tail + suffixes[0]))
    name, _ = QFileDialog.getSaveFileName(window, title, proposed, pattern)
    if not name:
        return None
    return Path(name) if Path(name).suffix else Path(name + suffixes[0])


def _view_size(window: "Window") -> tuple[int, int]:
    width, height = window.canvas.window_.GetSize()
    return int(width), int(height)


def _qimage(image: "Image") -> QImage:
    height, width, channels = image.shape
    formats = {3: QImage.Format.Format_RGB888, 4: QImage.Format.Format_RGBA8888}
    # A copy: the array's memory does not outlive it.
    return QImage(image.tobytes(), width, height, channels * width, formats[channels]).copy()
