"""What is known of a measured curvature, in numbers: for a table, a script or a report."""

from dataclasses import dataclass

import numpy as np

from app.consultation import Consultation
from app.pipeline import Pipeline
from app.quantities import QUANTITIES, raw
from app.session import Session
from app.shown import names_shown, shown
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.diagnostics import Diagnosis, diagnose
from lutcore.statistics import Histogram, histogram, percentiles

Statistics = dict[str, dict[str, dict[str, float | None]]]
"""Percentiles by group of vertices and quantity."""


@dataclass(frozen=True, eq=False)
class Findings:
    """What a session's curvature says of itself.

    Parameters
    ----------
    method : str
        The estimator.
    curvatures : PrincipalCurvatures
        Its estimate.
    judged : Diagnosis
        Groups of vertices, and what needs no truth.
    statistics : dict
        Percentiles by group and quantity, in mesh units.
    histograms : dict of str to Histogram
        Of each quantity that the session shows, in `app.quantities.Quantity.unit`, over the range
        that it is shown in; vertices with an estimate count.
    consultation : Consultation or None
        What the session's peers say.
    """

    method: str
    curvatures: PrincipalCurvatures
    judged: Diagnosis
    statistics: Statistics
    histograms: dict[str, Histogram]
    consultation: Consultation | None

    @property
    def not_estimated(self) -> int:
        """Vertices without an estimate."""
        return int(np.count_nonzero(~self.curvatures.estimated))

    @property
    def scale(self) -> float:
        """Median scale of the vertices with an estimate, mesh units."""
        return float(np.median(raw("scale", self.curvatures)[self.curvatures.estimated]))

    @property
    def beyond_error(self) -> float | None:
        """Share of the vertices where the peers' spread exceeds twice the error bar."""
        if self.consultation is None:
            return None
        return self.consultation.disagreement.beyond(self.curvatures.error)

    @property
    def spread(self) -> FloatArray | None:
        """Disagreement of the peers at each vertex, 1/mesh unit."""
        return self.consultation.disagreement.spread if self.consultation else None

    @property
    def distances(self) -> dict[str, float]:
        """Median distance of each peer from their median, 1/mesh unit."""
        if self.consultation is None:
            return {}
        values = self.consultation.disagreement.typical_distance.tolist()
        return dict(zip(self.consultation.names, values, strict=True))

    @property
    def refused(self) -> dict[str, str]:
        """Peers that cannot estimate this mesh, with the reason."""
        return self.consultation.refused if self.consultation else {}

    def as_json(self) -> dict[str, object]:
        """Return what a script reads.

        Returns
        -------
        dict
            Plain data.
        """
        judged = self.judged
        result: dict[str, object] = {
            "method": self.method,
            "scale": self.scale,
            "unit": "1/mesh unit",
            "not_estimated": self.not_estimated,
            "share_below_error": judged.below_error,
            "gauss_bonnet": {
                "integral": judged.total_curvature,
                "angle_defects": judged.angle_defect,
                "residual": judged.gauss_bonnet_residual,
            },
            "counts": {
                name: int(np.count_nonzero(getattr(judged, name)))
                for name in ("interior", "border", "debris")
            },
            "percentiles": self.statistics,
            "histograms": {
                name: {
                    "unit": QUANTITIES[name].unit,
                    "edges": found.edges.tolist(),
                    "counts": found.counts.tolist(),
                    "below": found.below,
                    "above": found.above,
                }
                for name, found in self.histograms.items()
            },
        }
        if self.consultation is not None:
            result["disagreement"] = {
                "median_distance": self.distances,
                "refused": self.refused,
                "share_beyond_two_errors": self.beyond_error,
            }
        return result


def findings(session: Session, pipeline: Pipeline) -> Findings:
    """Measure a session's curvature and judge it.

    Parameters
    ----------
    session : Session
        Its mesh, estimator, scale, peers, quantity and range are used.
    pipeline : Pipeline
        Where arrays come from.

    Returns
    -------
    Findings
        The numbers.

    Raises
    ------
    MeshError, ParameterError
        If the mesh or a parameter does not allow it.
    """
    curvatures = pipeline.curvatures(session)
    consultation = pipeline.consult(session) if session.peers else None
    judged = diagnose(pipeline.subject(session).mesh, curvatures)
    values = {name: raw(name, curvatures) for name in QUANTITIES if name != "disagreement"}
    if consultation is not None:
        values["disagreement"] = consultation.disagreement.spread
    histograms = {}
    for name in names_shown(session):
        found = shown(session, pipeline, name)
        estimated = found.values[curvatures.estimated]
        histograms[name] = histogram(estimated, found.low, found.high)
    return Findings(
        method=session.estimator.name,
        curvatures=curvatures,
        judged=judged,
        statistics={
            group: {name: percentiles(of[mask]) for name, of in values.items()}
            for group, mask in judged.groups.items()
        },
        histograms=histograms,
        consultation=consultation,
    )
