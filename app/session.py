"""The whole state of a picture as plain data, and its JSON form.

A session says everything that a picture depends on and nothing else: the same session over the
same mesh gives the same picture, from the window and from the command line.
"""

import math
import os
import re
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from app.repairs import KINDS
from app.writing import write_bytes
from lutcore.errors import CurvelightError, ParameterError

Vector = tuple[float, float, float]
Positive = Annotated[float, Meta(gt=0.0)]
NotNegative = Annotated[float, Meta(ge=0.0)]
Percent = Annotated[float, Meta(ge=0.0, le=100.0)]
_INDEX = (1.0, 3.0)
Pixels = Annotated[int, Meta(ge=16, le=16384)]
_OUT_OF_BOUNDS = re.compile(
    r"Expected `(?P<kind>int|float)` (?P<sign>[<>]=?) (?P<bound>[-+.\de]+)"
    r" - at `\$\.(?P<name>\w+)(\[\d+\])?`"
)
Frame = Literal["camera", "world"]
RepairKind = Literal["merge", "islands", "manifold", "holes", "orient", "decimate"]


class SessionError(CurvelightError):
    """A session file cannot be read, or says what a session cannot say."""


class _Part(Struct, frozen=True, forbid_unknown_fields=True):
    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            value = getattr(self, name)
            numbers = value if isinstance(value, tuple) else (value,)
            if not all(math.isfinite(one) for one in numbers if isinstance(one, float)):
                # JSON cannot say them, so the session would come back as another.
                raise ValueError(f"{name} = {value!r} is not finite")


class Directional(_Part, frozen=True, tag="directional", tag_field="kind"):
    """A directional light; see `lutcore.DirectionalLight`.

    `frame` says whether the direction is in world axes or in the camera's: x to the right, y up,
    z towards the viewer.
    """

    direction: Vector
    irradiance: Vector = (1.0, 1.0, 1.0)
    frame: Frame = "world"


class Point(_Part, frozen=True, tag="point", tag_field="kind"):
    """A point light in world coordinates; see `lutcore.PointLight`."""

    position: Vector
    intensity: Vector = (1.0, 1.0, 1.0)


class Cone(_Part, frozen=True, tag="cone", tag_field="kind"):
    """A cone light in world coordinates; see `lutcore.ConeLight`."""

    position: Vector
    direction: Vector
    intensity: Vector = (1.0, 1.0, 1.0)
    angle: Annotated[float, Meta(gt=0.0, le=180.0)] = 30.0


class Substance(_Part, frozen=True):
    """A material by its coefficients, for one that has no name; see `lutcore.Material`.

    `eta` is one number, or one for each channel: three that are equal become one, so that there is
    one way to say it.
    """

    name: str
    scattering: tuple[Positive, Positive, Positive]
    absorption: tuple[NotNegative, NotNegative, NotNegative]
    eta: float | Vector

    def __post_init__(self) -> None:
        super().__post_init__()
        indices = self.eta if isinstance(self.eta, tuple) else (self.eta,)
        # Not declared as the others: msgspec 0.22 reads the bounds of such a union from stray
        # memory.
        if not all(_INDEX[0] <= index <= _INDEX[1] for index in indices):
            raise ValueError(f"eta = {self.eta!r} is outside its range {_INDEX[0]} to {_INDEX[1]}")
        if len(set(indices)) == 1:
            msgspec.structs.force_setattr(self, "eta", indices[0])


class Method(_Part, frozen=True):
    """A plug-in by name, with the parameters that are not at their default."""

    name: str
    parameters: dict[str, float | str] = {}

    @property
    def label(self) -> str:
        """The name, with the parameters that are not at their default."""
        values = (
            f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
            for name, value in self.parameters.items()
        )
        return f"{self.name} ({', '.join(values)})" if self.parameters else self.name


class Settled(_Part, frozen=True):
    """What the shading model ``auto`` came to in a scene; see `app.settling`.

    `scene` tells one scene from another, empty for any; `method` is the model, `cheaper` the one
    that takes its place where its predicted error is below `limit`: relative, or a CIEDE2000 of
    light that is shown under `exposure`.
    """

    method: Method
    cheaper: Method | None = None
    limit: Positive | None = None
    exposure: Positive | None = None
    scene: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.cheaper is None) != (self.limit is None):
            raise ValueError("a cheaper model and its limit are given together")
        if self.cheaper is None and self.exposure is not None:
            raise ValueError("an exposure is given with a cheaper model")

    @property
    def label(self) -> str:
        """The model in words."""
        if self.cheaper is None:
            return self.method.label
        return f"{self.method.label}, {self.cheaper.label} where it suffices"

    def as_json(self) -> dict[str, object]:
        """Return it as a script reads it.

        Returns
        -------
        dict
            model, parameters and blended_with: the name of the cheaper one or None.
        """
        return {
            "model": self.method.name,
            "parameters": self.method.parameters,
            "blended_with": self.cheaper.name if self.cheaper else None,
        }


