"""Numbers of a vertex in vectors of four: what costs is how many vectors there are."""

_WIDTH = 4
_PARTS = "xyzw"


class Packing:
    """Where named vectors lie in a row of vectors of four.

    Parameters
    ----------
    name : str
        Of the vectors of four in GLSL, before their number.
    parts : dict of str to int
        Name of each vector and how many numbers it has, 1 to 4.
    """

    def __init__(self, name: str, parts: dict[str, int]) -> None:
        self._name = name
        self._places: dict[str, tuple[int, int]] = {}
        at = 0
        for part, size in parts.items():
            self._places[part] = at, size
            at += size
        self.used = at
        """How many numbers there are."""

    def __contains__(self, part: str) -> bool:
        """Tell whether there is a vector of that name."""
        return part in self._places

    @property
    def names(self) -> list[str]:
        """The vectors of four, in order."""
        return [f"{self._name}{index}" for index in range(-(-self.used // _WIDTH))]

    def declared(self, way: str) -> str:
        """Declare the vectors of four.

        Parameters
        ----------
        way : str
            ``in`` or ``out``.

        Returns
        -------
        str
            GLSL.
        """
        return "".join(f"{way} vec4 {name};\n" for name in self.names)

    def given(self, values: dict[str, str]) -> str:
        """Set all vectors.

        Parameters
        ----------
        values : dict of str to str
            An expression for each vector.

        Returns
        -------
        str
            GLSL, one line for each number.
        """
        lines = []
        for part, (at, size) in self._places.items():
            kind = "float" if size == 1 else f"vec{size}"
            lines.append(f"{kind} {part}Made = {values[part]};\n")
            for index in range(size):
                taken = f"{part}Made" if size == 1 else f"{part}Made[{index}]"
                lines.append(f"{self._number(at + index)} = {taken};\n")
        unused = range(self.used, _WIDTH * len(self.names))
        return "".join(lines) + "".join(f"{self._number(at)} = 0.0;\n" for at in unused)

    def taken(self, part: str) -> str:
        """Return an expression for a vector.

        Parameters
        ----------
        part : str
            Its name.

        Returns
        -------
        str
            GLSL.
        """
        at, size = self._places[part]
        numbers = ", ".join(self._number(at + index) for index in range(size))
        return numbers if size == 1 else f"vec{size}({numbers})"

    def _number(self, at: int) -> str:
        return f"{self._name}{at // _WIDTH}.{_PARTS[at % _WIDTH]}"
