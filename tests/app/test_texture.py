"""Textures of OBJ and GLB: read, placed, drawn by the pixel, and never in the mesh's way."""

import io
import json
import struct

import numpy as np
import pytest
from PIL import Image

from app.loading import load_mesh
from app.loading.atlas import joined
from app.picture import render
from app.pipeline import Pipeline
from app.session import Camera, Directional, Session

RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
# Lower left red, lower right green, upper left blue, upper right white.
QUARTERS = np.array([[BLUE, WHITE], [RED, GREEN]], dtype=np.uint8).repeat(8, 0).repeat(8, 1)
POINTS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
SQUARE = "".join(f"v {x} {y} {z}\n" for x, y, z in POINTS)
PLACES = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
FACES = "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
MATERIAL = "newmtl skin\nmap_Kd -s 1 1 1 map.png\n"


def png(pixels) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


@pytest.fixture
def obj(tmp_path):
    def write(faces=FACES, material=MATERIAL, picture=None, places=PLACES):
        path = tmp_path / "square.obj"
        path.write_text(f"mtllib square.mtl\n{SQUARE}{places}usemtl skin\n{faces}")
        (tmp_path / "square.mtl").write_text(material)
        (tmp_path / "map.png").write_bytes(png(QUARTERS) if picture is None else picture)
        return path

    return write


def glb(tmp_path, picture=None, uv=((0, 1), (1, 1), (1, 0), (0, 0))):
    parts = [
        np.array(POINTS, "<f4").tobytes(),
        np.array(uv, "<f4").tobytes(),
        np.array([0, 1, 2, 0, 2, 3], "<u4").tobytes(),
        png(QUARTERS) if picture is None else picture,
    ]
    starts = np.cumsum([0, *(len(part) + -len(part) % 4 for part in parts)])
    binary = b"".join(part + bytes(-len(part) % 4) for part in parts)
    kinds = ((5126, 4, "VEC3"), (5126, 4, "VEC2"), (5125, 6, "SCALAR"))
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": int(start), "byteLength": len(part)}
            for start, part in zip(starts, parts, strict=False)
        ],
        "accessors": [
            {"bufferView": view, "componentType": kind, "count": count, "type": name}
            for view, (kind, count, name) in enumerate(kinds)
        ],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}
                ]
            }
        ],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path = tmp_path / "square.glb"
    path.write_bytes(
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
        + struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(binary), 0x004E4942)
        + binary
    )
    return path


def seen(path, **fields):
    """The four quarters of the square in a picture of it: lower left, right, upper left, right."""
    session = Session(
        mesh=str(path),
        lights=(Directional((0.0, 0.0, 1.0)),),
        model=fields.pop("model", Session().model),
        camera=Camera((0.5, 0.5, 5.0), (0.5, 0.5, 0.0), height=1.2),
        size=(240, 240),
        exposure=8.0,
        scale=1.0,  # the square is smaller than what would be chosen
        **fields,
    )
    image = render(session, Pipeline()).image
    # The caption's strip takes 4.5 % of the height.
    low, high, left, right = 155, 70, 75, 165
    return [
        image[y, x].astype(int) for y, x in ((low, left), (low, right), (high, left), (high, right))
    ]


def colors_are_quarters(found):
    for pixel, (red, green, blue) in zip(found, (RED, GREEN, BLUE), strict=False):
        lit = np.array([red, green, blue]) > 0
        assert pixel[lit].min() > 60 and pixel[~lit].max() <= 1, found
    assert found[3].min() > 60, found


def test_an_obj_shows_its_texture_the_right_way_up(obj):
    loaded = load_mesh(obj())
    assert len(loaded.mesh.vertices) == 4 and loaded.texture is not None and not loaded.warnings
    colors_are_quarters(seen(obj()))


def test_a_glb_shows_its_texture_the_right_way_up(tmp_path):
    colors_are_quarters(seen(glb(tmp_path)))


def test_without_albedo_the_texture_is_not_shown(obj):
    quarters = seen(obj(), albedo=False)
    assert max(np.ptp([pixel[c] for pixel in quarters]) for c in range(3)) <= 2


def test_polygons_and_relative_places_are_the_same(obj):
    whole = seen(obj())
    np.testing.assert_array_equal(seen(obj("f 1/1 2/2 3/3 4/4\n")), whole)
    relative = "f -4/-4 -3/-3 -2/-2\nf -4/-4 -2/-2 -1/-1\n"
    np.testing.assert_array_equal(seen(obj(relative)), whole)


def test_a_seam_splits_what_is_drawn_and_not_the_mesh(obj):
    loaded = load_mesh(obj("f 1/1 2/2 3/3\nf 1/2 3/3 4/4\n"))
    assert len(loaded.mesh.vertices) == 4
    assert len(loaded.texture.seams.vertices) == 5


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"picture": b"\x89PNG\r\n\x1a\nnothing"}, "cannot be read as a picture"),
        ({"material": "newmtl skin\nmap_Kd ../../secret.png\n"}, "outside its folder"),
        ({"material": "newmtl skin\nmap_Kd gone.png\n"}, "is not there"),
        ({"faces": "f 1/9 2/2 3/3\nf 1/1 3/3 4/4\n"}, "does not exist"),
        ({"places": "vt 0\n"}, "fewer than two numbers"),
    ],
)
def test_a_broken_texture_is_a_warning_and_the_mesh_is_there(obj, change, said):
    loaded = load_mesh(obj(**change))
    assert len(loaded.mesh.faces) == 2 and loaded.texture is None
    assert any(said in warning for warning in loaded.warnings), loaded.warnings


def test_a_broken_texture_of_a_glb_is_a_warning(tmp_path):
    loaded = load_mesh(glb(tmp_path, picture=b"no picture at all"))
    assert loaded.texture is None and any("picture" in one for one in loaded.warnings)


def test_faces_without_a_place_are_white(obj):
    found = seen(obj("f 1/1 2/2 3/3\nf 1 3 4\n"))
    assert found[1][0] <= 1 < 60 < found[1][1]  # green, of the textured half
    assert found[2].min() > 60


def test_the_picture_belongs_to_the_digest(obj):
    first = load_mesh(obj()).digest
    assert load_mesh(obj(picture=png(QUARTERS[::-1]))).digest != first


def test_two_pictures_lie_side_by_side_and_repeats_do_not():
    images = [np.full((4, 4, 3), 10, np.uint8), np.full((8, 2, 3), 20, np.uint8)]
    uv = np.array([[[0, 0], [1, 0], [0, 1]], [[2, 0], [3, 0], [2, 1]]], dtype=float)
    which = np.array([0, 1])
    picture, placed = joined(images, uv, which)
    height, width = picture.shape[:2]
    for face, value in enumerate((10, 20)):
        x, y = (placed[face].mean(axis=0) * (width, height)).astype(int)
        assert (picture[height - 1 - y, x] == value).all()
    assert joined(images, uv * (1.5, 1.0), which) is None
