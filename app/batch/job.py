"""What a batch shall do.

A job names meshes, what is drawn of each, and how: fields of a session (`app.session.Session`)
from ``[defaults]``, then from each of ``[[sessions]]``, then from every one of ``[[blocks]]`` whose
pattern matches the mesh, in the order in which they stand.
"""

from pathlib import Path
from typing import Any, Literal, get_args

from msgspec import Struct, field

Output = Literal["shade", "curvature", "compare", "figure", "report"]
OUTPUTS: tuple[str, ...] = get_args(Output)
Fields = dict[str, Any]
"""Fields of a session that somebody said."""
SECONDS, MEMORY_GIB = 300.0, 4.0
"""What one mesh may take where nobody says more."""


class Variation(Struct, frozen=True):
    """One way of drawing every mesh.

    Parameters
    ----------
    name : str
        What ``{session}`` becomes.
    fields : dict
        Fields of the session.
    """

    name: str
    fields: Fields


class Block(Struct, frozen=True):
    """What holds for some of the meshes.

    Parameters
    ----------
    match : list of str
        Patterns of paths as in a shell; ``*`` crosses folders.
    fields : dict
        Fields of the session.
    outputs : list of str or None
        What is drawn instead of the job's own.
    seconds, memory_gib : float or None
        Limits instead of the job's own.
    """

    match: list[str]
    fields: Fields
    outputs: list[str] | None = None
    seconds: float | None = None
    memory_gib: float | None = None


class Job(Struct, frozen=True):
    """A batch before it meets any file.

    Parameters
    ----------
    label : str
        What to call it in a message.
    folder : Path
        Where relative paths begin.
    meshes : list of str
        Paths, patterns, ``sample:NAME`` or addresses that fsspec reads.
    outputs : list of str
        What is drawn of each mesh, of `OUTPUTS`.
    template : str or None
        Names of results; see `app.batch.template`.
    seconds, memory_gib : float
        What one mesh may take.
    defaults : dict
        Fields of every session.
    sessions : list of Variation
        Ways of drawing; at least one.
    blocks : list of Block
        What holds for some meshes.
    """

    label: str
    folder: Path
    meshes: list[str]
    outputs: list[str] = field(default_factory=lambda: ["figure"])
    template: str | None = None
    seconds: float = SECONDS
    memory_gib: float = MEMORY_GIB
    defaults: Fields = {}
    sessions: list[Variation] = field(default_factory=lambda: [Variation("default", {})])
    blocks: list[Block] = []
