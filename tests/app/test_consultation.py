import numpy as np
import pytest
from msgspec.structs import replace

from app.pipeline import Pipeline
from app.session import Method, Session
from lutcore.errors import CancelledError, ParameterError

PEERS = tuple(Method(name) for name in ("rusinkiewicz2004", "ball-jet", "corrected-curvature"))
TORUS = Session(
    mesh="sample:torus", view="curvature", estimator=Method("rusinkiewicz2004"), peers=PEERS
)


def with_peers(*peers):
    return replace(TORUS, peers=peers)


def test_peers_are_asked_once_and_put_together():
    pipeline = Pipeline()
    found = pipeline.consult(TORUS)
    assert found.names == ("rusinkiewicz2004", "ball-jet", "corrected-curvature")
    assert not found.refused
    own = pipeline.curvatures(TORUS)
    spread = found.disagreement.spread
    assert spread.shape == own.k1.shape
    # Two balls of half the tube's radius bring a bias of some 7 %; the one-ring has none.
    assert 0.0 < np.median(spread) < 0.1 * np.median(own.k1)
    assert pipeline.consult(TORUS) is found
    assert pipeline.consult(replace(TORUS, quantity="disagreement")) is found


def test_a_scale_that_is_given_is_every_ones():
    pipeline = Pipeline()
    wide = pipeline.consult(replace(TORUS, scale=3.0))
    assert wide is not pipeline.consult(TORUS)
    assert not np.array_equal(
        wide.disagreement.distance[2], pipeline.consult(TORUS).disagreement.distance[2]
    )


def test_the_same_method_may_come_with_other_parameters_and_is_called_by_them():
    quadric = Method("ball-jet", {"degree": 2.0})
    found = Pipeline().consult(with_peers(*PEERS[:2], quadric))
    assert found.names[2] == "ball-jet (degree 2)"


def test_one_that_refuses_is_left_out_with_its_reason():
    found = Pipeline().consult(with_peers(*PEERS, Method("meshlab-pca")))
    assert len(found.names) == 3
    assert list(found.refused) == ["meshlab-pca"]
    assert "nothing to convert" in found.refused["meshlab-pca"]


def test_fewer_than_three_that_answer_are_an_error_with_the_reasons():
    with pytest.raises(ParameterError, match="2 of the 3 named can be used; meshlab-pca: the val"):
        Pipeline().consult(with_peers(*PEERS[:2], Method("meshlab-pca")))


@pytest.mark.parametrize(
    ("peers", "said"),
    [
        (PEERS[:2], "3 estimators or more, not 2"),
        ((*PEERS, Method("vttk")), "did you mean 'vtk'"),
        ((*PEERS, PEERS[0]), "rusinkiewicz2004 is named twice"),
    ],
)
def test_what_cannot_be_asked_is_refused_before_any_work(peers, said):
    steps = []
    pipeline = Pipeline(lambda share, step: steps.append(step) is None)
    with pytest.raises(ParameterError, match=said):
        pipeline.consult(with_peers(*peers))
    assert not steps


def test_asking_can_be_cancelled():
    with pytest.raises(CancelledError):
        Pipeline(lambda share, step: share < 0.5).consult(TORUS)
