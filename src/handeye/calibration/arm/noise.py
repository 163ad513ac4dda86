"""How accurate the sensor is, once the arm's constant errors have been allowed for."""

from dataclasses import replace
from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.description import describe, seen_rows
from handeye.calibration.arm.kernels import n_unknowns
from handeye.calibration.arm.residuals import misfit
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement_problem import LEAST_STD, MEDIAN_LENGTH
from handeye.observations import PointObservation

_SHEET = ArmSheet(curves=CurveTerms(0, 0), compliance=0.0)
_MOST_ROWS = 400
_ROUNDS = 10
_LEAST_SQUARE, _LEAST_SHARE = 1e-12, 0.1


def with_noise(model: PlacedArm, seen: PointObservation) -> PlacedArm:
    """The model of an arm from a URDF file with the noise that a log of sightings shows.

    The model's own `turn_std` and `noise` count the arm's errors as noise. Here all constants of
    the arm (ArmSheet) are fitted first, by Gauss and Newton, with weights `1 / (1 + r^2)` (Cauchy)
    for r a row's residual over the median. What is left is noise, and error curves. Of p unknowns
    that the rows determine, N rows of k numbers leave (k N - p) / k N of the variance.
    """
    if model.turn_std is None and seen.position_std is not None:
        return model
    some = seen[:: -(-len(seen) // _MOST_ROWS)]
    noise = model.noise if model.noise > 0.0 else _size(model.needed(some))
    sizes = [noise] if model.turn_std is None else [noise, model.turn_std]
    found = _left(model, some, np.maximum(sizes, LEAST_STD))
    return replace(
        model,
        noise=0.0 if seen.position_std is not None else float(min(found[0], noise)),
        turn_std=None if model.turn_std is None else float(min(found[1], model.turn_std)),
    )


def _left(model: PlacedArm, seen: PointObservation, sizes: Array) -> Array:
    """Standard deviations of what remains of positions, and of orientations, from `sizes` on."""
    arm: Any = model.arm
    kernel = describe(
        arm, model.placement, _SHEET.curves.table(arm.stages().slides),
        turn_std=model.turn_std, compliant=False,
    )  # fmt: skip
    tolerance = _SHEET.tolerances(kernel)
    N, k, n = len(seen), 3 * len(sizes), n_unknowns(kernel)
    rows = seen_rows(kernel, arm, seen)
    values, slopes = np.empty((N, k)), np.empty((N, k, n))
    x: Array = np.zeros(n)
    weights: Array = np.ones(N)
    for _ in range(_ROUNDS):
        for i, row in enumerate(rows):
            misfit(kernel, tolerance * x, row, values[i], slopes[i])
        std = np.repeat(sizes, 3)
        J: Array = -slopes / std[:, np.newaxis] * tolerance
        weighted = J * (weights / weights.mean())[:, np.newaxis, np.newaxis]
        information: Array = np.eye(n) + np.einsum("ikn,ikm->nm", weighted, J)
        r: Array = values / std + J @ x
        x[:] = np.linalg.solve(information, np.einsum("ikn,ik->n", weighted, r))
        left: Array = r - J @ x
        squares = np.sum(left**2, axis=1)
        weights = 1.0 / (1.0 + squares / max(float(np.median(squares)), _LEAST_SQUARE))
        determined = n - float(np.trace(np.linalg.inv(information)))
        share = max(1.0 - determined / (k * N), _LEAST_SHARE)
        scales = [_size(left[:, i : i + 3]) / np.sqrt(share) for i in range(0, k, 3)]
        sizes = np.maximum(sizes * scales, LEAST_STD)
    return sizes


def _size(vectors: Array) -> float:
    """Standard deviation of the components of N vectors (N, 3), whatever some of them are."""
    return float(np.median(np.linalg.norm(vectors, axis=1))) / MEDIAN_LENGTH
