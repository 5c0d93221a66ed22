"""What a child process does with one mesh: every result of it, and what is to be said of it.

Imported when the child warms up, so heavy packages are imported here at once.
"""

import argparse
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, cast

from msgspec.structs import replace

from app import session as state
from app.batch.plan import Work
from app.batch.store import digest
from app.batch.task import THUMBNAIL, Task
from app.batch.telling import chosen, failure, measured
from app.cli.work import Run
from app.contestants import alone, has_bar, labels
from app.findings import findings
from app.picture import render
from app.pipeline import Pipeline
from app.portable import portable
from app.provenance import write_picture
from app.record import record_of
from app.samples import PREFIX
from app.session import Session
from app.writing import write_bytes
from lutcore.statistics import percentiles

if TYPE_CHECKING:
    from app.picture import Picture

Plain = dict[str, object]
_CHANNELS = ("red", "green", "blue")


def drawn(task: Task) -> Plain:
    """Draw all that is asked for of one mesh.

    Parameters
    ----------
    task : Task
        The work; all of one mesh.

    Returns
    -------
    dict
        Plain data: the mesh, warnings, timings, one entry for each result, what went wrong.
    """
    bench = _Bench(task)
    with bench.pipeline.still():
        return bench.answer()


class _Bench:
    """One mesh at work."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.pipeline = Pipeline()
        self.warnings: dict[str, None] = {}
        self.timings: dict[str, float] = {}
        self.mesh: Plain = {}

    def answer(self) -> Plain:
        """Draw."""
        results: list[Plain] = []
        problems: list[Plain] = []
        for work in self.task.works:
            try:
                results.append(self._result(work))
            except Exception as error:
                problems.append(
                    {"output": work.output, "session": work.variation, **failure(error)}
                )
                if not self.mesh:  # it cannot be read, so the others would say the same
                    break
        return {
            **self.mesh,
            "warnings": list(self.warnings),
            "timings": {name: round(seconds, 4) for name, seconds in self.timings.items()},
            "outputs": results,
            "problems": problems,
        }

    def _result(self, work: Work) -> Plain:
        start = time.perf_counter()
        session = work.session
        place = Path(self.task.pending) / work.file
        place.parent.mkdir(parents=True, exist_ok=True)
        quiet = argparse.Namespace(output=place, quiet=True, json=True, save_session=None)
        # One pipeline for all results: the mesh is read and measured once.
        run = Run(quiet, session, self.pipeline)
        with self._timed("load"):
            subject = self.pipeline.subject(session)
            self.mesh = {
                "sha256": subject.loaded.digest,
                "vertices": len(subject.mesh.vertices),
                "faces": len(subject.mesh.faces),
                "mm_per_unit": self.pipeline.mm_per_unit(session),
            }
        with self._timed("inspect"):
            warnings = run.warn()
        with self._timed("curvature"):
            curvatures = self.pipeline.curvatures(session)
            told: Plain = {"percentiles": measured(curvatures)}
        with self._timed("draw"):
            if work.output == "report":
                told |= self._report(session, place)
            else:
                told |= self._picture(run, session, place)
        summary = run.summary(warnings)
        failing = cast(list[Plain], summary["failing"])
        self.warnings.update(dict.fromkeys(cast(list[str], summary["warnings"])))
        files = [
            {"file": name, "sha256": digest(content), "bytes": len(content)}
            for name in work.files
            for content in [(Path(self.task.pending) / name).read_bytes()]
        ]
        return {
            "output": work.output,
            "session": work.variation,
            "files": files,
            "material": self.pipeline.material(session).name,
            "estimator": session.estimator.label,
            "scale": self.pipeline.scale(session),
            **told,
            "failing": failing,
            "seconds": round(time.perf_counter() - start, 4),
        }

    def _picture(self, run: Run, session: Session, place: Path) -> Plain:
        made = render(session, self.pipeline)
        record = record_of(session, self.pipeline, made)
        # The record's path is turned round from the folder that the file is in now.
        seen = str(place.parent / self._seen(session.mesh, place))
        if not session.mesh.startswith(PREFIX):
            record = replace(record, session=replace(session, mesh=seen))
        write_picture(place, made.image, record)
        self._keep_small(made)
        told: Plain = {"exposure": made.exposure, "ranges": made.ranges}
        if session.view == "compare":
            told["compared"] = list(labels(session))
        shaded = [one for one in alone(session) if one.view != "curvature"]
        if shaded:
            told["models"] = [one.model.label for one in shaded]
            told["chosen"] = [chosen(one, self.pipeline, made) for one in shaded]
        if session.view == "shade":
            told["exitance"] = _exitance(run, made)
        if made.difference is not None:
            told["difference" if has_bar(session) else "ciede2000"] = made.difference
        return told

    def _report(self, session: Session, place: Path) -> Plain:
        from app.report import write

        found = findings(session, self.pipeline)
        beside = place.with_name(place.name.removesuffix(".html") + ".session.json")
        command = f"curvelight curvature --session {beside.name} -o {place.name}"
        write(place, session, self.pipeline, found, command)
        seen = replace(session, mesh=self._seen(session.mesh, place))
        write_bytes(beside, state.to_json(seen))
        for name, reason in found.refused.items():
            self.warnings[f"left out of the disagreement: {name}: {reason}"] = None
        return {}

    def _keep_small(self, made: "Picture") -> None:
        """Keep a small copy of the first picture: here it need not be read again."""
        place = Path(self.task.pending) / self.task.thumbnail
        if place.exists():
            return
        from PIL import Image

        small = Image.fromarray(made.image)
        small.thumbnail(THUMBNAIL)
        place.parent.mkdir(parents=True, exist_ok=True)
        small.save(place, format="PNG", compress_level=1)

    def _seen(self, mesh: str, place: Path) -> str:
        """Return a mesh's path as it is seen from the final folder of a pending file."""
        final = Path(self.task.origin) / place.relative_to(self.task.pending)
        return portable(mesh, final.parent)

    @contextmanager
    def _timed(self, step: str) -> Iterator[None]:
        start = time.perf_counter()
        try:
            yield
        finally:
            spent = time.perf_counter() - start
            self.timings[step] = self.timings.get(step, 0.0) + spent


def _exitance(run: Run, made: "Picture") -> Plain:
    exitance = run.exitance(made.camera)
    return {name: percentiles(exitance[:, channel]) for channel, name in enumerate(_CHANNELS)}
