"""A job from its TOML file: names, types and ranges are checked, and told with their place."""

import tomllib
from pathlib import Path
from typing import Annotated, Any

import msgspec
from msgspec import Meta, Struct, field

from app.batch.job import MEMORY_GIB, SECONDS, Block, Fields, Job, Output, Variation
from app.session import Positive, Session, SessionError
from app.session import read as read_session
from lutcore.errors import ParameterError

# Decided by the list of meshes, by the output, and by the program.
_NOT_SAID = ("mesh", "view", "format")
_FIELDS = [name for name in Session.__struct_fields__ if name not in _NOT_SAID]
_Names = Annotated[list[str], Meta(min_length=1)]


class JobError(SessionError):
    """A job file cannot be read, or says what a job cannot say."""


class _Own(Struct, frozen=True, forbid_unknown_fields=True):
    """What a block says beside fields of a session."""

    match: _Names | str
    outputs: Annotated[list[Output], Meta(min_length=1)] | None = None
    seconds: Positive | None = None
    memory_gib: Positive | None = None


class _Named(Struct, frozen=True, forbid_unknown_fields=True):
    """What a way of drawing says beside fields of a session."""

    name: Annotated[str, Meta(min_length=1)]
    file: str | None = None


class _File(Struct, frozen=True, forbid_unknown_fields=True):
    meshes: _Names | str
    outputs: Annotated[list[Output], Meta(min_length=1)] = field(default_factory=lambda: ["figure"])
    template: str | None = None
    seconds: Positive = SECONDS
    memory_gib: Positive = MEMORY_GIB
    defaults: Fields = {}
    sessions: list[Fields] = []
    blocks: list[Fields] = []


def read(path: Path) -> Job:
    """Read a job file.

    Parameters
    ----------
    path : Path
        TOML.

    Returns
    -------
    Job
        Names, types and ranges checked; relative paths begin at the file's folder.

    Raises
    ------
    JobError
        If it cannot be read, is no TOML, or says what a job cannot say.
    """
    try:
        content = tomllib.loads(path.read_bytes().decode())
    except OSError as error:
        raise JobError(f"{path}: cannot be read ({error.strerror}); check its name") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise JobError(f"{path}: not TOML: {error}") from None
    file = _converted(content, _File, str(path))
    variations = [_variation(given, path, n) for n, given in enumerate(file.sessions, 1)]
    names = [one.name for one in variations]
    if len(set(names)) < len(names):
        raise JobError(f"{path}: two of [[sessions]] have one name; rename one of {names}")
    return Job(
        label=str(path),
        folder=path.parent,
        meshes=[file.meshes] if isinstance(file.meshes, str) else file.meshes,
        outputs=list(file.outputs),
        template=file.template,
        seconds=file.seconds,
        memory_gib=file.memory_gib,
        defaults=checked(file.defaults, f"{path}: [defaults]"),
        sessions=variations or [Variation("default", {})],
        blocks=[_block(given, path, n) for n, given in enumerate(file.blocks, 1)],
    )


def checked(fields: Fields, label: str) -> Fields:
    """Return fields of a session after making sure that a session can have them.

    Parameters
    ----------
    fields : dict
        Plain data.
    label : str
        Where they stand, for messages.

    Returns
    -------
    dict
        The same.

    Raises
    ------
    JobError
        If a name does not exist, or a value cannot be.
    """
    for name in fields:
        if name in _NOT_SAID:
            raise JobError(f"{label}: {name} is decided by the job's meshes and outputs; remove it")
        if name not in _FIELDS:
            raise JobError(f"{label}: {ParameterError.unknown('field', name, _FIELDS)}")
    _converted(fields, Session, label)
    return fields


def _converted(content: object, kind: type[Any], label: str) -> Any:
    try:
        return msgspec.convert(content, kind)
    except (msgspec.ValidationError, ValueError) as error:
        raise JobError(f"{label}: {error}") from None


def _parted(given: Fields, kind: type[Any], label: str) -> tuple[Any, Fields]:
    """Return what a table says of itself, and its fields of a session."""
    own = {name: value for name, value in given.items() if name in kind.__struct_fields__}
    rest = {name: value for name, value in given.items() if name not in own}
    return _converted(own, kind, label), checked(rest, label)


def _block(given: Fields, path: Path, n: int) -> Block:
    own, fields = _parted(given, _Own, f"{path}: [[blocks]] {n}")
    match = [own.match] if isinstance(own.match, str) else own.match
    return Block(match, fields, own.outputs, own.seconds, own.memory_gib)


def _variation(given: Fields, path: Path, n: int) -> Variation:
    own, fields = _parted(given, _Named, f"{path}: [[sessions]] {n}")
    start = said_by(path.parent / own.file) if own.file else {}
    return Variation(own.name, start | fields)


def said_by(path: Path) -> Fields:
    """Return the fields that a session file says.

    Parameters
    ----------
    path : Path
        A session file.

    Returns
    -------
    dict
        Without its mesh and its view, which a job decides.

    Raises
    ------
    SessionError
        If it cannot be read or holds no session.
    """
    read_session(path)
    content: Fields = msgspec.json.decode(path.read_bytes())
    return {name: value for name, value in content.items() if name in _FIELDS}
