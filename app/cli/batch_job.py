"""The job that the arguments of `curvelight batch` describe: a file, or meshes, and flags."""

import argparse
from pathlib import Path
from typing import Any

import msgspec
from msgspec.structs import replace

from app import session as state
from app.batch.job import OUTPUTS, Fields, Job
from app.batch.job_file import read, said_by
from app.cli.options.session import said
from app.session import Session
from lutcore.errors import ParameterError


def job_from(arguments: argparse.Namespace) -> tuple[Job, Fields]:
    """Return what shall be done.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    job : Job
        From the file, or from the meshes; limits, outputs and template as the flags say.
    overrides : dict
        Fields of a session that flags say: they stand above the job's.

    Raises
    ------
    SessionError, ParameterError
        If a file or a value is not right.
    """
    files = [source for source in arguments.sources if source.lower().endswith(".toml")]
    if files and len(arguments.sources) > 1:
        raise ParameterError(f"{files[0]} is a job: name it alone, or meshes without it")
    if files:
        job = read(Path(files[0]))
    else:
        job = Job("the command line", Path(), list(arguments.sources))
    return _with_flags(job, arguments), _overrides(arguments)


def _with_flags(job: Job, arguments: argparse.Namespace) -> Job:
    given: dict[str, Any] = {}
    if arguments.outputs:
        given["outputs"] = [name.strip() for name in arguments.outputs.split(",")]
        for name in given["outputs"]:
            if name not in OUTPUTS:
                raise ParameterError.unknown("output", name, OUTPUTS)
    for name in ("seconds", "memory_gib"):
        value = getattr(arguments, name)
        if value is not None:
            if not value > 0.0:
                raise ParameterError(f"{name.replace('_', '-')} = {value:g} is not above 0")
            given[name] = value
    # A flag stands above what a block says, too.
    blocks = [replace(block, **dict.fromkeys(given)) for block in job.blocks]
    if arguments.template:
        given["template"] = arguments.template
    return replace(job, blocks=blocks, **given)


def _overrides(arguments: argparse.Namespace) -> Fields:
    start = state.read(arguments.session) if arguments.session else Session()
    fields = said(arguments, start)
    state.checked(start, **fields)
    file = said_by(arguments.session) if arguments.session else {}
    plain: Fields = msgspec.to_builtins(fields)
    return file | plain
