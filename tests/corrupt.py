"""Damaged versions of a file, the same ones every time."""

import re
from collections.abc import Iterator

import numpy as np


def truncated(content: bytes, count: int = 12) -> Iterator[bytes]:
    """Yield the file cut at `count` places, spread from its first bytes to its last."""
    for cut in np.unique(np.linspace(1, len(content) - 1, count).astype(int)):
        yield content[:cut]


def flipped(content: bytes, count: int = 30, seed: int = 0) -> Iterator[bytes]:
    """Yield the file with 1 to 16 random bits turned, half of them within its first 512 bytes."""
    random = np.random.default_rng(seed)
    for turn in range(count):
        data = np.frombuffer(content, np.uint8).copy()
        reach = min(512, len(data)) if turn % 2 else len(data)
        places = random.integers(0, reach, random.integers(1, 17))
        data[places] ^= np.uint8(1) << random.integers(0, 8, len(places)).astype(np.uint8)
        yield data.tobytes()


def inflated(content: bytes, count: int = 10, seed: int = 0) -> Iterator[bytes]:
    """Yield the file with one of its decimal numbers made huge or negative."""
    numbers = list(re.finditer(rb"(?<![\w.])\d+(?![\w.])", content[:4096]))
    random = np.random.default_rng(seed)
    for match in random.permutation(np.arange(len(numbers)))[:count]:
        start, end = numbers[match].span()
        huge = random.choice([b"4294967295", b"99999999999999999999", b"-1", b"2147483648"])
        yield content[:start] + bytes(huge) + content[end:]


def damaged(content: bytes, flips: int = 30) -> Iterator[bytes]:
    """Yield every kind of damage."""
    yield from truncated(content)
    yield from flipped(content, flips)
    yield from inflated(content)
