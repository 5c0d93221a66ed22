"""Draw many meshes: one child process each, so that a mesh that crashes costs only itself.

-o names a folder. Beside the results it gets batch.jsonl (one line for each mesh: hash, timings,
percentiles, chosen models, warnings, hashes of the results, why it ended), summary.csv,
contact.png and index.html (every mesh with its curvature). Names follow --template: {stem},
{folder}, {n:3}, {session}, {output}, {model}, {material}, {method}.
"""

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.batch_job import job_from
from app.cli.batch_said import Told, say_plan
from app.cli.console import note
from app.cli.options.comparison import add_comparison
from app.cli.options.mesh import add_repairs, add_volume
from app.cli.options.methods import add_curvature, add_peers
from app.cli.options.picture import add_colors, add_picture
from app.cli.options.shading import add_shading
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from collections.abc import Generator

    from app.batch.ledger import Record
    from app.batch.plan import Item
    from app.batch.store import Store

PARTLY = 5
"""Exit code where part of the batch failed."""
_EXAMPLE = """\
a job file:
  meshes = ["scans/**/*.ply", "sample:torus"]    # paths, patterns; relative to this file
  outputs = ["shade", "curvature", "report"]     # also: compare, figure
  template = "{stem}/{session}-{output}"         # names of results, without their endings
  seconds = 300                                  # what one mesh may take
  memory_gib = 4

  [defaults]                                     # fields as in a session file (--save-session)
  size = [1200, 900]
  material = "skin1"
  model.name = "curvature-lut"

  [[sessions]]                                   # every mesh is drawn once for each of these
  name = "plain"

  [[sessions]]
  name = "marble"
  file = "hero.session.json"                     # starts from a session file
  material = "marble"

  [[blocks]]                                     # what holds for some meshes; later ones win
  match = ["*_cm.ply", "statues/*"]
  mm_per_unit = 10.0
  outputs = ["compare"]
  compared = [{name = "lambert"}, {name = "curvature-lut"}]

--resume takes up what was interrupted, killed or failed: it skips every mesh whose file, session,
package versions and results are unchanged. Exit codes: 5 where part failed, listed at the end.
"""


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    from app.batch.job import MEMORY_GIB, SECONDS

    parser.epilog = _EXAMPLE
    parser.add_argument(
        "sources", nargs="+", metavar="JOB.toml|MESH", help="one job file, or meshes and patterns"
    )
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="folder of results")
    parser.add_argument("--outputs", metavar="A[,B]", help="shade, curvature, compare, figure ...")
    parser.add_argument("--template", metavar="NAME", help="names of results: {stem}-{output}")
    parser.add_argument("--session", type=Path, metavar="FILE", help="start from a session file")
    parser.add_argument("--json", action="store_true", help="print one JSON line for each mesh")
    group = parser.add_argument_group("running")
    group.add_argument("--jobs", type=int, metavar="N", help="meshes at once; else one per core")
    failing = group.add_mutually_exclusive_group()
    failing.add_argument(
        "--keep-going", action="store_true", help="go on after a mesh failed (so unless said)"
    )
    failing.add_argument("--stop-on-error", action="store_true", help="end at the first failure")
    group.add_argument("--resume", action="store_true", help="skip what is done and unchanged")
    group.add_argument("--dry-run", action="store_true", help="say what, how long, how much disk")
    group.add_argument(
        "--seconds", type=float, metavar="N", help=f"time for one mesh ({SECONDS:g})"
    )
    group.add_argument(
        "--memory-gib", type=float, metavar="N", help=f"memory for one mesh ({MEMORY_GIB:g})"
    )
    group.add_argument("--parquet", action="store_true", help="write summary.parquet too")
    group.add_argument("--dask", metavar="ADDRESS", help="run on a Dask cluster: its scheduler")
    add_volume(parser)
    add_repairs(parser)
    add_shading(parser, words)
    add_curvature(parser, words)
    add_peers(parser)
    add_colors(parser, several=True)
    add_picture(parser)
    add_comparison(parser)
    parser.set_defaults(mesh=None, own_mesh=True)


def run(arguments: argparse.Namespace) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    int
        Exit code.
    """
    from app.batch import ledger, summary
    from app.batch.memory import watched
    from app.batch.plan import planned
    from app.batch.sheet_pages import SheetPages
    from app.batch.store import opened

    jobs = _jobs(arguments)
    if arguments.parquet:
        summary.require_parquet()
    job, overrides = job_from(arguments)
    items, remarks = planned(job, overrides)
    if not watched():
        remarks.append("this system does not tell what memory a process holds: no limit of it")
    for remark in remarks:
        note(arguments, remark)
    target = arguments.output if "://" in arguments.output else os.path.abspath(arguments.output)
    if arguments.dry_run:
        say_plan(arguments, items, target, jobs)
        return 0
    told = Told(arguments, items)
    store = opened(target)
    lines = ledger.Lines(store)
    found = _records(arguments, items, target, jobs)
    with SheetPages(store) as pages:
        try:
            for record in found:
                lines.add(record)
                pages.add(record)
                told.mesh(record)
                if arguments.stop_on_error and record["reason"] != ledger.DONE:
                    break
        finally:
            found.close()
            lines.write()
        pages.end()
    _write_sheets(arguments, store, lines.records)
    return PARTLY if told.end(lines.records) else 0


def _jobs(arguments: argparse.Namespace) -> int:
    jobs: int = arguments.jobs if arguments.jobs is not None else os.cpu_count() or 1
    if jobs < 1:
        raise ParameterError(f"jobs = {jobs}: at least one mesh is drawn at once")
    if arguments.dask and arguments.jobs is not None:
        raise ParameterError("--jobs is for this machine; a cluster draws as it has threads")
    return jobs


def _records(
    arguments: argparse.Namespace, items: "list[Item]", target: str, jobs: int
) -> "Generator[Record, None, None]":
    if arguments.dask:
        from app.batch.cluster import run_there

        return run_there(arguments.dask, items, target, resume=arguments.resume)
    from app.batch.pool import run_here

    return run_here(items, target, resume=arguments.resume, jobs=jobs)


def _write_sheets(arguments: argparse.Namespace, store: "Store", records: "list[Record]") -> None:
    from app.batch import summary
    from app.batch.sheet_page import write_html

    summary.write_csv(store, records)
    if arguments.parquet:
        summary.write_parquet(store, records)
    write_html(store, records)
