"""List the shading models, diffusion profiles and curvature estimators with their parameters."""

import argparse
from typing import Any

from app.cli.console import answer
from lutcore.errors import ParameterError
from lutcore.parameters import Choice, Number, declared
from lutcore.registry import Registry


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    int
        Exit code.
    """
    from lutcore.diffusion import profile_registry
    from lutcore.estimation import estimator_registry
    from lutcore.shading import model_registry

    registries: list[Registry[Any]] = [model_registry, profile_registry, estimator_registry]
    result: dict[str, object] = {}
    lines: list[str] = []
    for registry in registries:
        lines += ["", f"{registry.kind}s:"] if lines else [f"{registry.kind}s:"]
        entries = {name: _entry(registry, name) for name in registry.names()}
        result[registry.kind] = entries
        for name, entry in entries.items():
            lines.append(f"  {name:24}{entry['summary']}")
            for parameter, spec in entry["parameters"].items():
                lines.append(f"      --{parameter.replace('_', '-'):20}{spec['doc']} {_span(spec)}")
    answer(arguments, result, "\n".join(lines))
    return 0


def _entry(registry: Registry[Any], name: str) -> dict[str, Any]:
    try:
        plugin = registry.get(name)
    except ParameterError as error:
        # A package of somebody else's that is broken must not hide all others.
        return {"summary": f"not available: {error}", "parameters": {}}
    return {
        "summary": (plugin.__doc__ or "").strip().splitlines()[0],
        "parameters": {
            parameter: _spec(spec) | {"default": plugin.__dataclass_fields__[parameter].default}
            for parameter, spec in declared(plugin).items()
        },
    }


def _spec(spec: Number | Choice) -> dict[str, Any]:
    if isinstance(spec, Choice):
        return {"options": list(spec.options), "doc": spec.doc}
    return {"low": spec.low, "high": spec.high, "unit": spec.unit, "doc": spec.doc}


def _span(spec: dict[str, Any]) -> str:
    if "options" in spec:
        return f"({' | '.join(spec['options'])}; default {spec['default']})"
    unit = f" {spec['unit']}" if spec["unit"] else ""
    return f"({spec['low']:g} to {spec['high']:g}{unit}; default {spec['default']:g})"
