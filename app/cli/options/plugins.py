"""Flags of a plug-in: its name, and the parameters that it declares itself."""

import argparse
from pathlib import Path
from typing import Any

from app.cli.options.start import started
from app.session import Method, Session, SessionError
from lutcore.parameters import Choice, declared
from lutcore.registry import Registry


def add_plugin(
    parser: argparse.ArgumentParser,
    group: argparse._ActionsContainer,
    registry: Registry[Any],
    words: list[str],
    flag: str,
    field: str,
    doc: str,
) -> None:
    """Add the flag that names a plug-in, and those of its parameters.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command: gets the parameters.
    group : ArgumentParser or argument group
        Gets the name.
    registry : Registry
        Where it is found.
    words : list of str
        The command's arguments: they say which.
    flag : str
        As it is typed.
    field : str
        The session's, which says which plug-in where the arguments do not.
    doc : str
        Help.
    """
    group.add_argument(flag, metavar="NAME", help=doc)
    _add_parameters(parser, registry, _chosen(words, flag, field))


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
        start = started(known.session)
    except SessionError:
        if not known.watch:
            raise
        start = Session()  # it will be said again, and waited for
    method: Method = getattr(start, field)
    return method.name


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


def method_from(start: Method, given: dict[str, Any], kind: str, flag: str) -> Method | None:
    """Return the plug-in that the arguments name or set parameters of.

    Parameters
    ----------
    start : Method
        What it is where they name none.
    given : dict
        The arguments.
    kind : str
        The registry's.
    flag : str
        What holds the name.

    Returns
    -------
    Method or None
        None where they say nothing of it.
    """
    prefix = f"{kind}:"
    said = {
        key.removeprefix(prefix): _number(value)
        for key, value in given.items()
        if key.startswith(prefix) and value is not None
    }
    if not said and given.get(flag) is None:
        return None
    name = given.get(flag) or start.name
    kept = dict(start.parameters) if name == start.name else {}
    return Method(name, kept | said)


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
