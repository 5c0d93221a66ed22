"""Flags that commands share, and the session they add up to."""

import argparse
from pathlib import Path
from typing import Any, get_args

from msgspec.structs import replace

from app import session as state
from app.repairs import KINDS
from app.session import (
    Cone,
    Directional,
    Method,
    Point,
    Quantity,
    Repair,
    Session,
    SessionError,
    Shadows,
    Vector,
    Volume,
)
from lutcore.errors import ParameterError
from lutcore.parameters import Choice, declared
from lutcore.registry import Registry


def add_mesh(parser: argparse.ArgumentParser, optional: bool = False) -> argparse.Action:
    """Add the MESH argument, the output and the session file.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    optional : bool
        Whether the command has a mesh of its own.

    Returns
    -------
    Action
        The output's.
    """
    parser.add_argument(
        "mesh",
        nargs="?",
        metavar="MESH",
        help="PLY, OBJ, STL, OFF, GLB, glTF, 3MF, VTP, VTU or VTK file, one that meshio or MeshLab "
        "reads (.msh, .inp, .dae, .wrl ...), any of them with .gz; a volume: NIfTI, MetaImage, "
        "VTI, TIFF or a folder of TIFF slices; or sample:NAME; may be left out with --session",
    )
    parser.add_argument(
        "--level",
        metavar="otsu|VALUE",
        help="value of a volume's voxels that its surface lies at; else Otsu's threshold",
    )
    parser.add_argument(
        "--smoothing", type=float, metavar="VOXELS", help="blur a volume before, sigma (0)"
    )
    add_repairs(parser)
    parser.set_defaults(own_mesh=optional)
    output = parser.add_argument(
        "-o", "--output", required=True, type=Path, metavar="OUT", help="result"
    )
    parser.add_argument(
        "--session",
        type=Path,
        metavar="FILE",
        help="start from a session file, or from a picture that Curvelight wrote",
    )
    parser.add_argument("--save-session", type=Path, metavar="FILE", help="write the session too")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return output


def add_repairs(parser: argparse.ArgumentParser) -> None:
    """Add the flag that repairs a mesh.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    parser.add_argument(
        "--repair",
        type=_repair,
        action="append",
        dest="repairs",
        metavar="KIND[=VALUE]",
        help="repair the mesh before anything else; may be repeated, done in order: "
        f"{'; '.join(_repair_help(name) for name in KINDS)}".replace("%", "%%"),
    )


def add_picture(parser: argparse.ArgumentParser) -> None:
    """Add the flags of a picture's frame.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    group = parser.add_argument_group("picture")
    group.add_argument("--size", type=_size, metavar="WxH", help="pixels, such as 1600x1000")
    group.add_argument(
        "--camera",
        metavar="VIEW",
        help="auto, front, back, left, right, top, bottom, oblique, or 9 numbers with commas: "
        "position, target, up; a 10th is the angle of view in degrees",
    )
    group.add_argument("--background", metavar="COLOR", help="name, #rrggbb, or transparent")


def add_colors(parser: argparse.ArgumentParser, several: bool = False) -> None:
    """Add the flags of a colour map.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    several : bool
        Whether the command shows all quantities at once, and the disagreement of estimators.
    """
    group = parser.add_argument_group("colours")
    group.add_argument(
        "--quantity",
        choices=[name for name in get_args(Quantity) if several or name not in _SEVERAL],
        help="what is shown",
    )
    group.add_argument(
        "--colormap",
        metavar="NAME",
        help="green-red as in the paper (cividis is its twin "
        "for the colour-blind), or any of matplotlib's",
    )
    group.add_argument(
        "--range",
        type=_pair,
        metavar="LOW,HIGH",
        help="ends of the colour bar; else percentiles of what the error bars trust",
    )
    group.add_argument(
        "--symmetric", action="store_const", const=True, help="range as wide below 0 as above"
    )
    group.add_argument("--flip", action="store_const", const=True, help="turn the map round")
    group.add_argument(
        "--percentiles",
        type=_pair,
        metavar="LOW,HIGH",
        help="percentiles at the ends of a colour bar that has no --range (5,95)",
    )
    group.add_argument("--flat", action="store_const", const=True, help="colours without light")
    group.add_argument(
        "--fade",
        action="store_const",
        const=True,
        help="grey where the curvature is below its error",
    )
    group.add_argument(
        "--strokes",
        action="store_const",
        const=True,
        help="draw the principal directions: k1's in black, k2's in white",
    )


