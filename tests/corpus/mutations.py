"""What can befall any file: each of these damages its bytes in one way.

All take the file, a random generator and another file, and return the damaged file.
"""

import re
import struct
from collections.abc import Callable, Iterator

import numpy as np

Mutation = Callable[[bytes, np.random.Generator, bytes], bytes]

_NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")
_WHOLE = re.compile(rb"(?<![\w.])\d+(?![\w.])")
_HUGE = (b"4294967295", b"99999999999999999999", b"-1", b"2147483648", b"0", b"1000000", b"-0")
_BEYOND = (b"24", b"25", b"26", b"-1", b"-26", b"1000", b"2147483647", b"1.5")
_ODD = (
    b"nan",
    b"inf",
    b"-inf",
    b"1e400",
    b"1e30",
    b"-1e-400",
    b"0x1p3",
    b"1_0",
    b"1,5",
    b"1e",
    b"",
)
_WORDS = (0, 1, 25, 26, 255, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7FC00000, 0x7F800000, 0x7149F2CA)
_INSERTED = (
    b"\0",
    b"\xff",
    b"\x1a",
    b"\n\n",
    b"\xc3\xa9",
    b'"',
    b"<",
    b"{",
    b"#",
    b"\\\n",
    b"9" * 400,
)


def truncated(content: bytes, count: int = 12) -> Iterator[bytes]:
    """Yield the file cut at `count` places, spread from its first bytes to its last."""
    for cut in np.unique(np.linspace(1, len(content) - 1, count).astype(int)):
        yield content[:cut]


def cut(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Cut the file short."""
    return content[: random.integers(1, max(2, len(content)))]


def bits(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Turn 1 to 16 bits, as often as not within the first 512 bytes."""
    data = np.frombuffer(content, np.uint8).copy()
    reach = min(512, len(data)) if random.random() < 0.5 else len(data)
    places = random.integers(0, reach, random.integers(1, 17))
    data[places] ^= np.uint8(1) << random.integers(0, 8, len(places)).astype(np.uint8)
    return data.tobytes()


def noise(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Write random bytes, or zeros, over a stretch."""
    start, end = _stretch(content, random)
    fill = random.bytes(end - start) if random.random() < 0.6 else b"\0" * (end - start)
    return content[:start] + fill + content[end:]


def deleted(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Take a stretch out."""
    start, end = _stretch(content, random)
    return content[:start] + content[end:]


def repeated(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Write a stretch several times."""
    start, end = _stretch(content, random)
    return content[:end] + content[start:end] * int(random.integers(1, 40)) + content[end:]


def inserted(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Put bytes in that often mean something."""
    at = int(random.integers(0, len(content) + 1))
    return content[:at] + _one(random, _INSERTED) + content[at:]


def spliced(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Join the beginning of the file and the end of another."""
    return content[: random.integers(1, len(content))] + other[random.integers(0, len(other)) :]


def count(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Make a whole number near the beginning huge, negative or nothing; or four bytes of it."""
    return _replaced(content, random, _WHOLE, _HUGE, 2048)


def index(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Make a whole number one that no vertex has, in the later part of the file."""
    half = len(content) // 2
    return content[:half] + _replaced(content[half:], random, _WHOLE, _BEYOND, len(content))


def number(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Make some numbers NaN, infinite, or written in no known way."""
    for _ in range(int(random.integers(1, 6))):
        content = _replaced(content, random, _NUMBER, _ODD, len(content))
    return content


def swapped(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Turn the byte order of the words of a stretch, or what the header says of it."""
    said = {
        b"binary_little_endian": b"binary_big_endian",
        b"binary_big_endian": b"binary_little_endian",
        b"LittleEndian": b"BigEndian",
    }
    for word, twin in said.items():
        if word in content and random.random() < 0.5:
            return content.replace(word, twin)
    start, end = _stretch(content, random)
    size = int(random.choice([2, 4, 8]))
    end = start + (end - start) // size * size
    words = np.frombuffer(content[start:end], np.uint8).reshape(-1, size)[:, ::-1]
    return content[:start] + words.tobytes() + content[end:]


def encoded(content: bytes, random: np.random.Generator, other: bytes) -> bytes:
    """Write it as text of another encoding, or with other line ends."""
    text = content.decode("latin-1")
    match int(random.integers(0, 6)):
        case 0:
            return text.encode("utf-16")
        case 1:
            return text.encode("utf-32-be")
        case 2:
            return b"\xef\xbb\xbf\xef\xbb\xbf" + content
        case 3:
            return ("\xe9\xfc\xdf" + text).encode("utf-8")
        case 4:
            # As a transfer in text mode leaves binary files.
            return content.replace(b"\n", b"\r\n")
        case _:
            return content.replace(b" ", b"\xc2\xa0")


def _one(random: np.random.Generator, choices: tuple[bytes, ...]) -> bytes:
    return choices[int(random.integers(0, len(choices)))]


def _stretch(content: bytes, random: np.random.Generator) -> tuple[int, int]:
    """Return the ends of a piece, more often short than long."""
    start = int(random.integers(0, len(content)))
    most = len(content) - start
    return start, start + int(min(most, 1 + random.exponential(0.1) * most))


def _replaced(
    content: bytes,
    random: np.random.Generator,
    pattern: re.Pattern[bytes],
    values: tuple[bytes, ...],
    reach: int,
) -> bytes:
    """Replace one match, or, where text is rare, a word of four bytes."""
    places = [match.span() for match in pattern.finditer(content[:reach])]
    if b"\0" in content and (not places or random.random() < 0.7):
        if len(content) < 4:
            return content
        at = int(random.integers(0, min(reach, len(content) - 3)))
        order = "<" if random.random() < 0.7 else ">"
        word = struct.pack(f"{order}I", _WORDS[int(random.integers(0, len(_WORDS)))])
        return content[:at] + word + content[at + 4 :]
    if not places:
        return content
    start, end = places[int(random.integers(0, len(places)))]
    return content[:start] + _one(random, values) + content[end:]


MUTATIONS: dict[str, Mutation] = {
    each.__name__: each
    for each in (
        cut,
        bits,
        noise,
        deleted,
        repeated,
        inserted,
        spliced,
        count,
        index,
        number,
        swapped,
        encoded,
    )
}
