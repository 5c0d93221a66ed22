import io
import zipfile

import numpy as np
import pytest

from app.loading import UnreadableFileError, load_mesh
from lutcore.errors import MeshError
from tests import mesh_files
from tests.more_files import MODEL, model, model_object, simple_three_mf, three_mf

VERTICES, FACES = mesh_files.grid()
SHEET = model_object(VERTICES, FACES)
ITEM = '<item objectid="1"/>'


def load(tmp_path, content, name="a.3mf"):
    (tmp_path / name).write_bytes(content)
    return load_mesh(tmp_path / name)


def refused(tmp_path, content, error=UnreadableFileError):
    with pytest.raises(error) as caught:
        load(tmp_path, content)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_an_object_keeps_vertices_and_faces_in_order(tmp_path):
    loaded = load(tmp_path, simple_three_mf(VERTICES, FACES))
    assert np.array_equal(loaded.mesh.vertices, VERTICES)
    assert np.array_equal(loaded.mesh.faces, FACES)
    assert (loaded.warnings, loaded.mm_per_unit) == ((), 1.0)


def test_it_is_told_by_its_content(tmp_path):
    loaded = load(tmp_path, simple_three_mf(VERTICES, FACES), "a.zip")
    assert "holds 3MF" in loaded.warnings[0]


@pytest.mark.parametrize(
    ("unit", "size"), [("micron", 0.001), ("inch", 25.4), ("foot", 304.8), ("meter", 1000.0)]
)
def test_its_unit_is_the_size_of_a_mesh_unit(tmp_path, unit, size):
    loaded = load(tmp_path, three_mf({MODEL: model(SHEET, ITEM, unit)}))
    assert loaded.mm_per_unit == size
    assert np.array_equal(loaded.mesh.vertices, VERTICES)


def test_items_and_components_place_objects(tmp_path):
    # Rows times matrices: a quarter turn about z takes x to y. First the component's, then the
    # item's.
    turn = "0 1 0 -1 0 0 0 0 1 0 0 0"
    both = f'<object id="2"><components><component objectid="1" transform="{turn}"/></components>'
    items = '<item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 20 30"/><item objectid="1"/>'
    loaded = load(tmp_path, three_mf({MODEL: model(SHEET + both + "</object>", items)}))
    x, y, z = VERTICES.T
    placed = np.column_stack((10 - y, 20 + x, 30 + z))
    np.testing.assert_allclose(loaded.mesh.vertices, np.concatenate((placed, VERTICES)), atol=1e-12)
    assert np.array_equal(loaded.mesh.faces, np.concatenate((FACES, FACES + len(VERTICES))))


def test_a_mirrored_object_is_not_inside_out(tmp_path):
    items = '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>'
    loaded = load(tmp_path, three_mf({MODEL: model(SHEET, items)}))
    assert np.array_equal(loaded.mesh.faces, FACES[:, ::-1])


