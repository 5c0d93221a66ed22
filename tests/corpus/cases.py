"""Corrupted files over all formats, the same ones for the same seed."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tests.corpus.containers import container_mutations
from tests.corpus.mutations import MUTATIONS
from tests.mesh_files import one_of_each
from tests.more_files import in_child, in_process

# Starting a child takes most of the time that its formats cost.
_TURNS_IN_PROCESS = 3
# Rarer than other damage: it unfolds to 200 MB each time.
_BOMB_SHARE = 0.05
_CONTAINER_SHARE = 0.4
_WRONG_ENDING_SHARE = 0.06


@dataclass(frozen=True)
class Case:
    """One corrupted file.

    Parameters
    ----------
    name : str
        Its file name: number, what befell it, the valid file that it was.
    content : bytes
        It.
    seed_file : str
        Name of the valid file.
    damage : str
        What befell it.
    """

    name: str
    content: bytes
    seed_file: str
    damage: str


def seed_files(children: bool = True) -> dict[str, bytes]:
    """Return valid files of every format; without those read in child processes if so asked."""
    first = one_of_each()
    if not children:
        first.pop("plain.vtp")
        return {**first, **in_process()}
    return {**first, **in_process(), **in_child()}


def corpus(
    count: int, seed: int, files: dict[str, bytes] | None = None, bombs: bool = True
) -> Iterator[Case]:
    """Yield corrupted files.

    Parameters
    ----------
    count : int
        How many.
    seed : int
        Of the random numbers.
    files : dict of str to bytes, or None
        The valid files; all of `seed_files` if None.
    bombs : bool
        Whether some unfold to 200 MB.
    """
    random = np.random.default_rng(seed)
    files = seed_files() if files is None else files
    quick = seed_files(children=False)
    turns = [name for name in files for _ in range(_TURNS_IN_PROCESS if name in quick else 1)]
    seen = {(name.split(".", 1)[1], content) for name, content in files.items()}
    made = 0
    while made < count:
        # All formats in turn, each turn in another order.
        for turn in random.permutation(len(turns)):
            name = turns[turn]
            other = list(files)[int(random.integers(0, len(files)))]
            damage, content = _damaged(name, files[name], files[other], random, bombs)
            ending = name.split(".", 1)[1]
            if random.random() < _WRONG_ENDING_SHARE:
                damage, ending = f"{damage}+ending", other.split(".", 1)[1]
            if (ending, content) in seen:
                continue
            seen.add((ending, content))
            stem = name.split(".", 1)[0]
            yield Case(f"{made:05}-{damage}-{stem}.{ending}", content, name, damage)
            made += 1
            if made == count:
                return


def _damaged(
    name: str, content: bytes, other: bytes, random: np.random.Generator, bombs: bool
) -> tuple[str, bytes]:
    special = container_mutations(name)
    if "bomb" in special:
        bomb = special.pop("bomb")
        if bombs and random.random() < _BOMB_SHARE:
            return "bomb", bomb(content, random, other)
    pool = MUTATIONS
    if special and random.random() < _CONTAINER_SHARE:
        pool = special
    damage = list(pool)[int(random.integers(0, len(pool)))]
    damaged = pool[damage](content, random, other)
    if random.random() < 0.2:
        second = list(MUTATIONS)[int(random.integers(0, len(MUTATIONS)))]
        if damaged:
            damaged = MUTATIONS[second](damaged, random, other)
            damage = f"{damage}+{second}"
    return damage, damaged
