"""The parser of a command, which says of a flag that it does not know where that belongs."""

import argparse
import re
from difflib import get_close_matches
from typing import Any, NoReturn

_UNKNOWN = re.compile(r"unrecognized arguments: (?:.* )?(?P<flag>--[a-z][a-z-]*)")
_CLOSE = 0.75


class Parser(argparse.ArgumentParser):
    """An `argparse.ArgumentParser` with advice on unknown flags."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong, and end the program."""
        found = _UNKNOWN.match(message)
        super().error(message if found is None else f"{message}{self._advice(found['flag'])}")

    def _advice(self, flag: str) -> str:
        for chooser, kind, names in _owners(flag):
            if chooser in self._option_string_actions:
                which = " or ".join(f"{chooser} {name}" for name in names)
                return f"; it is a parameter of another {kind}: give {which}"
        near = get_close_matches(flag, self._option_string_actions, 1, _CLOSE)
        return f"; did you mean {near[0]}?" if near else ""


def _owners(flag: str) -> list[tuple[str, str, list[str]]]:
    """Return the flag that chooses a plug-in, its kind, and the names of those with a parameter."""
    from lutcore.diffusion import profile_registry
    from lutcore.estimation import estimator_registry
    from lutcore.parameters import declared
    from lutcore.registry import Registry
    from lutcore.shading import model_registry

    parameter = flag.removeprefix("--").replace("-", "_")
    registries: dict[str, Registry[Any]] = {
        "--method": estimator_registry,
        "--model": model_registry,
        "--profile": profile_registry,
    }
    found = []
    for chooser, registry in registries.items():
        names = [name for name in registry.names() if parameter in declared(registry.get(name))]
        if names:
            found.append((chooser, registry.kind, names))
    return found
