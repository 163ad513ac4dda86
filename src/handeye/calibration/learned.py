"""What a calibrator has learned, as numbers with units and standard deviations."""

from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm import ArmEstimator
from handeye.calibration.combined import Combined
from handeye.calibration.engine.design import hand_slopes
from handeye.calibration.estimation import NAMES, ParameterEstimator
from handeye.calibration.estimation.parameters import vector
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.results import Parameter, PartChange
from handeye.calibration.session import AnyCalibrator
from handeye.observations import Observation, PointObservation

_UNITS = ("m", "m", "m", "m", "rad", "rad", "rad", "")
_FRAME = ("x", "y", "z")
# Median length of a normally distributed 3-vector whose components have standard deviation 1.
_MEDIAN_LENGTH = 1.538
# A direction told this much worse than the best one is not told at all.
_OPEN = 1e-6
# Rows that are looked at to say how far a part moves the hand.
_ROWS = 100


def parameters_of(calibrator: AnyCalibrator, seen: Observation) -> tuple[Parameter, ...]:
    """Every parameter that has a meaning of its own; terms of curves and networks have none.

    Of a network on an arm in space, and of the nominal arm, these are the frames, in the axes of
    the sensor and of the flange: their standard deviations hold as far as the errors of rows `seen`
    are independent of each other.
    """
    if isinstance(calibrator, Combined):
        chain, known = calibrator.engine.chain, calibrator.knowledge()
        return tuple(
            Parameter(name, float(chain.nominal[i] + known.values[i]), float(known.std[i]),
                      chain.units[i], float(chain.nominal[i]))
            for i, name in enumerate(chain.names) if not chain.curved[i]
        )  # fmt: skip
    if isinstance(calibrator, ParameterEstimator):
        known, nominal = calibrator.knowledge(), vector(calibrator.model.nominal)
        stds = [None] * len(NAMES) if known is None else known.std.tolist()
        rows = zip(NAMES, calibrator.parameters.tolist(), stds, _UNITS, nominal, strict=True)
        return tuple(Parameter(n, v, s, unit, float(before)) for n, v, s, unit, before in rows)
    if isinstance(calibrator, ArmEstimator):
        x, std, chain = calibrator.x, calibrator.std(), calibrator.robot.chain
        return tuple(
            Parameter(name, float(x[i]), float(std[i]), chain.units[i], 0.0)
            for i, name in enumerate(chain.names) if not chain.curved[i]
        )  # fmt: skip
    model: Any = getattr(calibrator, "model", None)
    if isinstance(model, PlacedArm) and isinstance(seen, PointObservation):
        return _frames(model, seen)
    return ()


def parts_of(calibrator: AnyCalibrator, seen: Observation) -> tuple[PartChange, ...]:
    """The parts of the robot, those whose changes move the hand farthest first.

    For who knows parts. Parts that the rows cannot tell from each other, such as the base and the
    first joint, may move the hand far in opposite ways.
    """
    if not isinstance(calibrator, Combined):
        return ()
    engine, known = calibrator.engine, calibrator.knowledge()
    shifts = _shifts(calibrator, seen)
    parts = [
        PartChange(
            part.words,
            _length(shifts[:, :, list(group.places)].sum(axis=2)),
            part.unknown, part.change, part.std, part.unit, part.known,
        )
        for group, part in zip(engine.chain.groups, known.parts, strict=True)
    ]  # fmt: skip
    return tuple(sorted(parts, key=lambda part: -part.moves))


def undetermined_of(calibrator: AnyCalibrator) -> tuple[str, ...]:
    """Directions that the observations leave open, in words."""
    if isinstance(calibrator, Combined | ParameterEstimator):
        known = calibrator.knowledge()
        return () if known is None else tuple(known.undetermined)
    return ()


def _length(vectors: Array) -> float:
    """Root mean square length of vectors (N, m)."""
    return float(np.sqrt(np.sum(vectors**2) / len(vectors)))


def _shifts(calibrator: Combined, seen: Observation) -> Array:
    """By how much each unknown moves the hand (N, m, n) [m], at up to so many of the rows."""
    engine, chain = calibrator.engine, calibrator.engine.chain
    every = max(len(seen) // _ROWS, 1)
    some: Any = seen
    rows = calibrator.robot.seen_rows(some[::every])
    k, m, n = chain.n_values, chain.n_hand, len(chain.names)
    out, by, to_metres = np.empty((len(rows), m, n)), np.empty((k, n)), np.empty((m, k))
    for row, hand in zip(rows, out, strict=True):
        hand_slopes(chain.kernel, engine.x, np.ones(n), row, engine.doubt, by, hand, to_metres)
    return out * engine.x


def _frames(model: PlacedArm, seen: PointObservation) -> tuple[Parameter, ...]:
    base, marker = model.placement.T_sensor_base, model.placement.T_flange_marker
    std = _placement_std(model, seen)
    names = [f"base {axis}" for axis in _FRAME] + [f"marker {axis}" for axis in _FRAME]
    values = [*base[:3, 3], *marker[:3, 3]]
    return tuple(
        Parameter(name, float(value), std[i], "m")
        for i, (name, value) in enumerate(zip(names, values, strict=True))
    )


def _placement_std(model: PlacedArm, seen: PointObservation) -> list[float | None]:
    """Standard deviations of base and marker positions; None where rows leave one open.

    From s^2 (J^T J)^-1 over turn and place of the base and place of the marker, with s the robust
    size of the residuals.
    """
    R = model.placement.T_sensor_base[:3, :3]
    poses = model.arm.poses(seen.joints)
    path = (poses @ model.placement.T_flange_marker[:, 3])[:, :3] @ R.T
    J = np.zeros((len(path), 3, 9))
    for axis in range(3):
        J[:, :, axis] = np.cross(np.eye(3)[axis], path) / model.arm.reach
    J[:, :, 3:6] = np.eye(3)
    J[:, :, 6:] = R @ poses[:, :3, :3]
    sizes, directions = np.linalg.svd(J.reshape(-1, 9), full_matrices=False)[1:]
    told = sizes > _OPEN * sizes[0]
    lengths = np.linalg.norm(model.needed(seen), axis=1)
    spread: Array = float(np.median(lengths)) / _MEDIAN_LENGTH * directions[told].T / sizes[told]
    std = np.sqrt(np.sum(spread**2, axis=1))
    open_parts = np.any(np.abs(directions[~told]) > 1e-3, axis=0)
    return [None if open_parts[i] else float(std[i]) for i in range(3, 9)]
