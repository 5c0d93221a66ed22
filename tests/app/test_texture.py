"""Textures of OBJ and GLB: read, placed, drawn by the pixel, and never in the mesh's way."""

import io
import json
import struct

import numpy as np
import pytest
from PIL import Image

from app.loading import load_mesh
from app.loading.atlas import joined
from app.loading.texture_wrap import CLAMP, MIRROR, REPEAT, within
from app.picture import render
from app.pipeline import Pipeline
from app.session import Camera, Directional, Session

RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
# Lower left red, lower right green, upper left blue, upper right white.
QUARTERS = np.array([[BLUE, WHITE], [RED, GREEN]], dtype=np.uint8).repeat(8, 0).repeat(8, 1)
REPEATS = (REPEAT, REPEAT)
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


def glb(tmp_path, picture=None, uv=((0, 1), (1, 1), (1, 0), (0, 0)), change=lambda document: None):
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
    change(document)
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
        exposure=fields.pop("exposure", 8.0),
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
    picture, placed, _ = joined(images, uv, which, [REPEATS] * 2)
    height, width = picture.shape[:2]
    for face, value in enumerate((10, 20)):
        x, y = (placed[face].mean(axis=0) * (width, height)).astype(int)
        assert (picture[height - 1 - y, x] == value).all()
    assert joined(images, uv * (1.5, 1.0), which, [REPEATS] * 2) is None


WEBGL = {REPEAT: 10497, CLAMP: 33071, MIRROR: 33648}


def drawn_with(tmp_path, told=None, wrap=None, factor=None):
    """Return the four quarters of a GLB whose material says more, as names of colours."""

    def change(document):
        material = document["materials"][0]["pbrMetallicRoughness"]
        material["baseColorTexture"] |= told or {}
        if factor is not None:
            material["baseColorFactor"] = factor
        if wrap is not None:
            document["samplers"] = [{"wrapS": WEBGL[wrap[0]], "wrapT": WEBGL[wrap[1]]}]
            document["textures"][0]["sampler"] = 0

    # Corners on an edge of the picture are of either side.
    inset = ((0.01, 0.99), (0.99, 0.99), (0.99, 0.01), (0.01, 0.01))
    path = glb(tmp_path, uv=inset, change=change)
    assert not load_mesh(path).warnings
    named = {(True, False, False): "red", (False, True, False): "green"}
    named |= {(False, False, True): "blue", (True, True, True): "white"}
    pixels = [tuple(bool(one > 60) for one in pixel) for pixel in seen(path)]
    # At the vertices the same colours lie.
    corners = load_mesh(path).texture.at_vertices > 0.5
    order = (0, 1, 3, 2)  # lower left, lower right, upper left, upper right
    assert [tuple(map(bool, corners[one])) for one in order] == pixels
    return " ".join(named[one] for one in pixels)


def moved(**how):
    return {"extensions": {"KHR_texture_transform": how}}


@pytest.mark.parametrize(
    ("how", "found"),
    [
        ({}, "red green blue white"),
        # The lower left quadrant alone; the format counts from the upper left.
        ({"scale": [0.499, 0.499], "offset": [0.0005, 0.5005]}, "red red red red"),
        # Coordinates turn counter-clockwise, so the picture turns clockwise.
        ({"rotation": np.pi / 2, "offset": [0.0, 1.0]}, "green white red blue"),
        # Scaled first, then turned, then shifted.
        (
            {"rotation": np.pi / 2, "scale": [0.499, 0.998], "offset": [0.001, 0.9995]},
            "green green red red",
        ),
        ({"scale": [1.0, -1.0], "offset": [0.0, 1.0]}, "blue white red green"),
        ({"texCoord": 0}, "red green blue white"),
    ],
)
def test_a_texture_is_moved_as_its_file_says(how, found, tmp_path):
    told = moved(**how) | ({"texCoord": 5} if "texCoord" in how else {})
    assert drawn_with(tmp_path, told) == found


@pytest.mark.parametrize(
    ("wrap", "found"),
    [
        ((REPEAT, REPEAT), "red green blue white"),
        ((MIRROR, REPEAT), "green red white blue"),
        ((REPEAT, MIRROR), "blue white red green"),
        ((MIRROR, MIRROR), "white blue green red"),
        ((CLAMP, REPEAT), "green green white white"),
        ((REPEAT, CLAMP), "red green red green"),
        ((CLAMP, CLAMP), "green green green green"),
        ((MIRROR, CLAMP), "green red green red"),
    ],
)
def test_a_texture_goes_on_beyond_its_edges_as_its_file_says(wrap, found, tmp_path):
    # One picture's width to the right, and one's height down.
    assert drawn_with(tmp_path, moved(offset=[1.0, 1.0]), wrap) == found


