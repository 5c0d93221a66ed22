import json
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from app.cli import main as entry
from app.cli.main import COMMANDS, main
from app.session import read

SMALL = ["--size", "160x120"]
FAST = ["--method", "rusinkiewicz2004"]


def image(path):
    return np.asarray(Image.open(path))


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.png"


def object_of(capsys):
    captured = capsys.readouterr()
    return json.loads(captured.out), captured.err


def test_help_lists_every_command(capsys):
    assert main([]) == 0
    shown = capsys.readouterr().out
    assert all(command in shown for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command, capsys):
    assert main([command, "--help"]) == 0
    assert f"curvelight {command}" in capsys.readouterr().out


def test_help_imports_nothing_heavy():
    code = (
        "import sys; from app.cli.main import main; main(['--help']);"
        "heavy = ('numpy', 'numba', 'vtkmodules', 'scipy', 'msgspec');"
        "print([name for name in heavy if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_figure_shows_skin_left_and_curvature_right(out, capsys):
    assert (
        main(["figure", "sample:marble-face", "-o", str(out), "--json", "--size", "680x400"]) == 0
    )
    result, _ = object_of(capsys)
    picture = image(out).astype(int)
    assert picture.shape == (400, 680, 3)
    left, right = picture[:, :300], picture[:, 320:600]
    lit = left[left.sum(axis=2) > 250]
    assert (lit[:, 0] > lit[:, 2] + 20).mean() > 0.95  # skin: red above blue
    green = ((right[..., 1] > right[..., 0] + 20) & (right[..., 1] > right[..., 2] + 20)).mean()
    red = ((right[..., 0] > right[..., 1] + 60) & (right[..., 0] > 120)).mean()
    assert green > 0.1
    assert red > 0.01
    low, high = result["range"]
    assert result["range_unit"] == "1/mm"
    assert 0.0 <= low < high < 1.0


def test_shade_writes_a_picture_and_says_what_it_did(out, capsys):
    code = main(["shade", "sample:torus", "-o", str(out), "--json", *SMALL, *FAST])
    result, errors = object_of(capsys)
    assert code == 0
    # Its tube of 2 cm is within the range of light in skin, which is all there is to say.
    assert errors == f"curvelight: sample:torus: {result['warnings'][0]}\n"
    assert "curved within the range of light" in errors
    assert image(out).shape == (120, 160, 3)
    assert result["model"] == "curvature-lut"
    assert result["mm_per_unit"] == 1.0
    assert result["exitance"]["red"]["p99"] > result["exitance"]["blue"]["p99"] > 0.0


@pytest.mark.parametrize("suffix", ["vtp", "ply", "npz"])
def test_shade_writes_data(tmp_path, suffix, capsys):
    path = tmp_path / f"x.{suffix}"
    assert main(["shade", "sample:saddle", "-o", str(path), *FAST, "--quiet"]) == 0
    assert path.stat().st_size > 1000
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("suffix", ["png", "vtp", "ply", "csv", "npz"])
def test_curvature_writes_pictures_and_data(tmp_path, suffix, capsys):
    path = tmp_path / f"x.{suffix}"
    assert main(["curvature", "sample:sphere", "-o", str(path), "--json", *FAST]) == 0
    result, _ = object_of(capsys)
    assert path.exists()
    assert result["percentiles"]["interior"]["mean"]["p50"] == pytest.approx(0.1, rel=0.01)
    assert result["not_estimated"] == 0


def test_curvature_data_match_the_exact_curvature_beside_the_sample(tmp_path):
    from app.samples import sample

    path = tmp_path / "x.npz"
    assert main(["curvature", "sample:torus", "-o", str(path), "--quiet"]) == 0
    with np.load(path) as found, np.load(sample("torus").exact) as exact:
        error = np.hypot(found["k1"] - exact["k1"], found["k2"] - exact["k2"])
        scale = np.sqrt(np.mean(exact["k1"] ** 2 + exact["k2"] ** 2))
    # A 5 000-vertex torus has 14 edges around its tube; auto is within 2 % of its curvature there.
    assert np.sqrt(np.mean(error**2)) < 0.02 * scale


def test_compare_draws_models_side_by_side_and_reports_their_difference(out, capsys):
    arguments = ["compare", "sample:torus", "-o", str(out), "--models", "lambert,curvature-lut"]
    assert main([*arguments, "--difference", "--json", *FAST, "--size", "600x200"]) == 0
    result, _ = object_of(capsys)
    assert result["models"] == ["lambert", "curvature-lut"]
    (found,) = result["ciede2000"].values()
    assert 0.0 < found["mean"] < found["p99"] < 50.0
    assert image(out).shape == (200, 600, 3)


def test_a_saved_session_gives_the_same_picture_bit_for_bit(tmp_path, capsys):
    one, other, saved = (tmp_path / name for name in ("1.png", "2.png", "s.json"))
    flags = ["--material", "marble", "--model", "wrap", "--width", "0.4", *SMALL, *FAST]
    lights = ["--light", "-1,0.5,1,0.7", "--point-light", "20,20,20,900", "--camera", "oblique"]
    arguments = ["sample:torus", *flags, *lights]
    assert main(["shade", *arguments, "-o", str(one), "--save-session", str(saved)]) == 0
    session = read(saved)
    assert session.model.parameters == {"width": 0.4}
    assert [type(light).__name__ for light in session.lights] == ["Directional", "Point"]
    again = ["shade", "sample:torus", "--session", str(saved), "-o", str(other)]
    assert main(again) == 0
    np.testing.assert_array_equal(image(one), image(other))
    assert one.read_bytes() == other.read_bytes()


def test_a_models_parameters_are_flags_with_their_range_in_the_help(capsys):
    assert main(["shade", "--model", "wrap", "--help"]) == 0
    assert "--width" in capsys.readouterr().out
    arguments = ["shade", "sample:torus", "-o", "x.png", "--model", "wrap", "--width", "7"]
    assert main(arguments) == 2
    assert "width" in capsys.readouterr().err


def test_a_profile_and_its_parameters_are_flags_and_kept_in_the_session(tmp_path, capsys):
    saved = tmp_path / "s.json"
    out, other = (str(tmp_path / name) for name in ("a.npz", "b.npz"))
    flags = ["--profile", "donner-jensen2005", "--thickness", "5", *FAST, "--quiet"]
    first = ["shade", "sample:torus", "-o", out, *flags, "--save-session", str(saved)]
    assert main(first) == 0
    assert read(saved).profile.parameters == {"thickness": 5.0}
    assert main(["shade", "sample:torus", "--session", str(saved), "-o", other, "--quiet"]) == 0
    with np.load(out) as one, np.load(other) as two:
        np.testing.assert_array_equal(one["shading"], two["shading"])
    thin = ["shade", "sample:torus", "-o", out, *FAST, "--profile", "donner-jensen2005"]
    assert main([*thin, "--thickness", "0.5"]) == 2
    assert "mean free path" in capsys.readouterr().err


def test_lut_bakes_the_profile_that_is_named(tmp_path, capsys):
    arguments = ["lut", "skin1", "-o", str(tmp_path / "t.npz"), "--json"]
    assert main(arguments) == 0
    dipole, _ = object_of(capsys)
    assert main([*arguments, "--profile", "burley2015"]) == 0
    burley, _ = object_of(capsys)
    assert (dipole["profile"], burley["profile"]) == ("jensen2001", "burley2015")
    assert dipole["samples"] == 64
    assert burley["samples"] == 512
    assert burley["psi0"][0] < dipole["psi0"][0]


@pytest.mark.parametrize(
    ("flags", "scale"),
    [
        (["sample:bunny", "--scale", "2mm"], 0.02),
        (["sample:torus", "--scale", "2mm", "--mm-per-unit", "4"], 0.5),
        (["any.ply", "--scale", "2mm", "--mm-per-unit", "1000"], 0.002),
        (["any.ply", "--scale", "2", "--mm-per-unit", "1000"], 2.0),
    ],
)
def test_a_scale_in_mm_is_turned_into_mesh_units(flags, scale, capsys):
    assert main(["curvature", *flags, "--print-config"]) == 0
    assert json.loads(capsys.readouterr().out)["scale"] == pytest.approx(scale)


def test_the_table_says_how_long_a_mesh_unit_is_where_it_is_not_a_mm(tmp_path, capsys):
    words = ["curvature", "sample:torus", "-o", str(tmp_path / "a.csv"), *FAST]
    assert main(words) == 0
    assert "in 1/mesh unit, convex positive" in capsys.readouterr().out
    assert main([*words, "--mm-per-unit", "4"]) == 0
    assert "in 1/mesh unit (1 mesh unit is 4 mm), convex positive" in capsys.readouterr().out


def test_scale_auto_undoes_a_session_files_scale(tmp_path):
    saved = tmp_path / "s.json"
    flags = ["sample:torus", "-o", str(tmp_path / "a.npz"), "--save-session", str(saved), *FAST]
    assert main(["curvature", *flags, "--scale", "0.5", "--quiet"]) == 0
    assert read(saved).scale == 0.5
    again = [*flags, "--session", str(saved), "--scale", "auto", "--quiet"]
    assert main(["curvature", *again]) == 0
    assert read(saved).scale is None


def test_models_materials_and_samples_list_themselves(capsys):
    assert main(["models"]) == 0
    assert "kolchin2007-simplified" in capsys.readouterr().out
    assert main(["models", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert listed["shading model"]["wrap"]["parameters"]["width"]["default"] == 0.2
    thickness = listed["diffusion profile"]["donner-jensen2005"]["parameters"]["thickness"]
    assert thickness["unit"] == "mm"
    assert main(["materials", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)) == 12
    assert main(["samples", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["marble-face-raw"]["vertices"] == 85_849


@pytest.mark.parametrize("suffix", ["npz", "exr", "png"])
@pytest.mark.parametrize("plane", [[], ["--plane", "32"]])
def test_lut_writes_tables(tmp_path, suffix, plane):
    path = tmp_path / f"t.{suffix}"
    assert main(["lut", "skin1", "-o", str(path), *plane]) == 0
    assert path.stat().st_size > 100


def test_doctor_says_what_draws(capsys):
    assert main(["doctor", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["drawing"]["renderer"]
    assert found["problem"] == ""


def test_doctor_names_what_is_missing_without_drawing(capsys, monkeypatch):
    from app import gl

    monkeypatch.setattr(gl, "missing_libraries", lambda: ["libegl1"])
    assert main(["doctor"]) == 1
    assert "apt-get install libegl1" in capsys.readouterr().out


def test_doctor_survives_a_driver_that_crashes(capsys, monkeypatch):
    from app.cli import doctor

    monkeypatch.setattr(doctor.sys, "executable", "false")
    assert main(["doctor"]) == 1
    assert "drawing ended with code 1" in capsys.readouterr().out


def test_numbers_that_begin_with_a_minus_are_values():
    assert entry._joined(["--light", "-1,0,0", "-o", "x"]) == ["--light=-1,0,0", "-o", "x"]
    assert entry._joined(["--light=1,0,0", "-1,0"]) == ["--light=1,0,0", "-1,0"]


def test_a_session_saved_elsewhere_finds_its_mesh_again_and_needs_no_mesh(
    tmp_path, monkeypatch, capsys
):
    (tmp_path / "scans").mkdir()
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scans" / "m.off").write_text("OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n")
    first = ["shade", "scans/m.off", "-o", "1.png", "--save-session", "out/s.json", *SMALL, *FAST]
    assert main(first) == 0
    monkeypatch.chdir(tmp_path / "scans")
    assert main(["shade", "--session", "../out/s.json", "-o", "../2.png"]) == 0
    assert (tmp_path / "1.png").read_bytes() == (tmp_path / "2.png").read_bytes()


def test_spectralon_is_said_to_have_no_absorption(out, capsys):
    arguments = ["shade", "sample:torus", "-o", str(out), "--material", "spectralon", *SMALL]
    assert main([*arguments, *FAST]) == 0
    assert "absorbs so little" in capsys.readouterr().err
