"""What the window remembers between its runs: a JSON file in the user's folder. Knows no Qt."""

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from platformdirs import user_config_path

from app.writing import WriteError, write_bytes

_MOST_RECENT = 12


class Settings:
    """Remembered values by name.

    A file that cannot be read, or holds something else, counts as empty; one that cannot be
    written is left: the window works without.

    Parameters
    ----------
    path : Path, optional
        The file; by default in ``CURVELIGHT_CONFIG_DIR`` or the user's folder for settings.
    """

    def __init__(self, path: Path | None = None) -> None:
        self.path = path or folder() / "window.json"
        self._values: dict[str, Any] = {}
        with suppress(OSError, ValueError):
            found = json.loads(self.path.read_bytes())
            if isinstance(found, dict):
                self._values = found

    def get(self, name: str, default: Any) -> Any:
        """Return a value.

        Parameters
        ----------
        name : str
            Its name.
        default : object
            What counts if nothing is remembered, or something of another type.

        Returns
        -------
        object
            Of the default's type.
        """
        value = self._values.get(name, default)
        return value if isinstance(value, type(default)) else default

    def set(self, name: str, value: Any) -> None:
        """Remember a value.

        Parameters
        ----------
        name : str
            Its name.
        value : object
            What JSON can say.
        """
        if self._values.get(name) == value:
            return
        self._values[name] = value
        with suppress(WriteError, OSError):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            write_bytes(self.path, json.dumps(self._values, indent=2).encode())

    @property
    def recent(self) -> list[str]:
        """Files that were opened, the newest first."""
        return [one for one in self.get("recent", []) if isinstance(one, str)]

    def used(self, file: str) -> None:
        """Remember a file as the newest.

        Parameters
        ----------
        file : str
            A path, or ``sample:NAME``.
        """
        others = [one for one in self.recent if one != file]
        self.set("recent", [file, *others][:_MOST_RECENT])


def folder() -> Path:
    """Return the folder for what the window keeps between its runs.

    Returns
    -------
    Path
        It may not exist yet.
    """
    chosen = os.environ.get("CURVELIGHT_CONFIG_DIR")
    return Path(chosen) if chosen else user_config_path("curvelight")
