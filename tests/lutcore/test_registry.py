import subprocess
import sys
from dataclasses import dataclass
from importlib.metadata import EntryPoint

import pytest

from lutcore import registry
from lutcore.errors import ParameterError
from lutcore.parameters import Parameters
from lutcore.registry import Registry


def test_listing_names_imports_no_plug_in():
    code = (
        "import sys; from lutcore.registry import Registry;"
        "print(Registry('shading model', 'plugins.shading', 'none').names());"
        "print([name for name in sys.modules if name.startswith('plugins.shading.')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    names, imported = done.stdout.splitlines()
    assert "curvature-lut" in names
    assert imported == "[]"


def test_a_name_that_does_not_exist_is_refused_with_the_nearest():
    found = Registry("shading model", "plugins.shading", "none")
    with pytest.raises(ParameterError, match="did you mean 'lambert'"):
        found.get("lambertian")


@dataclass(frozen=True)
class Outside(Parameters):
    """A plug-in of another package."""


def test_a_plug_in_of_another_package_is_found_by_its_entry_point(monkeypatch):
    found = Registry("shading model", "plugins.shading", "some.group")

    class Entry(EntryPoint):
        def load(self):
            return found.register("outside")(Outside)

    def entries(group, name="outside"):
        listed = [Entry("outside", "elsewhere:Outside", "some.group")]
        return listed if (group, name) == ("some.group", "outside") else []

    monkeypatch.setattr(registry, "entry_points", entries)
    assert "outside" in found.names()
    assert found.get("outside") is Outside


def test_a_file_that_does_not_register_its_name_is_a_fault_with_its_name(monkeypatch):
    found = Registry("shading model", "plugins.shading", "none")
    monkeypatch.setattr(found, "_import", lambda name: None)
    with pytest.raises(ParameterError, match="'lambert' does not register"):
        found.get("lambert")
