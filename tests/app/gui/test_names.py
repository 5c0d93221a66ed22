"""Every control says what it is to a screen reader, in every dock and dialog."""

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSlider,
    QAbstractSpinBox,
    QComboBox,
    QDialog,
    QHeaderView,
    QKeySequenceEdit,
    QLineEdit,
    QMessageBox,
    QPlainTextEdit,
    QScrollBar,
    QTabBar,
    QTextEdit,
    QWidget,
)

from app.gui.picture_dialog import PictureDialog
from tests.app.gui.hands import answered, click_menu

_CONTROLS = (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSlider,
    QAbstractSpinBox,
    QComboBox,
    QKeySequenceEdit,
    QLineEdit,
    QPlainTextEdit,
    QTextEdit,
)
# What Qt makes inside its own widgets, and names by them.
_PARTS = (QScrollBar, QHeaderView)


def _nameless(root: QWidget) -> list[str]:
    """Controls, and what else takes the keyboard, without a name or a text of their own."""
    found = []
    for one in root.findChildren(QWidget):
        interactive = isinstance(one, _CONTROLS) or one.focusPolicy() != Qt.FocusPolicy.NoFocus
        inside = one.parentWidget()
        within = isinstance(
            inside, QAbstractSpinBox | QComboBox | QKeySequenceEdit | QLineEdit | QTabBar
        ) or one.objectName().startswith("qt_")
        # A view that scrolls passes its focus on to what lies in it; a list drops out of a box.
        container = type(one) in (QWidget,) or one.metaObject().className() in (
            "QScrollArea",
            "QTabBar",
            "QMainWindowTabBar",
            "QTableCornerButton",
            "QDockWidget",
            "QDialog",
            "QComboBoxPrivateContainer",
            "QComboBoxListView",
        )
        if not interactive or within or container or isinstance(one, _PARTS):
            continue
        text = getattr(one, "text", None)
        said = text() if isinstance(one, QAbstractButton) and callable(text) else ""
        # A sign alone is no name.
        if not one.accessibleName() and not any(letter.isalpha() for letter in said):
            where = []
            above = one
            while above is not None and above is not root:
                where.append(above.objectName() or above.accessibleName() or type(above).__name__)
                above = above.parentWidget()
            found.append(" < ".join(where))
    return found


def test_every_control_of_the_window_has_a_name(window, qtbot) -> None:
    for dock in window.docks.values():
        dock.show()
        dock.fill()
    qtbot.wait(50)
    assert len(window.findChildren(QAbstractButton)) > 20
    assert not _nameless(window)


def test_every_control_of_the_dialogs_has_a_name(window, qtbot) -> None:
    for name in ("help.palette", "help.shortcuts", "help.keys"):
        before = set(window.findChildren(QDialog))
        window.act(window.actions_[name])
        (dialog,) = set(window.findChildren(QDialog)) - before
        assert not _nameless(dialog), name
        dialog.close()


def test_every_control_of_the_questions_has_a_name(window, qtbot) -> None:
    nameless = []

    def look(dialog) -> None:
        nameless.extend(_nameless(dialog))
        qtbot.keyClick(dialog, Qt.Key.Key_Escape)

    with answered(PictureDialog, look):
        qtbot.keyClick(window, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    click_menu(qtbot, window, "Curvature", "Flip colours")
    with answered(QMessageBox, look):
        qtbot.keyClick(window, Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
    assert not nameless


def test_a_control_without_a_name_is_found(window) -> None:
    line = QLineEdit(window.centralWidget())
    assert len(_nameless(window)) == 1
    line.setAccessibleName("A line")
    assert not _nameless(window)


def test_every_action_says_what_it_does(window) -> None:
    for action in window.actions_:
        assert any(letter.isalnum() for letter in action.text), action.name
        assert len(action.doc) > 5, action.name