class Volume(_Part, frozen=True):
    """How a volume scan becomes a surface; a mesh takes no notice of it.

    `level` is the value of the voxels that the surface lies at, None takes Otsu's; `smoothing` is
    the sigma of a Gaussian in voxels, applied before.
    """

    level: float | None = None
    smoothing: Annotated[float, Meta(ge=0.0, le=50.0)] = 0.0


class Repair(_Part, frozen=True):
    """A change to a mesh before anything is computed; see `app.repairs.KINDS`.

    `value` is what the kind is set by, in the unit that it says; None takes its default.
    """

    kind: RepairKind
    value: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        try:
            if self.kind not in KINDS:
                raise ParameterError.unknown("repair", self.kind, KINDS)
            KINDS[self.kind].check(self.kind, self.value)
        except ParameterError as error:  # msgspec makes a message of a file out of a ValueError
            raise ValueError(str(error)) from None

    @property
    def words(self) -> str:
        """What is done, with its number and unit."""
        kind = KINDS[self.kind]
        number = kind.check(self.kind, self.value)
        how = f", {number:g} {kind.value.unit}" if kind.value else ""
        return f"{kind.words.lower()}{how}"


class Camera(_Part, frozen=True):
    """Where the picture is taken from, in world coordinates.

    `angle` is the full vertical angle of view in degrees; `height`, where given, makes the
    projection parallel and is the height of the picture in mesh units.
    """

    position: Vector
    target: Vector
    up: Vector = (0.0, 1.0, 0.0)
    angle: Annotated[float, Meta(gt=0.0, lt=180.0)] = 30.0
    height: Positive | None = None


View = Literal["shade", "curvature", "figure", "compare"]
Shadows = Literal["off", "on", "auto"]
ComparedBy = Literal["model", "estimator", "material"]
Quantity = Literal[
    "curvedness",
    "k1",
    "k2",
    "mean",
    "gauss",
    "shape_index",
    "error",
    "scale",
    "disagreement",
    "all",
]

CHOSEN = "auto"
"""The shading model that leaves it to the scene: `lutcore.shading.AUTO`, which loads slowly."""

# One strong light from the right and a weak one from the left, as in the paper's Figure 1.
FIGURE_LIGHTS = (
    Directional((0.9, 0.3, 0.3), (1.0, 1.0, 1.0), "camera"),
    Directional((-0.8, -0.1, 0.4), (0.09, 0.09, 0.09), "camera"),
)


class Session(_Part, frozen=True):
    """Everything that a picture depends on.

    `mesh` is a path or ``sample:NAME``; `volume` says how it becomes a surface if it is a volume;
    `repairs` are done to it in order, before anything else;
    `mm_per_unit` None takes the sample's or the file's own scale, else 1 mm;
    `scale` is the length in mesh units that curvature is averaged over, None chooses it;
    `profile` is how light spreads in the material, the same for all models that are compared;
    `settled` is what the model ``auto`` came to where the session was drawn: which model costs
    least differs between machines, and each scene that is still the same keeps it;
    `shadows` says whether the surface casts shadows on itself, ``auto`` where they change much;
    None is ``auto`` for the model ``auto``, ``off`` for a model that has a name; see `casts`;
    `compared_by` says what `compared` names: shading models, estimators, whose `quantity` is
    shown, or materials; `wipe` shows two on one surface, the first left of this share of the
    surface's width; `difference` adds how far the others are from the first;
    `peers` are the estimators whose disagreement is measured; `quantity` ``all`` draws each in a
    panel of its own;
    `camera` is a view name (see `app.camera`) or a camera; `range` None takes a robust one (see
    `app.shown.robust_range`), `symmetric` makes it as wide below zero as above, `flip` turns the
    colour map round; `colormap` None is the paper's for curvature and magma for differences;
    `percentiles` are the shares of the values that a robust range leaves below its ends, `fade`
    turns colours grey where the curvature is below its error, `strokes` draws the principal
    directions over curvature;
    `exposure` None brings the brightest parts near white.
    """

    mesh: str = "sample:marble-face-raw"
    volume: Volume = Volume()
    repairs: tuple[Repair, ...] = ()
    mm_per_unit: Positive | None = None
    view: View = "shade"
    material: str | Substance = "skin1"
    lights: tuple[Directional | Point | Cone, ...] = FIGURE_LIGHTS
    profile: Method = Method("jensen2001")
    shadows: Shadows | None = None
    model: Method = Method("curvature-lut")
    settled: tuple[Settled, ...] = ()
    compared: tuple[Method, ...] = ()
    compared_by: ComparedBy = "model"
    wipe: Annotated[float, Meta(ge=0.0, le=1.0)] | None = None
    difference: bool = False
    estimator: Method = Method("auto")
    scale: Positive | None = None
    peers: tuple[Method, ...] = ()
    quantity: Quantity = "curvedness"
    colormap: str | None = None
    range: tuple[float, float] | None = None
    symmetric: bool = False
    flip: bool = False
    percentiles: tuple[Percent, Percent] = (5.0, 95.0)
    fade: bool = False
    strokes: bool = False
    flat: bool = False
    albedo: bool = True
    exposure: Positive | None = None
    camera: str | Camera = "auto"
    size: tuple[Pixels, Pixels] = (1000, 1000)
    background: str = "#20242a"
    format: Literal[1] = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.range is not None and not self.range[0] < self.range[1]:
            raise ValueError(f"range = {self.range!r}: the first must be below the second")
        if not self.percentiles[0] < self.percentiles[1]:
            raise ValueError(
                f"percentiles = {self.percentiles!r}: the first must be below the second"
            )

    @property
    def casts(self) -> Shadows:
        """Whether the surface casts shadows: what `shadows` says, or else the model.

        All that is compared has the same.
        """
        if self.shadows is not None:
            return self.shadows
        several = self.view == "compare" and self.compared_by == "model"
        models = self.compared if several else (self.model,)
        return "auto" if any(one.name == CHOSEN for one in models) else "off"


