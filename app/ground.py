"""What lies behind a picture: a colour, or nothing."""

from dataclasses import dataclass

TRANSPARENT = "transparent"
"""The background of a picture that has none: its pixels have an alpha channel."""
_LIGHT, _DARK = 0.86, 0.1
# Before black and before white it has a contrast of 4.6, more than the 4.5 that letters need
# (WCAG 2.2, 1.4.3): nobody knows what a transparent picture is laid on.
_BETWEEN = 0.46


@dataclass(frozen=True)
class Ground:
    """A background.

    Parameters
    ----------
    color : tuple of 3 floats
        sRGB-encoded, 0 to 1.
    transparent : bool
        Whether there is none; the colour is then black.
    """

    color: tuple[float, float, float]
    transparent: bool = False

    @property
    def ink(self) -> float:
        """Grey, 0 to 1, of what is written before it."""
        if self.transparent:
            return _BETWEEN
        return _LIGHT if sum(self.color) < 1.5 else _DARK


def ground(text: str) -> Ground:
    """Return the background that a session says.

    Parameters
    ----------
    text : str
        A CSS colour name, hexadecimal notation, or ``transparent``.

    Returns
    -------
    Ground
        The same.

    Raises
    ------
    ParameterError
        If it is none of them, or a colour that is transparent in part.
    """
    from PIL import ImageColor

    from lutcore.errors import ParameterError

    if text.lower() == TRANSPARENT:
        return Ground((0.0, 0.0, 0.0), transparent=True)
    try:
        red, green, blue, *alpha = ImageColor.getrgb(text)
    except ValueError:
        raise ParameterError(
            f"background = {text!r} is not a colour; give a name, #rrggbb or {TRANSPARENT}"
        ) from None
    if alpha and alpha[0] < 255:
        raise ParameterError(
            f"background = {text!r} is transparent in part; give #rrggbb, or {TRANSPARENT} for none"
        )
    return Ground((red / 255.0, green / 255.0, blue / 255.0))
