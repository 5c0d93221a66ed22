import msgspec
import pytest

from app.session import (
    Camera,
    Cone,
    Directional,
    Method,
    Point,
    Session,
    SessionError,
    Substance,
    from_json,
    read,
    replaced,
    to_json,
    write,
)
from lutcore.errors import ParameterError

FULL = Session(
    mesh="scan.ply",
    mm_per_unit=2.5,
    view="compare",
    material=Substance("wax", (1.0, 2.0, 3.0), (0.0, 0.1, 0.2), 1.4),
    lights=(
        Directional((0.0, 0.0, 1.0), (1.0, 0.5, 0.25), "world"),
        Point((1.0, 2.0, 3.0)),
        Cone((1.0, 2.0, 3.0), (0.0, 0.0, -1.0), (2.0, 2.0, 2.0), 20.0),
    ),
    profile=Method("donner-jensen2005", {"thickness": 12.0}),
    model=Method("curvature-lut", {"hinges": 6.0}),
    compared=(Method("lambert", {"fresnel": "directional"}), Method("wrap")),
    difference=True,
    scale=0.75,
    range=(-0.1, 0.3),
    exposure=1.5,
    camera=Camera((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), height=2.0),
    size=(640, 480),
)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"scale": 0.0}, "scale = 0.0: expected a number > 0"),
        ({"size": (5, 500)}, "size = (5, 500): expected a whole number >= 16"),
        ({"percentiles": (5.0, 101.0)}, "percentiles = (5.0, 101.0): expected a number <= 100"),
    ],
)
def test_a_number_out_of_bounds_is_said_in_words(changes, message):
    with pytest.raises(ParameterError) as caught:
        replaced(FULL, **changes)
    assert str(caught.value) == message


@pytest.mark.parametrize("session", [Session(), FULL])
def test_a_session_comes_back_from_json_as_it_was(session):
    assert from_json(to_json(session)) == session


def test_a_session_saved_before_profiles_were_named_has_the_dipole():
    text = to_json(Session()).replace(b'"profile"', b'"ignored"')
    older = msgspec.json.decode(text)
    assert older.pop("ignored")["name"] == "jensen2001"
    assert from_json(msgspec.json.encode(older)) == Session()


def test_a_session_comes_back_from_a_file_as_it_was(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "s.json"
    write(FULL, path)
    again = read(path)
    assert again == msgspec.structs.replace(FULL, mesh=str(tmp_path / "scan.ply"))


def test_a_mesh_path_is_taken_from_the_session_files_folder_and_samples_are_not(tmp_path):
    path = tmp_path / "s.json"
    path.write_bytes(b'{"mesh": "a/b.ply"}')
    assert read(path).mesh == str(tmp_path / "a" / "b.ply")
    path.write_bytes(b'{"mesh": "sample:torus"}')
    assert read(path).mesh == "sample:torus"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"", "not a Curvelight session"),
        (b"[1, 2", "not a Curvelight session"),
        (b'{"colour": "red"}', "colour"),
        (b'{"mm_per_unit": 0}', "mm_per_unit"),
        (b'{"mm_per_unit": "big"}', "mm_per_unit"),
        (b'{"size": [4, 4]}', "size"),
        (b'{"view": "spin"}', "view"),
        (b'{"lights": [{"kind": "sun", "direction": [0, 0, 1]}]}', "lights"),
        (b'{"lights": [{"kind": "directional", "direction": [0, 1]}]}', "direction"),
        (b'{"camera": {"position": [0, 0, 1]}}', "camera"),
        (b'{"format": 2}', "format"),
        (b'{"exposure": NaN}', "malformed"),
    ],
)
def test_what_a_session_cannot_say_is_refused_by_name(text, said):
    with pytest.raises(SessionError, match=r"bad\.json") as caught:
        from_json(text, "bad.json")
    assert said in str(caught.value)


def test_a_missing_session_file_is_named(tmp_path):
    with pytest.raises(SessionError, match=r"gone\.json: cannot be read: No such file"):
        read(tmp_path / "gone.json")


def test_an_index_for_each_channel_comes_back_and_three_that_are_equal_are_one():
    wax = Substance("wax", (1.0, 2.0, 3.0), (0.0, 0.1, 0.2), (1.2, 1.3, 1.4))
    session = replaced(FULL, material=wax)
    assert from_json(to_json(session)) == session
    said = msgspec.json.decode(to_json(FULL))
    said["material"]["eta"] = [1.4, 1.4, 1.4]
    assert from_json(msgspec.json.encode(said)) == FULL
    assert to_json(from_json(msgspec.json.encode(said))) == to_json(FULL)
    for wrong in ([1.2, 1.3], [1.2, 1.3, 3.5], 0.9, "glass"):
        said["material"]["eta"] = wrong
        with pytest.raises(SessionError, match="eta"):
            from_json(msgspec.json.encode(said), "session.json")


def test_replacing_checks_values_and_leaves_what_is_not_said():
    assert replaced(FULL, exposure=None, scale=2.0).exposure == 1.5
    with pytest.raises(ParameterError, match="mm_per_unit"):
        replaced(FULL, mm_per_unit=-1.0)
