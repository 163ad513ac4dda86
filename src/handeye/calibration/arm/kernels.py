"""A serial arm with errors in every stage, in compiled loops.

    T_sensor_marker(q; x) = B E(b)
                            prod_j [ P_j E(xi_j + c_j(q_j)) J_j(q_j + s_j q_j + k_j g_j) ]
                            P_n E(m) M

where joint j stands at q_j = gain_j r[of_j] + offset_j by the readings r (robots.readings),

E(t, r) is the pose that shifts by t and turns by exp([r]x). B and M are the placement of the base
to the sensor and of the marker to the flange, P_j and J_j the arm's constants and joints with every
axis along z (robots.stages). Unknowns x, all nominally 0, in this order:

    b (6)                      base of the sensor: shift [m], turn [rad]
    m (6, or 3)                marker on the flange; a shift alone where no orientation is seen
    for each joint j
        xi (6)                 placement of the joint: shift [m], turn [rad]; the last is its zero
        s                      scale of the joint
        k                      compliance [rad/Nm] (or [m/N]), if there is any; g_j is the load
    two for each term          weights of cos and sin of h phi_j in one component of c_j

where phi_j is q_j times its rate. An observation is a row: readings (m,), loads (n,) if there is
compliance, position (3,) [m], its standard deviations (3,), and, where it is seen,
orientation (4,), a unit quaternion wxyz.
"""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans, Integers
from handeye.calibration.arm.motions import carry, compose, move_joint, shift_and_turn

TWIST = 6
"""Unknowns of a placement."""


class SerialArm(NamedTuple):
    """What the kernels know of an arm with n joints.

    placements (n + 1, 4, 4), slides (n,): the stages, upright; n_readings m; of, gains, offsets
    (n,): which reading tells of a joint, and where it then stands; rates (n,): phase of the curves
    [rad] per rad or m; T_sensor_base, T_flange_marker (4, 4); n_marker 6 or 3; compliant, oriented:
    whether there are loads, and orientations, in a row; terms (T, 3): joint, component 0 to 5,
    harmonic of each term; low, high (n,): where joints were seen, beyond which curves keep the
    value of the edge; turn_std: standard deviation of measured orientations [rad]; lever: what the
    model leaves unexplained of a position, over this length [m], it leaves of a turn.
    """

    placements: Array
    slides: Booleans
    n_readings: int
    of: Integers
    gains: Array
    offsets: Array
    rates: Array
    T_sensor_base: Array
    T_flange_marker: Array
    n_marker: int
    compliant: bool
    oriented: bool
    terms: Integers
    low: Array
    high: Array
    turn_std: float
    lever: float


@compiled
def joint_width(kernel: SerialArm) -> int:
    """Unknowns of a joint but for its curves."""
    return TWIST + 2 if kernel.compliant else TWIST + 1


@compiled
def joint_at(kernel: SerialArm, j: int) -> int:
    """Where the unknowns of joint j begin; for j = n, where the weights of curves begin."""
    return TWIST + kernel.n_marker + j * joint_width(kernel)


@compiled
def n_unknowns(kernel: SerialArm) -> int:
    """Length of x."""
    return joint_at(kernel, len(kernel.slides)) + 2 * len(kernel.terms)


@compiled
def stands_at(kernel: SerialArm, q: Array, j: int) -> float:
    """Where joint j is [rad] or [m] as the readings q (m,) have it."""
    return kernel.gains[j] * q[kernel.of[j]] + kernel.offsets[j]


@compiled
def waves(kernel: SerialArm, q: Array, out: Array) -> None:
    """out (T, 2), overwritten: cos and sin of each term at readings q (m,)."""
    for i in range(len(kernel.terms)):
        j, h = kernel.terms[i, 0], kernel.terms[i, 2]
        held = min(max(stands_at(kernel, q, j), kernel.low[j]), kernel.high[j])
        angle = h * kernel.rates[j] * held
        out[i, 0], out[i, 1] = np.cos(angle), np.sin(angle)


