import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (found,) = folder.glob("*.whl")
    return found


def test_the_wheel_holds_code_samples_and_stubs_and_no_tests(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    for needed in (
        "lutcore/__init__.pyi",
        "plugins/shading/curvature_lut.py",
        "app/cli/main.py",
        "sample_meshes/marble_face.ply",
        "sample_meshes/catalogue.toml",
        "sample_meshes/SOURCES.md",
    ):
        assert needed in names
    assert not [name for name in names if name.startswith("tests")]


def test_an_installed_wheel_makes_the_figure_from_any_folder_without_a_writable_home(
    wheel, tmp_path
):
    site, elsewhere = tmp_path / "site", tmp_path / "elsewhere"
    elsewhere.mkdir()
    # Nobody, not even root, can make a folder below a file.
    (tmp_path / "file").write_text("")
    zipfile.ZipFile(wheel).extractall(site)
    environment = {
        "PATH": os.environ["PATH"],
        "PYTHONPATH": str(site),
        "HOME": str(tmp_path / "file" / "home"),
        "TMPDIR": str(tmp_path),
    }
    # Methods for which little is compiled: here nothing is kept from one run to the next.
    code = (
        "import app, sys; print(app.__file__); from app.cli.main import main;"
        "plain = ['--method', 'rusinkiewicz2004', '--model', 'lambert'];"
        "sys.exit(main(['figure', '-o', 'figure.png', '--size', '340x200', *plain]))"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=elsewhere,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(site))
    assert (elsewhere / "figure.png").stat().st_size > 10_000
    assert [path.name for path in elsewhere.iterdir()] == ["figure.png"]
    # The compiled code went where it could be written, not beside the sources.
    assert not list(site.rglob("*.nbi"))
    assert list(tmp_path.glob("curvelight-*/*/**/*.nbi"))
