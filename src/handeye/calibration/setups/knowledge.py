"""What a fit of mixed measurements has found: numbers, parts of the arm, and what is still open."""

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, Booleans
from handeye.calibration.arm.measurements import (
    Frame,
    Instrument,
    Numbers,
    PixelSightings,
    Points,
    PointSightings,
    PoseSightings,
)
from handeye.calibration.arm.measurements.unknowns import Unknown
from handeye.calibration.engine.knowledge import open_directions
from handeye.calibration.hand_eye.turns import cross_matrix
from handeye.calibration.results import Parameter, PartChange
from handeye.calibration.setups.fit import MixedFit

# Rows that are looked at to say how far a part moves what the flange carries.
_ROWS = 100


def of_arm(fit: MixedFit) -> tuple[Parameter, ...]:
    """Changes of the arm from nominal; terms of curves have no meaning of their own."""
    names, units, curved, _ = fit.of_arm()
    std = np.sqrt(np.diag(fit.covariance))
    return tuple(
        Parameter(name, float(fit.posterior.x[i]), float(std[i]), units[i], 0.0)
        for i, name in enumerate(names) if not curved[i]
    )  # fmt: skip


def beside_arm(fit: MixedFit, stated: Mapping[str, Unknown]) -> dict[str, tuple[Parameter, ...]]:
    """What was found beside the arm, by name.

    Of frames the position in the frame that carries them, and the turn about its axes from where
    they were stated or placed at first; of a frame that is free in some directions only, such as a
    plane, changes along those. Of points and cameras their coordinates and numbers. stated: what
    was known beforehand, by name.
    """
    begun = {u.name: u for one in fit.given for u in one.unknowns}
    out: dict[str, tuple[Parameter, ...]] = {}
    for name, unknown in fit.unknowns.items():
        at = fit.problem.places[name]
        own = fit.covariance[at, at]
        if isinstance(unknown, Frame):
            out[name] = _of_frame(unknown, begun[name], stated.get(name), own)
        else:
            out[name] = _of_values(unknown, stated.get(name), own)
    return out


def parts_of(fit: MixedFit) -> tuple[PartChange, ...]:
    """The parts of the arm, those whose changes move what the flange carries farthest first.

    Over the rows that depend on the part. Parts that the rows cannot tell from each other may move
    it far in opposite ways.
    """
    names, units, _, groups = fit.of_arm()
    n = fit.problem.n_arm
    x, tolerance = fit.posterior.x[:n], fit.problem.tolerance[:n]
    std = np.sqrt(np.diag(fit.covariance))[:n]
    moves = _moves(fit)
    parts: list[PartChange] = []
    for group in groups:
        places = list(group.places)
        most = places[int(np.argmax(np.abs(x[places] / tolerance[places])))]
        moved = [shifts[:, :, places] @ x[places] for own, shifts in moves if own[places].all()]
        known = np.mean(1.0 - np.minimum(std[places] / tolerance[places], 1.0))
        squares: Array = np.sum(np.concatenate(moved) ** 2, axis=1)
        parts.append(
            PartChange(
                group.words, float(np.sqrt(np.mean(squares))), names[most], float(x[most]),
                float(std[most]), units[most], float(known),
            )
        )  # fmt: skip
    return tuple(sorted(parts, key=lambda part: -part.moves))


def undetermined_of(fit: MixedFit) -> tuple[str, ...]:
    """Directions that the measurements leave to what was stated beforehand, in words."""
    names, _, curved, _ = fit.of_arm()
    every = [*names, *(n for block in fit.problem.blocks.values() for n in block.names)]
    plain = [i for i in range(len(every)) if i >= len(curved) or not curved[i]]
    tolerance = fit.problem.tolerance[plain]
    scaled = fit.covariance[np.ix_(plain, plain)] / np.outer(tolerance, tolerance)
    return open_directions([every[i] for i in plain], scaled)


def looks(one: Instrument) -> bool:
    """Whether an instrument looks at its target: a wire, a socket and a table do not."""
    return isinstance(one, PixelSightings | PointSightings | PoseSightings)


def carried(one: Instrument) -> Array:
    """What the flange carries of an instrument, (3,) in its frame: the sensor, or the target."""
    sight = one.sight
    if sight.setup == "eye_in_hand":
        return sight.sensor.reference[:3, 3]
    middle = np.append(sight.points.reference.mean(axis=0), 1.0)
    return (sight.target.reference @ middle)[:3]


def _moves(fit: MixedFit) -> list[tuple[Booleans, Array]]:
    """Of each measurement, which of the arm's n unknowns it depends on, and what these do.

    By how much each moves what the flange carries, (N, 3, n).
    """
    every = max(sum(len(one.joints) for one in fit.measurements) // _ROWS, 1)
    out: list[tuple[Booleans, Array]] = []
    for one in fit.measurements:
        ends, joints = (one.link, one.base), one.joints[::every]
        own = np.zeros(fit.problem.n_arm, np.bool_)
        own[fit.problem.chain(*ends).places] = True
        slopes = fit.problem.slopes(fit.posterior.x, joints, *ends)
        lever = fit.flanges(joints, *ends)[:, :3, :3] @ carried(one)
        out.append((own, slopes[:, :3] - cross_matrix(lever) @ slopes[:, 3:]))
    return out


def _of_frame(
    frame: Frame, begun: Unknown, stated: Unknown | None, covariance: Array
) -> tuple[Parameter, ...]:
    assert isinstance(begun, Frame)
    free = np.flatnonzero(frame.free)
    labels = frame.components
    R, before = frame.reference[:3, :3], begun.reference
    turn = Rotation.from_matrix(R @ before[:3, :3].T).as_rotvec()
    if not frame.free[:3].all():
        shift = before[:3, :3].T @ (frame.reference[:3, 3] - before[:3, 3])
        local = np.concatenate([shift, before[:3, :3].T @ turn])
        std = np.sqrt(np.diag(covariance))
        return tuple(
            Parameter(f"{frame.name} {labels[i][0]}", float(local[i]), float(std[k]), labels[i][1],
                      0.0 if stated else None)
            for k, i in enumerate(free)
        )  # fmt: skip
    whole = np.zeros((6, 6))
    whole[np.ix_(free, free)] = covariance
    ways = np.kron(np.eye(2), R)
    std = np.sqrt(np.diag(ways @ whole @ ways.T))
    values = np.concatenate([frame.reference[:3, 3], turn])
    nominal = [None] * 6
    if isinstance(stated, Frame):
        nominal = [*stated.reference[:3, 3].tolist(), 0.0, 0.0, 0.0]
    kept = range(6) if frame.free[3:].any() else range(3)
    return tuple(
        Parameter(f"{frame.name} {labels[i][0]}", float(values[i]), float(std[i]), labels[i][1],
                  nominal[i])
        for i in kept
    )  # fmt: skip


def _of_values(
    unknown: Unknown, stated: Unknown | None, covariance: Array
) -> tuple[Parameter, ...]:
    values, before = _numbers(unknown), None if stated is None else _numbers(stated)
    std = np.sqrt(np.diag(covariance))
    return tuple(
        Parameter(
            f"{unknown.name} {unknown.components[i][0]}", float(values[i]), float(std[k]),
            unknown.components[i][1], None if before is None else float(before[i]),
        )
        for k, i in enumerate(np.flatnonzero(unknown.free).tolist())
    )  # fmt: skip


def _numbers(unknown: Unknown) -> Array:
    assert isinstance(unknown, Points | Numbers)
    return unknown.reference.reshape(-1)
