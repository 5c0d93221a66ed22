"""Random numbers that depend on a seed and a photon alone, not on who draws them when."""

import numpy as np

from lutcore.compiled import compiled

_STEP = np.uint64(0x9E3779B97F4A7C15)
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_S30, _S27, _S31, _S11 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)
_UNIT = 2.0**-53


@compiled()
def _mixed(z: np.uint64) -> np.uint64:
    z = (z ^ (z >> _S30)) * _FIRST
    z = (z ^ (z >> _S27)) * _SECOND
    return z ^ (z >> _S31)


@compiled()
def stream(seed: int, photon: int) -> np.uint64:
    """Return the state from which a photon draws its numbers.

    Parameters
    ----------
    seed : int
        Of the whole run.
    photon : int
        Which photon.

    Returns
    -------
    uint64
        State of a generator of its own: SplitMix64 (Steele, Lea and Flood, "Fast Splittable
        Pseudorandom Number Generators", OOPSLA 2014), a counter whose values are hashed.
    """
    return _mixed(_mixed(np.uint64(seed) + _STEP) + np.uint64(photon) * _SECOND)


@compiled()
def draw(state: np.uint64) -> tuple[np.uint64, float]:
    """Return the next state and a number drawn evenly from 0 to 1, both excluded.

    Parameters
    ----------
    state : uint64
        What `stream` or the last draw returned.

    Returns
    -------
    tuple of uint64 and float
        The next state, and the number.
    """
    state = state + _STEP
    return state, (np.float64(_mixed(state) >> _S11) + 0.5) * _UNIT
