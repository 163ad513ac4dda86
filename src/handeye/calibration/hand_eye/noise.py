"""How large the errors of camera and arm are, from the residuals themselves.

The residuals of sample i are normal with covariance

    C_i = sum_k v_k V_ik

The v_k are variances: of the camera's turn and of its position along each axis of the camera, of
the flange's turn and position, and, with an arm, of each joint. V_ik carries a unit variance of
kind k to the residuals: a turn of the flange, say, to what it does to the camera's position, which
the length of the lever decides. Variances are found by restricted maximum likelihood (Patterson and
Thompson 1971), for so the degrees of freedom that the unknowns take are not good as accuracy.
"""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array

# Kinds 0-2 camera turn, 3-5 camera position, 6 flange turn, 7 flange position, 8 joints.
_GROUPS = ((0, 1, 2), (3, 4, 5))
# An axis of the camera is believed to be like the group's mean as if seen in this many residuals.
_LIKE_THE_OTHERS = 4.0
# Nothing is measured better than this [rad], [m]: keeps rounding from counting as information.
LEAST = 1e-7
_ROUNDS = 6


@dataclass(frozen=True)
class Noise:
    """Standard deviations of one sample.

    camera_turn (3,) [rad] and camera_position (3,) in the camera's axes, in the unit in which the
    camera measures; flange_turn [rad] and flange_position [m], equal in all directions; joints
    [rad], 0 without an arm
    """

    camera_turn: Array
    camera_position: Array
    flange_turn: float
    flange_position: float
    joints: float


def noise(variances: Array) -> Noise:
    """Variances (8 or 9,) as standard deviations."""
    std = np.sqrt(variances)
    return Noise(std[:3], std[3:6], float(std[6]), float(std[7]), float(std[8:].sum()))


def carriers(by_flange: Array, by_joints: Array | None) -> Array:
    """V (K, N, 6, 6) from the derivative of the residuals by each flange (N, 6, 6).

    by_joints (N, 6, n): turn and shift of each flange per turn of the joints.
    """
    n = len(by_flange)
    V = np.zeros((8 if by_joints is None else 9, n, 6, 6))
    for k in range(6):
        V[k, :, k, k] = 1.0
    roots = [by_flange[:, :, :3], by_flange[:, :, 3:]]
    if by_joints is not None:
        roots.append(by_flange @ by_joints)
    for k, root in enumerate(roots):
        V[6 + k] = root @ root.swapaxes(1, 2)
    return V


def first_variances(residuals: Array, kinds: int) -> Array:
    """Variances (kinds,) to begin with: the camera's from medians, the arm's a tenth of them."""
    # Median length of a normally distributed 3-vector whose components have standard deviation 1.
    turn, shift = (
        np.median(np.linalg.norm(residuals[:, part], axis=1)) / 1.538
        for part in (slice(3), slice(3, 6))
    )
    out = np.empty(kinds)
    out[:3], out[3:6] = turn**2, shift**2
    out[6], out[7] = 0.1 * turn**2, 0.1 * shift**2
    out[8:] = 0.1 * turn**2
    return np.maximum(out, LEAST**2)


def improved(
    variances: Array, V: Array, r: Array, J: Array, prior: Array, weights: Array, good: Array
) -> tuple[Array, Array]:
    """Variances after some rounds towards the most likely ones for residuals r (N, 6).

        v_k <- v_k sqrt( sum_i w_i r_i^T C_i^-1 V_ik C_i^-1 r_i / tr(P V_k) )

    (minorisation by Zhou, Hu, Zhou and Lange 2019, which can never turn negative.) P is the
    inverse covariance less what the unknowns with Jacobian J (N, 6, p) and prior information
    (p, p) explain; w_i (N,) is the weight of a sample and good (N,) the probability with which it
    counts in the trace. Also returns the covariance (p, p) of the unknowns, with a standard
    deviation of 1 for those of which nothing is known.
    """
    v: Array = variances
    spread: Array = prior
    p = J.shape[2]
    kinds = V.reshape(len(V), -1)
    for _ in range(_ROUNDS):
        inverse = np.linalg.inv(covariances(v, V))
        scaled = inverse @ J
        weighed = (J * good[:, None, None]).reshape(r.size, p)
        information = weighed.T @ scaled.reshape(r.size, p) + prior
        spread = np.asarray(np.linalg.inv(information + np.eye(p)), dtype=np.float64)
        left = inverse - good[:, None, None] * (scaled @ spread @ scaled.swapaxes(1, 2))
        unit = (inverse @ r[..., None])[..., 0]
        seen = kinds @ (weights[:, None, None] * unit[:, :, None] * unit[:, None]).reshape(-1)
        freedom = kinds @ (good[:, None, None] * left).reshape(-1)
        freedom = np.maximum(freedom, 1e-300)
        for group in map(list, _GROUPS):
            mean = float(v[group].mean())
            seen[group] += _LIKE_THE_OTHERS * mean / v[group] ** 2
            freedom[group] += _LIKE_THE_OTHERS / v[group]
        v = np.maximum(v * np.sqrt(seen / freedom), LEAST**2)
    return v, spread


def covariances(variances: Array, V: Array) -> Array:
    """C (N, 6, 6)."""
    return np.tensordot(variances, V, axes=1)


def normalised(r: Array, variances: Array, V: Array) -> tuple[Array, Array]:
    """r_i^T C_i^-1 r_i and log det C_i, each (N,)."""
    roots = np.linalg.cholesky(covariances(variances, V))
    unit = np.linalg.solve(roots, r[..., None])[..., 0]
    log_dets = 2.0 * np.log(np.diagonal(roots, axis1=1, axis2=2)).sum(axis=1)
    return np.sum(unit**2, axis=1), log_dets
