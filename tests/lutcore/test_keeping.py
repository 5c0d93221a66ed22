import os
import subprocess
import sys
from dataclasses import dataclass

import pytest

from lutcore import keeping
from lutcore.diffusion import Optics
from lutcore.keeping import kept

CODE = (
    "import sys, hashlib, pickle;"
    "from lutcore.baking import bake; from lutcore.fresnel import hinges;"
    "from lutcore.diffusion import diffusion_profile, optics;"
    "from lutcore.response import response;"
    "from lutcore.materials import material;"
    "table, fit = bake('skin1'), hinges(1.3, 4);"
    "seen = response(diffusion_profile('jensen2001'), optics(material('skin1'))[0]);"
    "arrays = *seen, table.psi, table.slope, table.reach, table.total, fit.corners, fit.weights;"
    "print(hashlib.sha256(b''.join(map(bytes, arrays))).hexdigest());"
    "print('scipy.special' in sys.modules, 'scipy.optimize' in sys.modules)"
)


def said(folder):
    done = subprocess.run(
        [sys.executable, "-c", CODE],
        env={**os.environ, "CURVELIGHT_CACHE_DIR": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split()


def test_another_process_gets_the_same_bits_without_scipy(tmp_path):
    first, special, optimize = said(tmp_path)
    assert (special, optimize) == ("True", "True")
    assert said(tmp_path) == [first, "False", "False"]
    tables = list((tmp_path / "tables").glob("*/*"))
    assert len(tables) == 3
    for place in tables:  # a damaged file is made anew
        place.write_bytes(place.read_bytes()[:-3])
    assert said(tmp_path) == [first, "True", "True"]
    assert said(tmp_path) == [first, "False", "False"]


@pytest.fixture
def made(tmp_path, monkeypatch):
    monkeypatch.setattr(keeping, "_folder", lambda: tmp_path)
    calls = []

    def sized(*arguments, **named):
        calls.append((arguments, named))
        return len(calls)

    return sized, calls, tmp_path


def test_each_set_of_arguments_has_its_own_result(made):
    function, calls, folder = made
    one = kept(function)
    found = [one(Optics(0.5, 1.3)), one(Optics(0.25, 1.3)), one(0.5, b=1), one(0.5, b=2)]
    assert found == [1, 2, 3, 4]
    other = kept(function)  # as another process
    assert [other(Optics(0.5, 1.3)), other(Optics(0.25, 1.3)), other(0.5, b=1)] == [1, 2, 3]
    assert len(calls) == len(list(folder.iterdir())) == 4


@dataclass(frozen=True)
class Foreign:
    value: float


def test_what_another_packages_code_may_change_is_not_kept_on_the_disk(made):
    function, _, folder = made
    assert kept(function)(Foreign(1.0)) == 1
    assert kept(function)(Foreign(1.0)) == 2
    assert not list(folder.iterdir())


def test_a_folder_that_takes_nothing_hinders_no_result(made, monkeypatch):
    function, _, folder = made
    monkeypatch.setattr(keeping, "_folder", lambda: folder / "gone")
    assert kept(function)(1.0) == 1
    assert kept(function)(1.0) == 2
