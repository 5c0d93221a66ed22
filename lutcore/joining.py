"""Union-find over rows of links."""

import numpy as np

from lutcore.arrays import AnyArray, IndexArray
from lutcore.compiled import compiled


@compiled()
def joined(links: AnyArray, count: int) -> tuple[int, IndexArray]:
    """Find what hangs together; see `lutcore.topology.components`."""
    # Union-find: the first of a group stands for it, and ways to it are halved as they are walked.
    above = np.arange(count, dtype=np.int32)
    for row in range(len(links)):
        one = links[row, 0]
        while above[one] != one:
            above[one] = above[above[one]]
            one = above[one]
        for column in range(1, links.shape[1]):
            other = links[row, column]
            while above[other] != other:
                above[other] = above[above[other]]
                other = above[other]
            if other < one:
                above[one] = other
                one = other
            else:
                above[other] = one
    groups = 0
    for thing in range(count):
        if above[thing] == thing:
            above[thing] = groups
            groups += 1
        else:  # what stands above comes first, and has its number already
            above[thing] = above[above[thing]]
    return groups, above
