"""Which key does what, as a person chose it. Knows no Qt."""

from psygnal import Signal

from app.gui.actions import Action, Actions
from app.gui.settings import Settings

_SETTING = "shortcuts"


class Shortcuts:
    """The keys of a window's actions.

    Parameters
    ----------
    actions : Actions
        With their own keys.
    settings : Settings
        Remembers those that were chosen instead.
    """

    changed = Signal(str)
    """Emitted with the name of an action that has another key now."""

    def __init__(self, actions: Actions, settings: Settings) -> None:
        self._actions, self._settings = actions, settings

    def key(self, name: str) -> str:
        """Return the key of an action.

        Parameters
        ----------
        name : str
            Of the action.

        Returns
        -------
        str
            Qt's name of it, empty for none.
        """
        chosen = self._settings.get(_SETTING, {}).get(name)
        return chosen if isinstance(chosen, str) else self._actions[name].shortcut

    def holder(self, key: str, besides: str = "") -> Action | None:
        """Return the action that a key belongs to.

        Parameters
        ----------
        key : str
            Qt's name of it.
        besides : str
            Name of an action that does not count.

        Returns
        -------
        Action or None
            None for a key that is free, or no key.
        """
        others = (one for one in self._actions if one.name != besides)
        return next((one for one in others if key and self.key(one.name) == key), None)

    def bind(self, name: str, key: str) -> None:
        """Give an action a key; who had it has none then.

        Parameters
        ----------
        name : str
            Of the action.
        key : str
            Qt's name of it, empty for none.
        """
        former = self.holder(key, besides=name)
        if former is not None:
            self._choose(former.name, "")
        self._choose(name, key)

    def reset(self) -> None:
        """Give all actions their own keys back."""
        before = self._settings.get(_SETTING, {})
        self._settings.set(_SETTING, {})
        known = {one.name for one in self._actions}
        for name in before:
            if name in known:
                self.changed.emit(name)

    def _choose(self, name: str, key: str) -> None:
        chosen = dict(self._settings.get(_SETTING, {}))
        chosen.pop(name, None)
        if key != self._actions[name].shortcut:
            chosen[name] = key
        self._settings.set(_SETTING, chosen)
        self.changed.emit(name)
