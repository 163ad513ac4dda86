"""How much later a sensor's stamps are than the joints', from the measurements themselves.

The position of what is seen is a function of the joint angles, p = F(q). With the stamps of the
sensor late by d, p_i = F(q(t_i - d)) + e_i. F is linear in features phi(q) (`features`), so that
for every d the best F is a linear least-squares problem, and d is what makes the rest smallest:

    minimise over d   min over B   sum_i w_i |p_i - B phi(q(t_i - d))|^2
"""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.io.bags.features import KINEMATIC, Features, Kinematics, harmonic, kinematic
from handeye.io.bags.matching import JointMotion
from handeye.io.bags.profile import HALF, Profile

_RANGES = (0.5, 0.2, 0.08)  # [s] either way
_STEP = 0.02  # [s], shorter than the arm changes its speed
_COARSE_ROWS, _FINE_ROWS = 400, 4000
_ROWS_PER_FEATURE = 4
_AROUND = 0.05  # [s] before and after a measurement
_STILL = 2e-3  # [rad] or [m] in that time
_TOO_VAGUE = 0.02  # [s], a standard deviation that decides nothing
_SIGNIFICANT = 2.0
_CLEAR = 0.7  # of the median over all delays


@dataclass(frozen=True)
class Delay:
    """How much later the sensor's stamps are than those of the joints.

    seconds   what was used [s]
    estimate  what the measurements say, and its standard deviation `std` [s]; None where they
              say nothing
    status    in words
    """

    seconds: float
    estimate: float | None
    std: float | None
    status: str


class _Unknown(Exception):
    """Why the measurements do not say."""


def stated(seconds: float) -> Delay:
    """A delay that the user knows [s]."""
    return Delay(seconds, None, None, f"{1e3 * seconds:.4g} ms, as stated")


def estimate_delay(
    moments: Array, positions: Array, motion: JointMotion, arm: Kinematics | None
) -> Delay:
    """The delay of N positions (N, 3) [m] stamped `moments` (N,) [s].

    All delays up to half a second either way are tried (less where the record is short), then the
    best is refined. A delay below two standard deviations is not used, and neither is one that the
    motion does not decide to 20 ms. Without `arm`, its kinematics are approximated from the data.
    """
    try:
        found, std = _estimated(moments, positions, motion, arm)
    except _Unknown as why:
        return Delay(0.0, None, None, f"cannot be told: {why}; 0 is used")
    said = f"{1e3 * found:.3g} ± {1e3 * std:.2g} ms"
    if abs(found) < _SIGNIFICANT * std:
        return Delay(0.0, found, std, f"{said}, which may be none: 0 is used")
    return Delay(found, found, std, said)


def _estimated(
    moments: Array, positions: Array, motion: JointMotion, arm: Kinematics | None
) -> tuple[float, float]:
    if motion.one_by_one:
        raise _Unknown("the joints were recorded pose by pose, not while they moved")
    if _still(moments, motion):
        raise _Unknown("the arm stood still at every measurement, where it does not matter")
    features, width = _features(arm, motion, len(moments))
    least = _ROWS_PER_FEATURE * width
    for largest in _RANGES:
        reach = largest + HALF
        rows = motion.covers(moments - reach, moments + reach)
        if np.sum(rows) >= least:
            break
    else:
        raise _Unknown(f"fewer than {least} measurements have joint states before and after")
    whole = Profile(moments[rows], positions[rows], motion, features)
    grid = np.arange(-largest, largest + _STEP / 2, _STEP)
    coarse = whole.thinned(_COARSE_ROWS)
    left = np.array([coarse.spread(delay) for delay in grid])
    best = int(np.argmin(left))
    advice = "" if arm else ", without the kinematics (--robot; in Python: arm=)"
    if best in {0, len(grid) - 1} and left[best] < _CLEAR * np.median(left):
        raise _Unknown(
            f"it seems to be more than {largest:g} s, so that the clocks of sensor and joints may "
            "not be synchronised; state it with --delay (in Python: delay=)"
        )
    found, std = whole.thinned(_FINE_ROWS).refined(float(grid[best]), largest)
    if not np.isfinite(std):
        raise _Unknown(f"the motion does not decide it{advice}")
    if std > _TOO_VAGUE:
        raise _Unknown(f"the motion decides it only to {1e3 * std:.2g} ms{advice}")
    return found, std


def _features(arm: Kinematics | None, motion: JointMotion, rows: int) -> tuple[Features, int]:
    """phi, and how many numbers it has."""
    if arm is not None:
        return kinematic(arm), KINEMATIC
    moving = np.flatnonzero(motion.travel > _STILL)
    n = len(moving)
    alone, pairs = 1 + 2 * n, 1 + 2 * n + 2 * n * (n - 1)
    products = rows >= _ROWS_PER_FEATURE * pairs
    return harmonic(moving, products=products), pairs if products else alone


def _still(moments: Array, motion: JointMotion) -> bool:
    before, now, after = (motion.at(moments + s).angles for s in (-_AROUND, 0.0, _AROUND))
    moved = np.nan_to_num(np.abs([now - before, after - now]))
    return float(moved.max(initial=0.0)) < _STILL
