"""Damage inside JSON, XML, zip and gzip, where damage to bytes seldom reaches."""

import functools
import gzip
import io
import json
import struct
import zipfile
import zlib
from copy import deepcopy
from typing import Any

import numpy as np

from tests.corpus.mutations import MUTATIONS, Mutation
from tests.more_files import MODEL, three_mf

_BOMB = 200_000_000
_VALUES: tuple[Any, ...] = (
    0, 1, -1, 25, 26, 10**6, 2**31, 2**32, 2**63, 10**400, 1.5, float("nan"), True, None, "", "0",
    [], {}, [[]], {"a": 1}, "data:,", "data:;base64,!!!!", "../../etc/hostname", "file:///etc/hosts",
    "SCALAR", "MAT4", 5120, 5126, [0] * 2000, [float("inf")] * 16,
)  # fmt: skip
_LAUGHS = b'<!DOCTYPE x [<!ENTITY a0 "ha">%s]>' % b"".join(
    b'<!ENTITY a%d "&a%d;&a%d;&a%d;&a%d;">' % (n, n - 1, n - 1, n - 1, n - 1) for n in range(1, 30)
)


def json_abuse(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Change values anywhere in the JSON of a glTF file, or nest it without end."""
    binary = content.startswith(b"glTF")
    length = struct.unpack_from("<I", content, 12)[0] if binary else len(content)
    document = json.loads(content[20 : 20 + length] if binary else content)
    for _ in range(int(random.integers(1, 4))):
        _change(document, random)
    text = json.dumps(document).encode()
    if random.random() < 0.1:
        text = text.replace(b'"nodes": ', b'"nodes": ' + b"[" * 5000, 1)
    if not binary:
        return text
    text += b" " * (-len(text) % 4)
    rest = content[20 + length :]
    head = struct.pack("<4sIII", b"glTF", 2, 20 + len(text) + len(rest), len(text))
    return head + b"JSON" + text + rest


def _change(value: Any, random: np.random.Generator) -> None:
    """Walk down from a value at random and change what is there."""
    while True:
        keys = list(value) if isinstance(value, dict) else list(range(len(value)))
        if not keys:
            return
        key = keys[int(random.integers(0, len(keys)))]
        below = value[key]
        if isinstance(below, dict | list) and below and random.random() < 0.85:
            value = below
            continue
        match int(random.integers(0, 8)):
            case 0:
                del value[key]
            case 1 if isinstance(value, dict) and "mesh" in value:
                value["children"] = [0] * int(random.choice([1, 2, 1000]))
            case 2 if isinstance(value, list) and len(value) < 10:
                value *= int(random.choice([2, 50, 3000]))
            case _:
                # A copy, for the next change may go into it.
                value[key] = deepcopy(_VALUES[int(random.integers(0, len(_VALUES)))])
        return


def xml_abuse(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Add entities that unfold without end or name files, or elements without end."""
    start = content.find(b"?>") + 2 if content.startswith(b"<?xml") else 0
    head, body = content[:start], content[start:]
    match int(random.integers(0, 4)):
        case 0:
            return head + _LAUGHS + body.replace(b'"', b'"&a29;', 40)
        case 1:
            return (
                head
                + b'<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/hostname">]>'
                + body.replace(b">", b">&e;", 5)
            )
        case 2:
            return head + b"<a>" * 20_000 + body
        case _:
            return head + body.replace(b" ", b" a" * int(random.choice([2, 5000])) + b'="1" ', 1)


def inside_gzip(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Damage the file inside, so that the checksum is right."""
    return gzip.compress(_damaged(gzip.decompress(content), random, other), 1, mtime=0)


def inside_zip(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Damage the model inside, so that the checksum is right."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    change = xml_abuse if random.random() < 0.25 else _damaged
    return three_mf({**parts, MODEL: change(parts[MODEL], random, other)})


def bomb(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Fill it with zeros or blanks that take no room, behind its first bytes or alone."""
    fill = b"\0" if random.random() < 0.5 else b" "
    if content.startswith(b"PK"):
        return _zip_bomb(fill)
    return _gzip_bomb(fill, gzip.decompress(content)[: int(random.choice([0, 40, 400]))])


@functools.cache
def _zip_bomb(fill: bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr(zipfile.ZipInfo(MODEL), fill * _BOMB, zipfile.ZIP_DEFLATED)
    return out.getvalue()


def _gzip_bomb(fill: bytes, head: bytes) -> bytes:
    # Members follow one another without an end between what they hold.
    return gzip.compress(head, mtime=0) + _zeros(fill)


@functools.cache
def _zeros(fill: bytes) -> bytes:
    return gzip.compress(fill * _BOMB, 1, mtime=0)


def lying_zip(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Change a field of the zip's directory: sizes, method, flags, offsets, names."""
    start = content.rfind(b"PK\1\2")
    at = start + int(random.choice([8, 10, 16, 20, 24, 28, 30, 32, 42, 46]))
    word = random.choice([0, 1, 9, 12, 14, 0xFF, 0xFFFF]).astype("<u2").tobytes()
    return content[:at] + word + content[at + 2 :]


def twice_packed(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Pack what is packed."""
    return gzip.compress(content, 1, mtime=0)


def raw_deflate(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Leave out gzip's header, or lie in it."""
    if random.random() < 0.5:
        return zlib.compress(gzip.decompress(content))
    return content[:3] + random.bytes(1) + content[4:]


def _damaged(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    name = list(MUTATIONS)[int(random.integers(0, len(MUTATIONS)))]
    return MUTATIONS[name](content, random, other)


_XML = ("vtp", "vtu", "dae", "x3d", "xml")


def container_mutations(name: str) -> dict[str, Mutation]:
    """Return the damage that a file of this name can take beyond that of its bytes."""
    suffix = name.rsplit(".", 1)[1]
    found: list[Mutation] = []
    if suffix in ("glb", "gltf"):
        found = [json_abuse]
    elif suffix == "3mf":
        found = [inside_zip, bomb, lying_zip]
    elif suffix == "gz":
        found = [inside_gzip, bomb, twice_packed, raw_deflate]
    elif suffix in _XML:
        found = [xml_abuse]
    return {each.__name__: each for each in found}
