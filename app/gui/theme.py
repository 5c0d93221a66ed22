"""Light and dark: as the system says, or as chosen."""

from typing import Literal

from qtpy.QtGui import QColor, QPalette
from qtpy.QtWidgets import QApplication

from app.gui.settings import Settings

Theme = Literal["system", "light", "dark"]
THEMES: dict[Theme, str] = {
    "system": "As the system",
    "light": "Light",
    "dark": "Dark",
}
"""What is offered, with what it is called."""
_SETTING = "theme"
_Role = QPalette.ColorRole
# Ground, ink and accent of each; contrast of ink on ground is above 10 to 1.
_COLORS: dict[str, dict[QPalette.ColorRole, str]] = {
    "light": {
        _Role.Window: "#f2f2f2",
        _Role.Base: "#ffffff",
        _Role.AlternateBase: "#f7f7f7",
        _Role.Button: "#e9e9e9",
        _Role.WindowText: "#1b1d20",
        _Role.ToolTipBase: "#ffffdc",
        _Role.Highlight: "#1f6feb",
        _Role.HighlightedText: "#ffffff",
        _Role.Link: "#0b57d0",
        _Role.PlaceholderText: "#6a6d72",
    },
    "dark": {
        _Role.Window: "#26292e",
        _Role.Base: "#1b1d21",
        _Role.AlternateBase: "#212429",
        _Role.Button: "#33373d",
        _Role.WindowText: "#e8e8e8",
        _Role.ToolTipBase: "#3a3e45",
        _Role.Highlight: "#2f6fd0",
        _Role.HighlightedText: "#ffffff",
        _Role.Link: "#8ab4f8",
        _Role.PlaceholderText: "#9a9da3",
    },
}
_INKS = (_Role.Text, _Role.ButtonText, _Role.ToolTipText)
_DISABLED = (_Role.WindowText, _Role.Text, _Role.ButtonText)


def chosen(settings: Settings) -> Theme:
    """Return the theme that was chosen.

    Parameters
    ----------
    settings : Settings
        Of the window.

    Returns
    -------
    str
        A key of `THEMES`.
    """
    name = settings.get(_SETTING, "system")
    return name if name in THEMES else "system"


def choose(settings: Settings, theme: Theme) -> None:
    """Choose a theme, for now and later.

    Parameters
    ----------
    settings : Settings
        Of the window.
    theme : str
        A key of `THEMES`.
    """
    settings.set(_SETTING, theme)
    apply(theme)


def apply(theme: Theme) -> None:
    """Give all windows their colours.

    Parameters
    ----------
    theme : str
        A key of `THEMES`.
    """
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    # An empty palette is the platform's own, which follows the system. The scheme itself cannot be
    # asked for where the platform has no theme, so the colours are given.
    application.setPalette(QPalette() if theme == "system" else palette(theme))


def palette(theme: Theme) -> QPalette:
    """Return the colours of a theme.

    Parameters
    ----------
    theme : str
        ``light`` or ``dark``.

    Returns
    -------
    QPalette
        For the style Fusion.
    """
    colors = _COLORS[theme]
    made = QPalette(QColor(colors[_Role.Button]), QColor(colors[_Role.Window]))
    for role, color in colors.items():
        made.setColor(role, QColor(color))
    for role in _INKS:
        made.setColor(role, QColor(colors[_Role.WindowText]))
    for role in _DISABLED:
        made.setColor(QPalette.ColorGroup.Disabled, role, QColor(colors[_Role.PlaceholderText]))
    return made