@compiled
def chain(
    kernel: SerialArm, x: Array, seen: Array, wave: Array, T: Array, ways: Array, origins: Array
) -> None:
    """The marker's pose T (3, 4), and what is needed for its derivatives; all overwritten.

    wave (T, 2): `waves` at the readings of seen (w,). ways (n + 2, 6, 7), origins (n + 2, 3): base,
    joints and marker; each the six components of its twist and the joint's motion about its origin.
    """
    n = len(kernel.slides)
    twists = np.zeros((n, TWIST))
    for j in range(n):
        at = joint_at(kernel, j)
        twists[j] = x[at : at + TWIST]
    at = joint_at(kernel, n)
    for i in range(len(kernel.terms)):
        j, c = kernel.terms[i, 0], kernel.terms[i, 1]
        twists[j, c] += x[at + 2 * i] * wave[i, 0] + x[at + 2 * i + 1] * wave[i, 1]
    T[:, :] = kernel.T_sensor_base[:3]
    shift_and_turn(T, x[:TWIST], ways[0])
    origins[0] = T[:, 3]
    for j in range(n):
        compose(T, kernel.placements[j])
        shift_and_turn(T, twists[j], ways[1 + j])
        origins[1 + j] = T[:, 3]
        row = 0 if kernel.slides[j] else 3
        for i in range(3):
            ways[1 + j, row + i, TWIST] = T[i, 2]
            ways[1 + j, 3 - row + i, TWIST] = 0.0
        move_joint(T, actual(kernel, x, seen, j), kernel.slides[j])
    compose(T, kernel.placements[n])
    marker = np.zeros(TWIST)
    marker[: kernel.n_marker] = x[TWIST : TWIST + kernel.n_marker]
    shift_and_turn(T, marker, ways[n + 1])
    origins[n + 1] = T[:, 3]
    compose(T, kernel.T_flange_marker)


@compiled
def actual(kernel: SerialArm, x: Array, seen: Array, j: int) -> float:
    """Where joint j is [rad] or [m]: as its reading has it, scaled, and what the load bends."""
    at = joint_at(kernel, j) + TWIST
    read = stands_at(kernel, seen, j)
    q = read + x[at] * read
    return q + x[at + 1] * seen[kernel.n_readings + j] if kernel.compliant else q


@compiled
def pose(kernel: SerialArm, x: Array, seen: Array, T: Array) -> None:
    """T (3, 4), overwritten: the marker in the sensor's frame."""
    n = len(kernel.slides)
    wave = np.empty((len(kernel.terms), 2))
    waves(kernel, seen, wave)
    chain(kernel, x, seen, wave, T, np.zeros((n + 2, TWIST, TWIST + 1)), np.empty((n + 2, 3)))


@compiled
def pose_slopes(kernel: SerialArm, x: Array, seen: Array, T: Array, slopes: Array) -> None:
    """The marker in the sensor's frame T (3, 4), and its derivatives (6, n_x); both overwritten.

    Rows 0 to 2: shift of the marker's origin [m], 3 to 5: turn [rad], in the sensor's axes.
    """
    n = len(kernel.slides)
    wave = np.empty((len(kernel.terms), 2))
    waves(kernel, seen, wave)
    ways, origins = np.zeros((n + 2, TWIST, TWIST + 1)), np.empty((n + 2, 3))
    chain(kernel, x, seen, wave, T, ways, origins)
    moved = np.empty((n + 2, TWIST, TWIST + 1))
    for j in range(n + 2):
        carry(ways[j], origins[j], T, moved[j])
    for i in range(TWIST):
        for c in range(TWIST):
            slopes[i, c] = moved[0, i, c]
        for c in range(kernel.n_marker):
            slopes[i, TWIST + c] = moved[n + 1, i, c]
        for j in range(n):
            at = joint_at(kernel, j)
            for c in range(TWIST):
                slopes[i, at + c] = moved[1 + j, i, c]
            slopes[i, at + TWIST] = stands_at(kernel, seen, j) * moved[1 + j, i, TWIST]
            if kernel.compliant:
                load = seen[kernel.n_readings + j]
                slopes[i, at + TWIST + 1] = load * moved[1 + j, i, TWIST]
        at = joint_at(kernel, n)
        for k in range(len(kernel.terms)):
            way = moved[1 + kernel.terms[k, 0], i, kernel.terms[k, 1]]
            slopes[i, at + 2 * k] = way * wave[k, 0]
            slopes[i, at + 2 * k + 1] = way * wave[k, 1]


@compiled
def pose_slopes_many(kernel: SerialArm, x: Array, seen: Array, T: Array, slopes: Array) -> None:
    """The same for rows seen (N, w): T (N, 3, 4) and slopes (N, 6, n_x), overwritten."""
    for i in range(len(seen)):
        pose_slopes(kernel, x, seen[i], T[i], slopes[i])


@compiled
def pose_many(kernel: SerialArm, x: Array, seen: Array, T: Array) -> None:
    """Poses alone, T (N, 3, 4)."""
    for i in range(len(seen)):
        pose(kernel, x, seen[i], T[i])
