"""The compiled loops of the Kuperstein-type map."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array


class Maps(NamedTuple):
    """Three maps of units x units Gaussian units over the coordinates of a unit vector.

    units      along either side, evenly spaced from -1 to 1
    sharpness  `1 / (2 s^2)` for a width s
    half       half the distance between the cameras [m]
    """

    units: int
    sharpness: float
    half: float


@compiled
def excite_camera(maps: Maps, direction: float, activity: Array) -> None:
    """Activities (units^2,), overwritten, of a camera's map while it points in a direction."""
    n = maps.units
    across, along = np.empty(n), np.empty(n)
    for i in range(n):
        centre = -1.0 + 2.0 * i / (n - 1)
        across[i] = np.exp(-maps.sharpness * (np.cos(direction) - centre) ** 2)
        along[i] = np.exp(-maps.sharpness * (np.sin(direction) - centre) ** 2)
    for i in range(n):
        for j in range(n):
            activity[i * n + j] = across[i] * along[j]


@compiled
def excite(maps: Maps, direction: float, distance: float, activity: Array) -> None:
    """Activities (3 units^2,), overwritten, of left, right and disparity map.

    Both cameras point at a target in a direction at a distance from the middle between them. A unit
    of the disparity map is as active as its units in the two other maps differ.
    """
    size = maps.units * maps.units
    turn = np.arctan2(maps.half, max(distance, 0.0))
    left, right = activity[:size], activity[size : 2 * size]
    excite_camera(maps, direction - turn, left)
    excite_camera(maps, direction + turn, right)
    for i in range(size):
        activity[2 * size + i] = abs(left[i] - right[i])


@compiled
def activate(weights: Array, activity: Array, muscles: Array) -> None:
    """Muscle activations (4,), overwritten: weighted sums of all units, weights (4, n)."""
    for k in range(muscles.size):
        total = 0.0
        for i in range(activity.size):
            total += weights[k, i] * activity[i]
        muscles[k] = total


@compiled
def activate_stream(maps: Maps, weights: Array, sights: Array, muscles: Array) -> None:
    """Activations (N, 4), overwritten, for sights (N, 3): direction, distance, elbow."""
    activity = np.empty(weights.shape[2])
    for n in range(len(sights)):
        excite(maps, sights[n, 0], sights[n, 1], activity)
        activate(weights[1 if sights[n, 2] > 0.0 else 0], activity, muscles[n])


@compiled
def learn_stream(
    maps: Maps, rate: float, weights: Array, sights: Array, wanted: Array, generated: Array
) -> None:
    """Learn sights (N, 3) of arms with activations wanted (N, 4), one after the other.

    `delta w_ki = rate e_k a_i / |a|^2`, e the activation wanted less the one generated before,
    which overwrites generated (N, 4).
    """
    activity = np.empty(weights.shape[2])
    for n in range(len(sights)):
        excite(maps, sights[n, 0], sights[n, 1], activity)
        mine = weights[1 if sights[n, 2] > 0.0 else 0]
        activate(mine, activity, generated[n])
        squared = 0.0
        for i in range(activity.size):
            squared += activity[i] * activity[i]
        for k in range(len(mine)):
            step = rate * (wanted[n, k] - generated[n, k]) / squared
            for i in range(activity.size):
                mine[k, i] += step * activity[i]
