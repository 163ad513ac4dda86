"""Commands and misses of a planar robot, and the envelope that commands stay in; compiled."""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans
from handeye.calibration.combined.planar.kernels import Planar, planar_command
from handeye.calibration.estimation.kernels import wrapped

_HALVINGS = 40


@compiled
def nominal_hand(kernel: Planar, alpha: float, beta: float) -> tuple[float, float]:
    """Where nominal kinematics put the hand at encoder readings."""
    p = kernel.nominal
    first = alpha + p[4]
    both = first + beta + p[5]
    x = p[0] * np.cos(first) + p[1] * np.cos(both)
    return x, p[0] * np.sin(first) + p[1] * np.sin(both)


@compiled
def possible(kernel: Planar, x: Array) -> bool:
    """Whether unknowns (n,) describe a robot at all: finite, with positive lengths and scale."""
    for i in range(len(x)):
        if not np.isfinite(x[i]):
            return False
    p = kernel.nominal
    return p[0] + x[0] > 0.0 and p[1] + x[1] > 0.0 and p[7] + x[7] > 0.0


@compiled
def act(
    kernel: Planar, x: Array, extra: Array, seen: Array, envelope: float, joints: Array
) -> bool:
    """Readings joints (2,), overwritten, for a sighting (5,); tells whether it had to hold back.

    The learned command plus extra (2,). Where that brings the hand farther than `envelope` [m] from
    the nominal command, by nominal kinematics, it goes only part of the way; where it is no number
    at all, it is the nominal one.
    """
    n_x, nominal = np.zeros(len(x)), np.empty(2)
    planar_command(kernel, n_x, seen, nominal)
    if possible(kernel, x):
        planar_command(kernel, x, seen, joints)
    else:
        joints[:] = nominal
    change = np.empty(2)
    for k in range(2):
        change[k] = wrapped(joints[k] + extra[k] - nominal[k])
        if not np.isfinite(change[k]):
            change[:] = 0.0
            break
    at_x, at_y = nominal_hand(kernel, nominal[0], nominal[1])
    # `low` of the way is inside; `high`, once found, is not.
    low, high, part = 0.0, 2.0, 1.0
    for _ in range(_HALVINGS):
        to_x, to_y = nominal_hand(
            kernel, nominal[0] + part * change[0], nominal[1] + part * change[1]
        )
        if np.hypot(to_x - at_x, to_y - at_y) <= envelope:
            low = part
            if part == 1.0:
                break
        else:
            high = part
        part = 0.5 * (low + high)
    for k in range(2):
        joints[k] = wrapped(nominal[k] + low * change[k])
    return low < 1.0


@compiled
def act_many(
    kernel: Planar, x: Array, extra: Array, seen: Array, envelope: float, joints: Array,
    held: Booleans,
) -> None:  # fmt: skip
    """The same for sightings (N, 5), extra and joints (N, 2), held (N,)."""
    for i in range(len(seen)):
        held[i] = act(kernel, x, extra[i], seen[i], envelope, joints[i])


@compiled
def missed(kernel: Planar, seen: Array, joints: Array, out: Array) -> None:
    """out (2,), overwritten: displacement of the hand in sighting seen (5,) from a command (2,).

    By nominal kinematics, as for every other calibrator.
    """
    here_x, here_y = nominal_hand(kernel, seen[0], seen[1])
    there_x, there_y = nominal_hand(kernel, joints[0], joints[1])
    out[0], out[1] = here_x - there_x, here_y - there_y


@compiled
def judge(
    kernel: Planar, x: Array, seen: Array, envelope: float, joints: Array, misses: Array
) -> None:
    """What two commanders would have made of a sighting of the hand (5,).

    joints (2, 2) and misses (2, 2), overwritten: by nominal kinematics, and by what was learned.
    """
    nothing, nobody = np.zeros(2), np.zeros(len(x))
    act(kernel, nobody, nothing, seen, envelope, joints[0])
    act(kernel, x, nothing, seen, envelope, joints[1])
    for i in range(2):
        missed(kernel, seen, joints[i], misses[i])
