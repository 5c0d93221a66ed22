"""Plug-ins found by name: built-in ones by their file, outside ones by entry point.

A built-in plug-in ``curvature-lut`` is the file ``plugins/shading/curvature_lut.py``; naming it
imports that file alone, and listing names imports none. lutcore never imports `plugins` itself:
the package is looked up by name when a plug-in is asked for.
"""

import importlib
import pkgutil
from collections.abc import Callable
from importlib.metadata import entry_points
from importlib.util import find_spec
from typing import Generic, TypeVar

from lutcore.errors import ParameterError
from lutcore.parameters import Parameters

T = TypeVar("T", bound=Parameters)


def built_in(package: str) -> set[str]:
    """Return the names of a package's plug-ins, importing none.

    Parameters
    ----------
    package : str
        Whose modules they are.

    Returns
    -------
    set of str
        In kebab case.
    """
    spec = find_spec(package)
    paths = spec.submodule_search_locations if spec else None
    found = pkgutil.iter_modules(paths or [])
    return {module.name.replace("_", "-") for module in found if module.name[0] != "_"}


class Registry(Generic[T]):
    """The plug-ins of one kind.

    Parameters
    ----------
    kind : str
        What they are, in words: ``"shading model"``.
    package : str
        Package whose modules are the built-in ones.
    group : str
        Entry-point group of the outside ones.
    """

    def __init__(self, kind: str, package: str, group: str) -> None:
        self.kind = kind
        self._package = package
        self._group = group
        self._loaded: dict[str, type[T]] = {}

    def register(self, name: str) -> Callable[[type[T]], type[T]]:
        """Return the class decorator that gives a plug-in its name.

        Parameters
        ----------
        name : str
            The name users type, in kebab case.

        Returns
        -------
        callable
            Registers the class and returns it unchanged.
        """

        def decorate(plugin: type[T]) -> type[T]:
            self._loaded[name] = plugin
            return plugin

        return decorate

    def names(self) -> list[str]:
        """Return every name, sorted, importing no plug-in.

        Returns
        -------
        list of str
            Built-in names and those of installed entry points.
        """
        outside = {entry.name for entry in entry_points(group=self._group)}
        return sorted(built_in(self._package) | outside | set(self._loaded))

    def get(self, name: str) -> type[T]:
        """Return the plug-in of that name.

        Parameters
        ----------
        name : str
            One of `names`.

        Returns
        -------
        type
            The plug-in's class; its fields are its parameters.

        Raises
        ------
        ParameterError
            If there is none, or its file does not register it.
        """
        if name not in self._loaded:
            self._import(name)
        if name not in self._loaded:
            raise ParameterError(f"the plug-in found for {self.kind} {name!r} does not register it")
        return self._loaded[name]

    def name_of(self, plugin: type[T]) -> str:
        """Return the name of a plug-in that `get` returned.

        Parameters
        ----------
        plugin : type
            Its class.

        Returns
        -------
        str
            The name it is registered under.

        Raises
        ------
        ParameterError
            If it is not.
        """
        for name, loaded in self._loaded.items():
            if loaded is plugin:
                return name
        raise ParameterError(f"no {self.kind} is registered as {plugin.__name__}")

    def _import(self, name: str) -> None:
        if name in built_in(self._package):
            importlib.import_module(f"{self._package}.{name.replace('-', '_')}")
            return
        for entry in entry_points(group=self._group, name=name):
            try:
                entry.load()
            except Exception as error:  # whatever another package's import may raise
                raise ParameterError(
                    f"the package that brings {self.kind} {name!r} cannot be loaded: "
                    f"{type(error).__name__}: {error}"
                ) from error
            return
        raise ParameterError.unknown(self.kind, name, self.names())
