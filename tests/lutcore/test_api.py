import lutcore


def test_the_names_that_scripts_rely_on_are_there():
    for name in lutcore.__all__:
        assert getattr(lutcore, name) is not None
    assert "skin1" in lutcore.materials()
    assert {"auto", "co-smoothing", "rusinkiewicz2004"} <= set(lutcore.estimators())
    assert {
        "lambert",
        "wrap",
        "kolchin2007-simplified",
        "kolchin2007",
        "curvature-lut",
    } <= set(lutcore.shading_models())


def test_the_way_from_a_mesh_to_light():
    mesh = lutcore.TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    curvatures = lutcore.principal_curvatures(mesh, method="rusinkiewicz2004")
    light = lutcore.DirectionalLight((0.0, 0.0, 1.0))
    exitance = lutcore.shade(mesh, curvatures, lutcore.material("skin1"), [light])
    table = lutcore.bake(lutcore.material("skin1"), samples=64)
    assert exitance.shape == (3, 3)
    assert table.evaluate([0.5, 1.0], 0.0).shape == (2, 3)