def add_curvature(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Add the flags of the curvature estimator, its own parameters included.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments: they say which estimator.
    """
    from lutcore.estimation import estimator_registry

    group = parser.add_argument_group("curvature")
    group.add_argument("--method", metavar="NAME", help="estimator; see curvelight models")
    group.add_argument("--scale", metavar="auto|LENGTH", help="averaging length, mesh units")
    group.add_argument("--mm-per-unit", type=float, metavar="N", help="size of a mesh unit")
    _add_parameters(parser, estimator_registry, _chosen(words, "--method", "estimator"))


def add_peers(parser: argparse.ArgumentParser) -> None:
    """Add the flag that names estimators to compare.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    parser.add_argument(
        "--disagree",
        type=_names,
        metavar="A,B,C[,...]",
        dest="peers",
        help="three estimators or more: map how far they are apart at each vertex (their median "
        "absolute deviation as one sigma); those that cannot estimate this mesh are left out",
    )


def add_shading(parser: argparse.ArgumentParser, words: list[str], with_model: bool = True) -> None:
    """Add the flags of shading, the parameters of the model and the profile included.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments: they say which model and which profile.
    with_model : bool
        Whether the command takes one model.
    """
    group = parser.add_argument_group("shading")
    if with_model:
        from lutcore.shading import model_registry

        group.add_argument("--model", metavar="NAME", help="shading model; see curvelight models")
        _add_parameters(parser, model_registry, _chosen(words, "--model", "model"))
    group.add_argument("--material", metavar="NAME", help="see curvelight materials")
    add_profile(parser, words)
    group.add_argument(
        "--shadows",
        choices=get_args(Shadows),
        help="whether the surface casts shadows on itself; auto: where they change more than 1 %%",
    )
    lights = {
        "--light": (_directional, "X,Y,Z[,E]", "directional light TO x,y,z"),
        "--camera-light": (_camera_directional, "X,Y,Z[,E]", "the same in the camera's axes"),
        "--point-light": (_point, "X,Y,Z[,I]", "point light at x,y,z"),
        "--cone-light": (_cone, "X,Y,Z,DX,DY,DZ,ANGLE[,I]", "cone light, half angle in degrees"),
    }
    for flag, (kind, metavar, doc) in lights.items():
        group.add_argument(
            flag,
            type=kind,
            action="append",
            dest="lights",
            metavar=metavar,
            help=f"{doc}; strength as one number or R,G,B; may be repeated",
        )
    group.add_argument("--exposure", type=float, metavar="X", help="factor before encoding")
    group.add_argument(
        "--no-albedo",
        action="store_const",
        const=False,
        dest="albedo",
        help="ignore the file's vertex colours",
    )


def add_profile(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Add the flags of the diffusion profile, its own parameters included.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments: they say which profile.
    """
    from lutcore.diffusion import profile_registry

    parser.add_argument(
        "--profile",
        metavar="NAME",
        help="how light spreads in the material; see curvelight models",
    )
    _add_parameters(parser, profile_registry, _chosen(words, "--profile", "profile"))


def profile_from(arguments: argparse.Namespace, start: Session) -> Method:
    """Return the diffusion profile that the arguments name.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used `add_profile`.
    start : Session
        Its profile is taken where they name none.

    Returns
    -------
    Method
        The profile.
    """
    return _method(start.profile, vars(arguments), "diffusion profile", "profile")


def session_from(arguments: argparse.Namespace, **fixed: Any) -> Session:
    """Return the session that the arguments describe.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used the functions above.
    **fixed : object
        Fields that the command decides.

    Returns
    -------
    Session
        Defaults, then the session file, then the flags.

    Raises
    ------
    SessionError, ParameterError
        If a file or a value is not right.
    """
    given = vars(arguments)
    if not (given["mesh"] or given["session"] or given["own_mesh"]):
        raise ParameterError("say which mesh: a file, sample:NAME, or --session FILE")
    start = _start(given.get("session"))
    changes = {name: given.get(name) for name in _PLAIN} | fixed
    if given.get("camera"):
        from app.camera import parse

        changes["camera"] = parse(given["camera"])
    if given.get("peers"):
        changes["peers"] = tuple(Method(name) for name in given["peers"])
    if given.get("repairs"):
        changes["repairs"] = tuple(given["repairs"])
    if given.get("lights"):
        changes["lights"] = tuple(given["lights"])
    if given.get("scale") is not None:
        start = _with_scale(start, given["scale"])
    changes["volume"] = _volume(start.volume, given)
    changes["estimator"] = _method(start.estimator, given, "curvature estimator", "method")
    changes["profile"] = profile_from(arguments, start)
    changes["model"] = _method(start.model, given, "shading model", "model")
    return state.replaced(start, **changes)


_SEVERAL = ("disagreement", "all")
_PLAIN = (
    "mesh",
    "mm_per_unit",
    "material",
    "shadows",
    "exposure",
    "albedo",
    "quantity",
    "colormap",
    "range",
    "symmetric",
    "flip",
    "percentiles",
    "fade",
    "strokes",
    "flat",
    "size",
    "background",
)


def _chosen(words: list[str], flag: str, field: str) -> str:
    """Name of the plug-in that the arguments choose: its parameters become flags."""
    scout = argparse.ArgumentParser(add_help=False, allow_abbrev=False, exit_on_error=False)
    scout.add_argument(flag, dest="name")
    scout.add_argument("--session", type=Path)
    scout.add_argument("--watch", action="store_true")
    try:
        known, _ = scout.parse_known_args(words)
    except argparse.ArgumentError:
        known = argparse.Namespace(name=None, session=None)  # the command's own parser will say
    if known.name:
        return str(known.name)
    try:
        start = _start(known.session)
    except SessionError:
        if not known.watch:
            raise
        start = Session()  # it will be said again, and waited for
    method: Method = getattr(start, field)
    return method.name


def _start(path: Path | None) -> Session:
    """Return the session to start from: a file's, a picture's, or the default."""
    if path is None:
        return Session()
    if path.suffix.lower() == ".png":
        from app.provenance import read_record

        return read_record(path).record.session
    return state.read(path)


def _add_parameters(parser: argparse.ArgumentParser, registry: Registry[Any], name: str) -> None:
    plugin = registry.get(name)
    specs = declared(plugin)
    if not specs:
        return
    group = parser.add_argument_group(f"parameters of {registry.kind} {name}")
    for parameter, spec in specs.items():
        dashed = parameter.replace("_", "-")
        default = plugin.__dataclass_fields__[parameter].default
        if isinstance(spec, Choice):
            doc, metavar = f"{spec.doc} ({default})", "|".join(spec.options)
        else:
            unit = f" {spec.unit}" if spec.unit else ""
            doc, metavar = f"{spec.doc} {spec.low:g} to {spec.high:g}{unit} ({default})", "N"
        group.add_argument(
            f"--{dashed}",
            dest=f"{registry.kind}:{parameter}",
            metavar=metavar,
            help=doc.replace("%", "%%"),
        )


def _method(start: Method, given: dict[str, Any], kind: str, flag: str) -> Method:
    name = given.get(flag) or start.name
    kept = dict(start.parameters) if name == start.name else {}
    prefix = f"{kind}:"
    for key, value in given.items():
        if key.startswith(prefix) and value is not None:
            kept[key.removeprefix(prefix)] = _number(value)
    return Method(name, kept)


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _floats(text: str, *counts: int) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not numbers with commas") from None
    if len(numbers) not in counts:
        wanted = " or ".join(map(str, counts))
        raise argparse.ArgumentTypeError(f"{text!r} has {len(numbers)} numbers, expected {wanted}")
    return numbers


def _strength(numbers: list[float]) -> Vector:
    """One number for white, three for RGB, none for 1."""
    if not numbers:
        return 1.0, 1.0, 1.0
    red, green, blue = numbers * 3 if len(numbers) == 1 else numbers
    return red, green, blue


def _vector(numbers: list[float]) -> Vector:
    x, y, z = numbers
    return x, y, z


def _directional(text: str) -> Directional:
    numbers = _floats(text, 3, 4, 6)
    return Directional(_vector(numbers[:3]), _strength(numbers[3:]), "world")


def _camera_directional(text: str) -> Directional:
    numbers = _floats(text, 3, 4, 6)
    return Directional(_vector(numbers[:3]), _strength(numbers[3:]), "camera")


def _point(text: str) -> Point:
    numbers = _floats(text, 3, 4, 6)
    return Point(_vector(numbers[:3]), _strength(numbers[3:]))


def _cone(text: str) -> Cone:
    numbers = _floats(text, 7, 8, 10)
    return Cone(_vector(numbers[:3]), _vector(numbers[3:6]), _strength(numbers[7:]), numbers[6])


def _size(text: str) -> tuple[int, int]:
    width, cross, height = text.lower().partition("x")
    if not (cross and width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT in pixels")
    return int(width), int(height)


def _names(text: str) -> list[str]:
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise argparse.ArgumentTypeError(f"{text!r} is not names with commas")
    return names


def _repair(text: str) -> Repair:
    kind, equals, number = text.partition("=")
    value = _floats(number, 1)[0] if equals else None
    try:
        return Repair(kind, value)  # type: ignore[arg-type]  # it checks the kind itself
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _repair_help(name: str) -> str:
    kind = KINDS[name]
    takes = f"=VALUE ({kind.default:g} {kind.value.unit})" if kind.value else ""
    return f"{name}{takes} {kind.words.lower()}"


def _pair(text: str) -> tuple[float, float]:
    low, high = _floats(text, 2)
    if not low < high:
        raise argparse.ArgumentTypeError(f"{text!r}: the first must be below the second")
    return low, high


def _volume(start: Volume, given: dict[str, Any]) -> Volume:
    level, smoothing = given.get("level"), given.get("smoothing")
    try:
        if level is not None:
            start = replace(start, level=None if level == "otsu" else float(level))
        return start if smoothing is None else replace(start, smoothing=smoothing)
    except ValueError:
        raise ParameterError(
            f"level = {level}, smoothing = {smoothing}: expected otsu or a number, and a number"
        ) from None


def _with_scale(start: Session, text: str) -> Session:
    # "auto" must also undo a session file's scale, which `replaced` would take for "unchanged".
    if text == "auto":
        return replace(start, scale=None)
    try:
        return state.replaced(start, scale=float(text))
    except ValueError:
        raise ParameterError(f"scale = {text!r} is neither auto nor a length") from None