def test_objects_may_lie_in_other_parts_and_the_model_elsewhere(tmp_path):
    part = '<object id="7"><components><component objectid="1" p:path="/3D/part.model"/>'
    relations = (
        '<Relationships><Relationship Target="/3D/main.model" Id="r" Type="http://schemas.microsoft'
        '.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    )
    content = three_mf(
        {
            "_rels/.rels": relations,
            "3D/main.model": model(part + "</components></object>", '<item objectid="7"/>'),
            "3D/part.model": model(SHEET, ""),
        }
    )
    assert np.array_equal(load(tmp_path, content).mesh.vertices, VERTICES)


def test_what_is_passed_over_is_said(tmp_path):
    support = SHEET.replace('id="1" type="model"', 'id="2" type="support"')
    colored = SHEET.replace('v3="6"/>', 'v3="6" pid="5" p1="0"/>', 1)
    items = '<item objectid="2"/><item objectid="1"/>'
    loaded = load(tmp_path, three_mf({MODEL: model(support + colored, items)}))
    assert len(loaded.mesh.faces) == len(FACES)
    assert "supports are left out" in loaded.warnings
    assert any("faces have colours" in warning for warning in loaded.warnings)
    unplaced = load(tmp_path, three_mf({MODEL: model(SHEET, "")}))
    assert len(unplaced.mesh.faces) == len(FACES)
    assert "places no object" in unplaced.warnings[0]


LAUGHS = "<!DOCTYPE m [" + "".join(
    f'<!ENTITY a{n} "&a{n - 1};&a{n - 1};">' for n in range(1, 60)
) + "]>"  # fmt: skip


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({MODEL: model(SHEET, ITEM, prolog=LAUGHS)}, "declares a document type"),
        ({MODEL: model(SHEET.replace('v1="0"', 'v1="25"', 1), ITEM)}, "[25, 1, 6] of 25 vertices"),
        ({MODEL: model(SHEET.replace('v1="0"', 'v1="-1"', 1), ITEM)}, "[-1, 1, 6] of 25 vertices"),
        ({MODEL: model(SHEET.replace(' v1="0"', "", 1), ITEM)}, "'triangle' has no 'v1'"),
        ({MODEL: model(SHEET.replace('x="1"', 'x="one"', 1), ITEM)}, "line 6 of 3D/3dmodel.model"),
        ({MODEL: model(SHEET, ITEM)[:-40]}, "of 3D/3dmodel.model: "),
        ({MODEL: model(SHEET, ITEM, "yard")}, "its unit is 'yard'"),
        ({MODEL: model(SHEET, '<item objectid="9"/>')}, "places object '9'"),
        ({MODEL: model(SHEET + SHEET, ITEM)}, "two objects have the id"),
        ({MODEL: model(SHEET, '<item objectid="1" transform="1 2"/>')}, "'item' has a wrong value"),
        ({MODEL: "<a>" * 100}, "more than 64 deep"),
        ({"3D/other.model": model(SHEET, ITEM)}, "no part '3D/3dmodel.model'"),
        ({MODEL: model(SHEET, '<item objectid="1" xmlns:p="q" p:path="/n"/>')}, "no part 'n'"),
        ({MODEL: model(SHEET, ITEM).replace("UTF-8", "UTF-9", 1)}, "unknown encoding"),
    ],
)
def test_damage_is_named_with_its_place(tmp_path, parts, words):
    assert words in refused(tmp_path, three_mf(parts))


def test_an_object_made_of_itself_is_refused(tmp_path):
    loop = '<object id="1"><components><component objectid="1"/></components></object>'
    assert "made of itself" in refused(tmp_path, three_mf({MODEL: model(loop, ITEM)}))


def test_objects_that_double_and_double_are_refused(tmp_path):
    levels = SHEET + "".join(
        f'<object id="{n}"><components>{f"<component objectid={chr(34)}{n - 1}{chr(34)}/>" * 9}'
        "</components></object>"
        for n in range(2, 40)
    )
    content = three_mf({MODEL: model(levels, '<item objectid="39"/>')})
    assert "more than 100000" in refused(tmp_path, content)


def test_a_large_object_placed_many_times_is_refused(tmp_path):
    vertices, faces = mesh_files.grid(60)
    content = three_mf({MODEL: model(model_object(vertices, faces), ITEM * 5000)})
    assert "18000000 vertices" in refused(tmp_path, content)


def test_a_bomb_is_refused(tmp_path):
    assert "unfold to more than" in refused(tmp_path, three_mf({MODEL: b" " * 80_000_000}))


def test_a_damaged_archive_is_refused(tmp_path):
    content = simple_three_mf(VERTICES, FACES)
    assert "zip directory" in refused(tmp_path, content[:-10])
    assert "is damaged" in refused(tmp_path, content[:60] + b"\0" * 20 + content[80:])
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr(MODEL, model(SHEET, ITEM))
    assert "packed by method 14" in refused(tmp_path, out.getvalue())


def test_a_model_without_triangles_is_no_surface(tmp_path):
    with pytest.raises(MeshError, match="no vertices") as caught:
        load(tmp_path, three_mf({MODEL: model("", "")}))
    assert not isinstance(caught.value, UnreadableFileError)
