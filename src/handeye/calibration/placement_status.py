"""What a log leaves open about base and marker, in words, and what to do about it."""

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array

# Not determined: the residuals leave more play than this share of the motion, or the singular value
# is rounding.
_PLAY = 0.1
_ROUNDING = 1e-7
# Parts of a direction smaller than this go unmentioned.
_MENTIONED = 0.2
# A turn of the flange that counts as one [rad], and a motion that does [m].
_TURN = 0.02
_MOVED = 0.02
_LARGE_RESIDUAL = 0.2
# Twice as many numbers as unknowns.
_ROWS_TO_CHECK = 6
_LARGE_DISAGREEMENT = 0.1


def undetermined(jacobian: Array, std: float, motion: float) -> tuple[float, tuple[str, ...]]:
    """The condition of a fit and the directions that it leaves open, in words.

    jacobian (M, 6 or 9) [m/m]: columns of the base's turn (times `motion`, about the middle of the
    rows), its position, and the marker's position if that is free. std [m] of one row.
    """
    n = jacobian.shape[1]
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=len(jacobian) < n)
    sizes = np.concatenate([sizes, np.zeros(n - len(sizes))])
    rounding = sizes <= _ROUNDING * sizes[0]
    loose = rounding | (std > _PLAY * motion * sizes)
    condition = float("inf") if rounding.any() else float(sizes[0] / sizes[-1])
    return condition, tuple(dict.fromkeys(_words(direction) for direction in directions[loose]))


def _words(direction: Array) -> str:
    """What changes along one direction (6 or 9,) without any row noticing."""
    turn, base, marker = direction[:3], direction[3:6], direction[6:]
    parts: list[str] = []
    for name, part in (
        ("the orientation of the base", turn),
        ("the position of the base", base),
        ("the position of the marker", marker),
    ):
        if np.linalg.norm(part) > _MENTIONED:
            parts.append(name)
    return " together with ".join(parts)


def status(
    poses: Array,
    open_directions: tuple[str, ...],
    condition: float,
    *,
    median: float,
    motion: float,
    disagreement: float | None,
) -> str:
    """The outcome of a fit and what to do next.

    median [m] residual, motion [m] of the marker, median disagreement [rad] of orientations.
    """
    lines: list[str] = []
    if open_directions:
        lines.append(f"not determined by these {len(poses)} rows: {'; '.join(open_directions)}")
        lines.append(f"it stays where the closed form puts it; {_advice(poses)}")
    if median > _LARGE_RESIDUAL * motion and _extent(poses) > _MOVED:
        lines.append(
            f"the arm does not explain the log: half of the residuals exceed {median * 1e3:.3g} mm "
            f"in a motion of {motion * 1e3:.3g} mm; check the robot, its tip, and the order, signs "
            "and units of the joints"
        )
    if not lines and len(poses) < _ROWS_TO_CHECK:
        lines.append(
            f"base and marker are determined (condition {condition:.3g}), but {len(poses)} rows "
            "leave next to nothing to check them with: add some dozens"
        )
    if disagreement is not None and disagreement > _LARGE_DISAGREEMENT:
        lines.append(
            f"measured orientations disagree with the arm by {np.degrees(disagreement):.3g} deg; "
            "check that quaternions have w first and give the marker in the sensor's frame"
        )
    return "\n".join(lines) or f"base and marker are determined (condition {condition:.3g})"


def _extent(poses: Array) -> float:
    return float(np.max(np.ptp(poses[:, :3, 3], axis=0)))


def _advice(poses: Array) -> str:
    turns = Rotation.from_matrix(poses[0, :3, :3].T @ poses[:, :3, :3]).as_rotvec()
    sizes = np.linalg.svd(turns, compute_uv=False) / np.sqrt(len(turns))
    axes = int(np.sum(sizes > _TURN))
    if len(poses) < 4:
        return "add rows: four is the least, some dozens are good"
    if axes == 0:
        still = "neither turns nor moves" if _extent(poses) < _MOVED else "does not turn"
        return f"the flange {still}: add rows with other joint angles, all joints moving"
    if axes == 1:
        return (
            "the flange turns about one axis only: add poses that turn it about another axis by "
            "30 degrees or more, or fix the marker at the flange's origin if it sits there"
        )
    return "add rows that spread wider over the workspace and turn the flange more"
