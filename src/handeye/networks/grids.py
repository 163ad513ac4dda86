"""Where to place neurons on a grid instead of where the inputs fall (section 3.5.2)."""

import numpy as np

from handeye.arrays import Array, count
from handeye.networks.inputs import InputSpace


def fixed_grid(space: InputSpace, points_per_axis: int) -> Array:
    """Equally spaced points: the box is cut into cells, one point in the middle of each.

    Returns (points_per_axis^d, d) in input units; the last input varies fastest.
    """
    n = count(points_per_axis, "points_per_axis")
    steps = (np.arange(n) + 0.5) / n
    axes = [low + steps * (high - low) for low, high in zip(space.low, space.high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, space.n_inputs)


def variable_grid(space: InputSpace, levels: int) -> Array:
    """Successively finer subgrids, each with twice the points per axis of the one before.

    Subgrid i has 2^i points per axis, i = 0 .. levels - 1; coarse ones come first, so that a
    network given the points in order learns the large scale before the fine one.
    Returns (sum_i 2^(i d), d).
    """
    return np.vstack([fixed_grid(space, 2**level) for level in range(count(levels, "levels"))])