def test_a_factor_multiplies_the_linear_colours_of_a_texture(tmp_path):
    def change(document):
        document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [1, 0.5, 0.25, 0.1]

    loaded = load_mesh(glb(tmp_path, change=change))
    plain = seen(glb(tmp_path), exposure=1.0)
    # sRGB of .5 and .25, by IEC 61966-2-1.
    assert loaded.texture.image[0, -1].tolist() == [255, 188, 137]
    white = seen(glb(tmp_path, change=change), exposure=1.0)[3] / 255.0
    linear = ((white + 0.055) / 1.055) ** 2.4
    base = ((plain[3] / 255.0 + 0.055) / 1.055) ** 2.4
    # Half a byte of the picture, and half a byte of the texture.
    np.testing.assert_allclose(linear / base, [1.0, 0.5, 0.25], rtol=0.02)


def test_a_part_without_a_picture_has_its_factor_beside_one_that_has(tmp_path):
    def change(document):
        document["accessors"].append(
            {"bufferView": 2, "componentType": 5125, "count": 3, "type": "SCALAR"}
        )
        document["accessors"].append(
            {"bufferView": 2, "byteOffset": 12, "componentType": 5125, "count": 3, "type": "SCALAR"}
        )
        document["materials"].append({"pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]}})
        (whole,) = document["meshes"][0]["primitives"]
        parts = [whole | {"indices": 3}, whole | {"indices": 4, "material": 1}]
        document["meshes"][0]["primitives"] = parts

    path = glb(tmp_path, change=change)
    assert not load_mesh(path).warnings
    _, right, left, _ = seen(path)
    assert right[1] > 60 > right[0]  # green, of the picture
    assert left[1] > 60 and left[0] <= 1 and left[2] <= 1  # green, of the factor


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d["textures"][0].update(sampler=0), "texture cannot be used"),
        (
            lambda d: d.update(samplers=[{"wrapS": 7}]) or d["textures"][0].update(sampler=0),
            "wrapS is 7",
        ),
        (
            lambda d: d["materials"][0]["pbrMetallicRoughness"].update(baseColorFactor=[2, 0, 0]),
            "baseColorFactor",
        ),
        (
            lambda d: d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(
                moved(scale=["a", 1])
            ),
            "KHR_texture_transform",
        ),
        (
            lambda d: d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(
                moved(offset=[1e400, 1])
            ),
            "KHR_texture_transform",
        ),
    ],
)
def test_what_a_material_cannot_say_costs_the_texture_alone(change, said, tmp_path):
    loaded = load_mesh(glb(tmp_path, change=change))
    assert len(loaded.mesh.faces) == 2 and loaded.texture is None
    assert any(said in one for one in loaded.warnings), loaded.warnings


def test_pixels_beyond_a_picture():
    pixel = np.arange(-5, 9)
    assert within(pixel, 4, REPEAT).tolist() == [3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0]
    assert within(pixel, 4, CLAMP).tolist() == [0] * 6 + [1, 2] + [3] * 6
    assert within(pixel, 4, MIRROR).tolist() == [3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0]


def test_pictures_side_by_side_keep_what_lies_in_one_turn_of_them():
    ramp = (np.arange(4) * 20).astype(np.uint8)
    images = [np.broadcast_to(ramp[None, :, None], (4, 4, 3)), np.full((4, 4, 3), 200, np.uint8)]
    inside = np.array([[[1.1, 0], [1.2, 0], [1.1, 0.1]], [[0, 0], [1, 0], [0, 1]]], dtype=float)
    which = np.array([0, 1])

    def column(wrap):
        picture, placed, _ = joined(images, inside, which, [wrap, REPEATS])
        return picture[-1, int(placed[0, :, 0].mean() * picture.shape[1]), 0]

    assert column(REPEATS) == 0
    assert column((MIRROR, REPEAT)) == 60
    assert column((CLAMP, REPEAT)) == 60
    # A face that crosses an edge has no place beside a neighbour.
    assert joined(images, inside - (0.15, 0.0), which, [(CLAMP, REPEAT), REPEATS]) is None
