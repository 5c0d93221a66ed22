import json

import numpy as np
import pytest

from app.cli.main import main
from app.failing import BOUNDS, ERROR, failing
from app.loading import load_mesh
from app.pipeline import Pipeline
from app.session import Method, Session
from lutcore import analytic
from lutcore.diffusion import diffusion_profile, optics
from lutcore.materials import material
from lutcore.shading import model_registry, shading_models
from lutcore.stability_of_shading.maps import CURVATURES, OFF_BENT, OFF_FLAT, field, ground

FAST = ["--method", "rusinkiewicz2004", "--quiet", "--json", "--size", "64x64"]


def ball_file(path, radius):
    mesh = analytic.sphere(400, radius=radius).mesh
    lines = ["OFF", f"{len(mesh.vertices)} {len(mesh.faces)} 0"]
    lines += [" ".join(map(repr, vertex.tolist())) for vertex in mesh.vertices]
    lines += [" ".join(map(str, [3, *face.tolist()])) for face in mesh.faces]
    path.write_text("\n".join(lines))
    assert load_mesh(path).mesh.faces.shape == mesh.faces.shape
    return str(path)


@pytest.mark.parametrize("eta", [1.3, 1.5])
def test_bounds_are_where_the_maps_cross_the_error(eta):
    profile = diffusion_profile("jensen2001")
    balls = ground(eta, profile)
    step = (CURVATURES[1] / CURVATURES[0]) ** 2  # of E2
    for name in ("lambert", "curvature-lut", "kolchin2007", "kubo2010"):
        error = field(model_registry.get(name)(), balls, profile).error
        # From the largest curvature downwards, the last ball that is off.
        first = [
            balls.second[row][len(off) - np.argmin(np.append(off[::-1], False))]
            for row, off in enumerate(error > ERROR)
        ]
        # A cell of the map is as far as a bound can be known; the least over both indices.
        assert BOUNDS[name] <= 1.1 * min(first)
        assert min(first) <= 2.5 * step * BOUNDS[name]


def test_every_built_in_local_model_has_a_bound_or_a_reason():
    local = {name for name in shading_models() if model_registry.get(name).local}
    assert local - set(BOUNDS) == {"sphere-table"}  # right on every ball
    assert set(BOUNDS) <= local


def test_a_ball_lies_in_the_region_or_not_as_its_radius_says(tmp_path):
    constants = optics(material("skin1"))[0]
    square = diffusion_profile("jensen2001").mean_square(constants)
    length = float(material("skin1").mean_free_path[0])
    models = [Method(name) for name in ("lambert", "curvature-lut", "sphere-table", "wrap")]
    for second, expected in ((0.17, {"lambert", "wrap"}), (0.05, {"wrap"})):
        radius = length * np.sqrt(0.5 * square / second)
        session = Session(
            mesh=ball_file(tmp_path / f"{second}.off", radius),
            estimator=Method("rusinkiewicz2004"),
        )
        found = failing(session, Pipeline(), models)
        assert {one.model for one in found} == expected
        assert all(one.share == 1.0 for one in found)
        regions = {one.model: one.region for one in found}
        assert regions["wrap"] == OFF_FLAT
        assert regions.get("lambert", OFF_BENT) == OFF_BENT


@pytest.mark.parametrize("command", ["shade", "figure", "compare"])
def test_commands_say_so(tmp_path, capsys, command):
    mesh = ball_file(tmp_path / "ball.off", 0.5)
    words = [command, mesh, "-o", str(tmp_path / "a.png"), *FAST]
    chosen = ["--models", "lambert,wrap"] if command == "compare" else ["--model", "lambert"]
    if command != "shade":
        words[words.index("--size") + 1] = "400x64"
    assert main([*words, *chosen]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["failing"][0] == {"model": "lambert", "region": OFF_BENT, "share": 1.0}
    assert len(said["failing"]) == (2 if command == "compare" else 1)
    assert any("lambert is off by more than 10 %" in words for words in said["warnings"])
