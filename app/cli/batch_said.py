"""What `curvelight batch` prints: the plan, a line for each mesh, and how it ended."""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.console import answer, clear_line, note, out, table

if TYPE_CHECKING:
    from app.batch.ledger import Record
    from app.batch.plan import Item

_MINUTE, _HOUR = 60.0, 3600.0
_MIB = 1 << 20


class Told:
    """Tells how a batch goes.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    items : sequence of Item
        The meshes of the batch.
    """

    def __init__(self, arguments: argparse.Namespace, items: "Sequence[Item]") -> None:
        self._arguments = arguments
        self._total = len(items)
        self._names = {item.n: _shortest(item.mesh) for item in items}
        self._done = self._failed = self._resumed = 0
        self._start = time.monotonic()

    def mesh(self, record: "Record") -> None:
        """Tell of one mesh: a line for a person, and one of JSON where asked for.

        Parameters
        ----------
        record : dict
            Of the mesh.
        """
        from app.batch.ledger import DONE, files_of, line

        self._done += 1
        self._resumed += bool(record.get("resumed"))
        if self._arguments.json:
            clear_line()
            out(line(record))
            sys.stdout.flush()
        if record["reason"] != DONE:
            self._failed += 1
            what = f"FAILED, {record['reason']}: {record['message']}"
        elif record.get("resumed"):
            what = "done before"
        else:
            count, warnings = len(files_of(record)), len(record["warnings"])
            what = f"{count} file{'s' * (count > 1)} in {record['seconds']:.2g} s"
            what += f", {warnings} warning{'s' * (warnings > 1)}" if warnings else ""
        note(
            self._arguments,
            f"{self._done}/{self._total} {self._names[record['n']]}: {what}{self._left()}",
        )

    def _left(self) -> str:
        drawn = self._done - self._resumed
        if not drawn or self._done == self._total:
            return ""
        spent = time.monotonic() - self._start
        return f"; about {_duration(spent / drawn * (self._total - self._done))} left"

    def end(self, records: "Sequence[Record]") -> int:
        """Tell how it ended: what failed and why, even to those who want quiet.

        Parameters
        ----------
        records : sequence of dict
            Of the meshes.

        Returns
        -------
        int
            How many failed.
        """
        from app.batch.ledger import DONE

        clear_line()
        failed = [record for record in records if record["reason"] != DONE]
        if failed:
            lines = [f"{len(failed)} of {self._total} meshes failed:"]
            lines += [
                f"  {self._names[one['n']]}: {one['reason']}: {one['message']}" for one in failed
            ]
            print("\n".join(lines), file=sys.stderr)  # noqa: T201
        if not (self._arguments.quiet or self._arguments.json):
            out(self._ending(len(records), len(failed)))
        return len(failed)

    def _ending(self, ended: int, failed: int) -> str:
        spent = time.monotonic() - self._start
        parts = [f"{ended - failed - self._resumed} drawn in {_duration(spent)}"]
        parts += [f"{self._resumed} done before"] if self._resumed else []
        parts += [f"{failed} failed"] if failed else []
        parts += [f"{self._total - ended} not begun"] if ended < self._total else []
        place = Path(self._arguments.output) / "index.html"
        page = f"{self._arguments.output.rstrip('/')}/index.html"
        return f"{', '.join(parts)}; see {page if '://' in self._arguments.output else place}"


def say_plan(
    arguments: argparse.Namespace, items: "Sequence[Item]", target: str, jobs: int
) -> None:
    """Tell what a batch would do, how long it would take and how much disk.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    items : sequence of Item
        The meshes.
    target : str
        The output folder; it is not made.
    jobs : int
        Meshes that are drawn at once.
    """
    from app.batch.estimate import estimate

    done = _done_before(items, target) if arguments.resume else set()
    open_ones = [item for item in items if item.n not in done]
    found = estimate(open_ones, jobs)
    seconds = dict(zip((item.n for item in open_ones), found.seconds, strict=True))
    # The last mesh may be the longest, and nobody helps it.
    whole = max(sum(found.seconds) / jobs, max(found.seconds, default=0.0))
    rows = [["n", "mesh", "results", "about s"]]
    plan = []
    for item in items:
        files = [file for work in item.works for file in work.files]
        known = seconds.get(item.n)
        told = "done before" if known is None else f"{known:.2g}"
        rows.append([str(item.n), item.name, ", ".join(files), told])
        plan.append({"n": item.n, "mesh": item.mesh, "files": files, "seconds": known})
    result: dict[str, object] = {
        "meshes": plan,
        "done_before": len(done),
        "seconds": whole,
        "bytes": found.bytes,
    }
    ending = (
        f"{len(open_ones)} meshes to draw, {jobs} at once: about {_duration(whole)}, about "
        f"{found.bytes / _MIB:.3g} MiB; estimated to a factor of two or so from two samples"
    )
    answer(arguments, result, f"{table(rows)}\n{ending}")


def _done_before(items: "Sequence[Item]", target: str) -> set[int]:
    from app.batch import ledger
    from app.batch.store import opened

    if "://" not in target and not Path(target).is_dir():
        return set()
    store = opened(target)
    keys = {
        item.n: ledger.key_of(item, ledger.content_of(item.mesh))
        for item in items
        if "://" not in item.mesh
    }
    return {n for n, key in keys.items() if ledger.finished(store, key) is not None}


def _shortest(mesh: str) -> str:
    """Return a path as it is seen from here, where that is shorter."""
    if "://" in mesh or not Path(mesh).is_absolute():
        return mesh
    with suppress(ValueError):  # on another drive of Windows
        return min(os.path.relpath(mesh), mesh, key=len)
    return mesh


def _duration(seconds: float) -> str:
    if seconds < _MINUTE:
        return f"{seconds:.2g} s" if seconds < 10.0 else f"{seconds:.0f} s"
    if seconds < _HOUR:
        return f"{seconds / _MINUTE:.0f} min"
    return f"{seconds / _HOUR:.1f} h"
