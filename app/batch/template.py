"""Names of results from a template: ``{stem}-{model}-{n:3}``."""

import re
from collections.abc import Mapping
from pathlib import PurePosixPath

from lutcore.errors import ParameterError

FIELDS = ("stem", "folder", "n", "session", "output", "model", "material", "method")
"""What may stand in braces: the mesh's name, folder and number in the job, and what is drawn."""
_FIELD = re.compile(r"\{([^{}:]*)(?::([^{}]*))?\}")
_WIDEST = 12
# What some file system takes for something else than a letter of a name.
_UNSAFE = re.compile(r'[\x00-\x1f<>:"/\\|?*]')


def filled(template: str, values: Mapping[str, str | int]) -> str:
    """Return the name that a template gives.

    Parameters
    ----------
    template : str
        Text with fields in braces; ``{n:3}`` is a number of three digits at least. A slash begins
        a folder.
    values : mapping
        One for each of `FIELDS`.

    Returns
    -------
    str
        A relative path with slashes, without an ending.

    Raises
    ------
    ParameterError
        If a field does not exist, or the name leads out of the folder.
    """

    def value(match: re.Match[str]) -> str:
        name, width = match.groups()
        if name not in values:
            raise ParameterError.unknown("field of a template", name, FIELDS)
        text = str(values[name])
        if width is not None:
            if not (width.isdigit() and name == "n" and int(width) <= _WIDEST):
                raise ParameterError(
                    f"template {template!r}: {{{name}:{width}}} is not understood; digits are "
                    f"counted for n only, as in {{n:3}}, up to {_WIDEST}"
                )
            text = text.zfill(int(width))
        return _UNSAFE.sub("_", text)

    name = _FIELD.sub(value, template)
    if "{" in name or "}" in name:
        raise ParameterError(f"template {template!r} has a brace without its partner")
    parts = PurePosixPath(name).parts
    hidden = any(part.startswith(".") for part in parts)
    if not parts or PurePosixPath(name).is_absolute() or hidden or name.endswith("/"):
        raise ParameterError(
            f"template {template!r} gives {name!r}: results are named inside the output folder, "
            "and no part of a name begins with a dot"
        )
    return str(PurePosixPath(name))
