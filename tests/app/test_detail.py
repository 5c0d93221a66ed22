import json

import numpy as np
import pytest
from msgspec.structs import replace

from app.cli.main import main
from app.pipeline import Pipeline
from app.session import Method, Session

SESSION = Session(mesh="sample:ellipsoid", mm_per_unit=4.0)
AXES = np.eye(3)


def light(pipeline, **fields):
    session = replace(SESSION, **fields)
    return pipeline.exitance(session, session.model, AXES)


def test_channels_differ_in_detail_only_where_no_scale_is_given():
    pipeline = Pipeline()
    given = replace(SESSION, scale=pipeline.scale(SESSION))
    assert pipeline.detail(SESSION) is pipeline.detail(SESSION)
    assert pipeline.detail(given) is None
    assert pipeline.detail(replace(SESSION, estimator=Method("co-smoothing"))) is None
    # The curvatures are the same, what is made of them is not.
    assert pipeline.curvatures(SESSION) is pipeline.curvatures(given)
    assert not np.array_equal(light(pipeline), light(pipeline, scale=given.scale))


@pytest.mark.parametrize(
    "changed", [{"material": "marble"}, {"mm_per_unit": 3.0}, {"profile": Method("deon2012")}]
)
def test_detail_is_that_of_the_material_its_profile_and_its_size(changed):
    pipeline = Pipeline()
    one, other = pipeline.detail(SESSION), pipeline.detail(replace(SESSION, **changed))
    assert (one.widths != other.widths).all()
    assert not np.array_equal(one.normals, other.normals)


def test_a_model_that_is_not_local_gets_the_normals_with_all_detail():
    pipeline, model = Pipeline(), Method("jensen2002")
    smooth = light(pipeline, model=model, scale=3.0)
    assert not np.array_equal(light(pipeline, model=model), smooth)


@pytest.mark.parametrize("given", [[], ["--scale", "1"]])
def test_the_command_says_what_each_channel_sees(tmp_path, capsys, given):
    output = tmp_path / "e.npz"
    words = ["shade", SESSION.mesh, "-o", str(output), "--mm-per-unit", "4", "--json", *given]
    assert main(words) == 0
    result = json.loads(capsys.readouterr().out)
    pipeline = Pipeline()
    if given:
        assert (result["scale"], result["widths"]) == (1.0, None)
    else:
        assert result["scale"] == pipeline.scale(SESSION)
        assert result["widths"] == pipeline.detail(SESSION).widths.tolist()
