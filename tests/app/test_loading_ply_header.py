import time

import numpy as np
import pytest

from app.loading import load_mesh
from app.loading.errors import BadContentError
from app.loading.ply_header import parse
from tests import mesh_files

VERTICES, FACES = mesh_files.grid(3)


@pytest.mark.parametrize("line", ["comment no end_header here", "obj_info end_header"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("blank", ["", " \t"])
def test_only_a_line_of_its_own_ends_the_header(line, end, blank):
    text = f"ply\nformat ascii 1.0\n{line}\nelement vertex 1\nproperty float x\n"
    text = (text + f"{blank}end_header{blank}\n").replace("\n", end)
    header = parse(text.encode() + b"5\n")
    assert [each.name for each in header.elements] == ["vertex"]
    assert (header.body, header.lines) == (len(text), 6)


def test_a_comment_that_holds_the_last_word_leaves_binary_data_in_place(tmp_path):
    content = mesh_files.ply(VERTICES, FACES, None, "<")
    content = content.replace(b"comment by hand", b"comment no end_header here")
    (tmp_path / "a.ply").write_bytes(content)
    assert np.array_equal(load_mesh(tmp_path / "a.ply").mesh.vertices, VERTICES)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["format ascii 1.0", "element v 1", "element v 1"], "line 4 .* is there already"),
        (["element v 1", "format ascii 1.0"], "line 2 .* before the line 'format'"),
        (["property int x", "format ascii 1.0"], "line 2 .* before the line 'format'"),
        (["format ascii 1.0", "property int x"], "line 3 of its header is 'property int x'"),
        (["format ascii 1.0", "format binary_little_endian 1.0"], "line 3 of its header"),
        (
            ["format ascii 1.0", "element v 1", "property int x", "property list int int x"],
            "line 5 .* that property is there already",
        ),
        (["comment nothing else"], "does not name a format"),
    ],
)
def test_a_header_that_contradicts_itself_is_refused(lines, words):
    with pytest.raises(BadContentError, match=words):
        parse("\n".join(["ply", *lines, "end_header\n"]).encode())


def wide(count):
    lines = [f"property int p{index}" for index in range(count)]
    head = ["ply", "format ascii 1.0", "element vertex 0", *lines, "element face 0"]
    return "\n".join([*head, "property int p0", "end_header\n"]).encode()


def test_a_thousand_properties_are_read_in_order():
    vertex, face = parse(wide(1000)).elements
    assert [each.name for each in vertex.properties] == [f"p{index}" for index in range(1000)]
    assert len(face.properties) == 1


def test_more_properties_are_refused_at_once():
    began = time.perf_counter()
    with pytest.raises(BadContentError, match=r"line 1004 .* after 1000 others"):
        parse(wide(40_000))
    # Comparing each with all before it takes 8e8 steps, minutes.
    assert time.perf_counter() - began < 5
