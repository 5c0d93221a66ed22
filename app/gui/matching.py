"""Which names a few typed letters may mean. Knows no Qt."""

from collections.abc import Sequence


def ranked(typed: str, names: Sequence[str]) -> list[int]:
    """Return the names that have all typed letters in their order, the best first.

    Parameters
    ----------
    typed : str
        What a person typed; case and blanks do not matter.
    names : sequence of str
        What may be meant.

    Returns
    -------
    list of int
        Indices: names in which the letters stand closer together and begin words come first; in
        their own order where nothing is typed.
    """
    letters = typed.lower().replace(" ", "")
    if not letters:  # the shortest is nobody's wish
        return list(range(len(names)))
    scores = [(_score(letters, name.lower()), index) for index, name in enumerate(names)]
    return [index for score, index in sorted(scores) if score >= 0.0]


def _score(letters: str, name: str) -> float:
    """Return how badly letters fit a name; below 0 if they do not."""
    at, score = -1, 0.0
    for letter in letters:
        found = name.find(letter, at + 1)
        if found < 0:
            return -1.0
        begins = found == 0 or not name[found - 1].isalnum()
        # What begins a word is as good as what follows at once.
        score += 0.0 if begins or found == at + 1 else 1.0 + 0.01 * (found - at)
        at = found
    return score + 0.001 * len(name)