def to_json(session: Session) -> bytes:
    """Return a session as JSON text.

    Parameters
    ----------
    session : Session
        Any session.

    Returns
    -------
    bytes
        UTF-8, indented, with a line break at its end.
    """
    return msgspec.json.format(msgspec.json.encode(session), indent=2) + b"\n"


def from_json(text: bytes, label: str = "session") -> Session:
    """Return the session that JSON text says.

    Parameters
    ----------
    text : bytes
        As `to_json` makes it; what is left out takes its default.
    label : str
        What to call it in a message: the file's name.

    Returns
    -------
    Session
        The session, its values checked.

    Raises
    ------
    SessionError
        If it is not JSON, names a field that does not exist or a value that cannot be.
    """
    try:
        return msgspec.json.decode(text, type=Session)
    except msgspec.MsgspecError as error:
        raise SessionError(f"{label}: not a Curvelight session: {error}") from None


def read(path: Path) -> Session:
    """Read a session file.

    Parameters
    ----------
    path : Path
        A file that `write` or a person wrote.

    Returns
    -------
    Session
        The session; a relative mesh path is taken from the file's own folder.

    Raises
    ------
    SessionError
        If the file cannot be read or holds no session.
    """
    try:
        session = from_json(path.read_bytes(), str(path))
    except OSError as error:
        raise SessionError(f"{path}: cannot be read: {error.strerror}") from None
    if session.mesh.startswith("sample:") or Path(session.mesh).is_absolute():
        return session
    return msgspec.structs.replace(session, mesh=str(path.parent / session.mesh))


def write(session: Session, path: Path) -> None:
    """Write a session file, whole or not at all; a relative mesh path follows the file.

    Parameters
    ----------
    session : Session
        Any session.
    path : Path
        Where to.

    Raises
    ------
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    """
    if not session.mesh.startswith("sample:") and not Path(session.mesh).is_absolute():
        session = msgspec.structs.replace(session, mesh=_seen_from(path.parent, session.mesh))
    write_bytes(path, to_json(session))


def _seen_from(folder: Path, mesh: str) -> str:
    try:
        return os.path.relpath(Path(mesh).resolve(), folder.resolve())
    except ValueError:  # on another drive of Windows
        return str(Path(mesh).resolve())


def replaced(session: Session, **changes: Any) -> Session:
    """Return a session with some fields changed, checked as a file would be.

    Parameters
    ----------
    session : Session
        Where to start from.
    **changes : object
        Fields to change; None leaves a field as it is.

    Returns
    -------
    Session
        The changed session.

    Raises
    ------
    ParameterError
        If a value cannot be.
    """
    given = {name: value for name, value in changes.items() if value is not None}
    return checked(session, **given)


def checked(session: Session, **changes: Any) -> Session:
    """Return a session with some fields changed, None included, checked as a file would be.

    Parameters
    ----------
    session : Session
        Where to start from.
    **changes : object
        Fields to change.

    Returns
    -------
    Session
        The changed session.

    Raises
    ------
    ParameterError
        If a value cannot be.
    """
    try:
        return msgspec.convert(
            msgspec.to_builtins(msgspec.structs.replace(session, **changes)), Session
        )
    except (msgspec.MsgspecError, ValueError) as error:
        raise ParameterError(_in_words(str(error), changes)) from None


def _in_words(problem: str, changes: dict[str, Any]) -> str:
    """Return what msgspec says of a number out of bounds as a person would, with the value."""
    found = _OUT_OF_BOUNDS.fullmatch(problem)
    if found is None or found["name"] not in changes:
        return problem
    kind = "a whole number" if found["kind"] == "int" else "a number"
    least = f"{float(found['bound']):g}"
    return f"{found['name']} = {changes[found['name']]}: expected {kind} {found['sign']} {least}"
