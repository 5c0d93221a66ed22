"""What the window saves as a picture is what the command line draws of the saved session."""

from functools import partial

import numpy as np
import pytest

from app.cli.main import main
from app.gui.saving import save_picture
from app.session import Camera, Cone, Directional, Method, Point, Session
from tests.app.gui.conftest import settled

SESSIONS = 20
MESHES = ("sphere", "saddle", "torus", "ellipsoid")
MODELS = ("lambert", "curvature-lut", "kolchin2007", "penner2011", "wrap")
ESTIMATORS = ("auto", "rusinkiewicz2004", "ball-jet")
MATERIALS = ("marble", "skin1", "apple", "potato")
QUANTITIES = ("curvedness", "k1", "mean", "gauss", "shape_index", "error")
CAMERAS = ("auto", "front", "top", "left", "oblique")
COLORMAPS = (None, "cividis", "viridis", "coolwarm")


@pytest.fixture(scope="module")
def shared(qapp, tmp_path_factory):
    """A window for all: what one session leaves behind must not show in the next picture."""
    from app.gui.settings import Settings
    from app.gui.window import Window

    folder = tmp_path_factory.mktemp("same")
    window = Window(Session(mesh="sample:sphere"), Settings(folder / "settings.json"))
    window.resize(700, 500)
    window.show()
    yield window, folder
    window.close()
    window.deleteLater()


def fields(seed: int) -> dict:
    """What is changed in the window: fields of a session, drawn by chance."""
    random = np.random.default_rng(seed)
    chosen = partial(_chosen, random)
    view = ("shade", "curvature", "figure", "compare")[seed % 4]
    found = {
        "mesh": f"sample:{MESHES[seed // 4 % 4]}",
        "view": view,
        "material": chosen(MATERIALS),
        "model": Method(chosen(MODELS)),
        "estimator": Method(chosen(ESTIMATORS)),
        "quantity": chosen(QUANTITIES),
        # The first one, so that no picture is black.
        "lights": (
            Directional((0.2, 0.3, 1.0), (0.3, 0.3, 0.3), "camera"),
            *(_light(random) for _ in range(random.integers(1, 4))),
        ),
        "exposure": chosen((None, 1.5)),
        "colormap": chosen(COLORMAPS),
        "range": chosen((None, (-0.1, 0.25))),
        "camera": chosen((*CAMERAS, _camera(random), _camera(random))),
        "size": (int(random.integers(180, 221)), int(random.integers(150, 171))),
        "background": chosen(("#20242a", "white", "#446688", "transparent")),
    }
    for name in ("symmetric", "flip", "fade", "strokes", "flat"):
        found[name] = bool(random.random() < 0.3)
    found["mm_per_unit"] = chosen((None, 2.5))
    if view == "compare":
        by = ("model", "estimator", "material")[seed // 4 % 3]
        names = {"model": MODELS, "estimator": ESTIMATORS, "material": MATERIALS}[by]
        first, second = random.choice(len(names), 2, replace=False)
        found |= {"compared_by": by, "compared": (Method(names[first]), Method(names[second]))}
        found |= {"wipe": chosen((None, 0.4)), "difference": chosen((False, True))}
        if by == "estimator":  # three do not fit beside their two bars
            found["size"] = (320, 160)
    return found


def _chosen(random, values):
    return values[random.integers(len(values))]


def _vector(random) -> tuple[float, float, float]:
    x, y, z = random.normal(size=3)
    return float(x), float(y), float(z)


def _light(random):
    strength = tuple(map(float, random.uniform(0.2, 1.5, 3)))
    x, y, z = _vector(random)
    away = 40.0 / np.linalg.norm((x, y, z))
    place = float(away * x), float(away * y), float(away * z)
    bright = tuple(1000.0 * one for one in strength)
    return (
        Directional((x, y, z), strength, "world"),
        Directional((x, y, abs(z)), strength, "camera"),
        Point(place, bright),
        Cone(place, (-x, -y, -z), bright, 35.0),
    )[random.integers(4)]


def _camera(random) -> Camera:
    x, y, z = _vector(random)
    away = 110.0 / np.linalg.norm((x, y, z))
    height = _chosen(random, (None, 45.0))
    position = float(away * x), float(away * y), float(away * z)
    return Camera(position, (0.0, 0.0, 0.0), (0.1, 1.0, 0.2), 30.0, height)


@pytest.mark.parametrize("seed", range(SESSIONS))
def test_the_window_saves_what_the_command_line_draws(shared, qtbot, seed) -> None:
    window, folder = shared
    controller = window.controller
    session, mine, theirs = (folder / f"{seed}{end}" for end in (".json", ".png", "-other.png"))
    assert controller.change("by chance", **fields(seed))
    settled(qtbot, window)
    assert not window.banner.isVisible(), window.banner.label.text()
    assert controller.save(session)
    save_picture(controller, mine)
    settled(qtbot, window)
    assert mine.exists(), window.banner.label.text()
    view = controller.session.view
    assert main([view, "--session", str(session), "-o", str(theirs), "--quiet"]) == 0
    assert mine.read_bytes() == theirs.read_bytes()


def test_one_command_draws_a_session_whatever_it_shows(shared, qtbot) -> None:
    window, folder = shared
    for seed in range(4):
        assert window.controller.change("by chance", **fields(seed))
        settled(qtbot, window)
        session, mine, theirs = (folder / f"d{seed}{end}" for end in (".json", ".png", "-o.png"))
        assert window.controller.save(session)
        save_picture(window.controller, mine)
        settled(qtbot, window)
        assert main(["draw", "--session", str(session), "-o", str(theirs), "--quiet"]) == 0
        assert mine.read_bytes() == theirs.read_bytes()
