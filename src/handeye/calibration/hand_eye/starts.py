"""Closed forms of A X = Z B from which the fit starts, and consensus among samples.

From rotations: R_i = R_P^T R_Gi R_Q makes R_Q = R_Gi^T R_P R_i for each i, so that vec R_P and
vec R_Q are the leading singular pair of sum_i R_Gi^T (x) R_i^T (Shah 2013). From these, shifts and
scale are linear:

    R_Gi t_Q - t_P - R_P t_i / s = -t_Gi

Three samples suffice. A few hundred triples are solved, each is judged by the medians of what all
samples disagree with it, so that up to half of them may be wrong, and the best are handed on with
the closed form from all samples.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, Integers
from handeye.calibration.hand_eye.model import Guess
from handeye.calibration.hand_eye.samples import Samples
from handeye.geometry import make_pose, nearest_rotation

_TRIPLES = 300
_BEST = 3
_ALTERNATIONS = 5
# Singular values below this share of the largest leave a shift at its least length: turns of less
# than half a degree are mostly noise, and a shift made of noise is a bad start.
_LEAST_SHARE = 0.01
# Rotations as good as equal [rad] and positions [m] must not make one triple infinitely good.
_LEAST = 1e-12


def starts(
    samples: Samples, *, free_scale: bool, tied: bool, triples: int = _TRIPLES
) -> list[Guess]:
    """Guesses in the order in which they satisfy most samples; at least one.

    tied: camera and target are the same thing, P = Q (`model.motions`). triples: how many are tried
    """
    n = len(samples.sensed)
    rng = np.random.default_rng(n)
    few = np.array([rng.choice(n, min(3, n), replace=False) for _ in range(triples)])
    everything = np.arange(n)[None]
    found: list[tuple[Array, Array, Array]] = []

    def add(chosen: Integers, camera: Array | None) -> None:
        G, S = samples.carriers[chosen], samples.sensed[chosen]
        if camera is None:
            camera = _leading(G[..., :3, :3], S[..., :3, :3], tied=tied)
        turns = _agreeing(G[..., :3, :3], S[..., :3, :3], camera, tied=tied)
        found.append(_placed(G, S, *turns, free_scale=free_scale, tied=tied))

    add(everything, None)
    add(np.unique(np.sort(few, axis=1), axis=0), None)
    # No rotation is more than 63 degrees from one of the cube's: where rotations leave a turn open,
    # one of these is near the turn that the shifts want.
    cube = Rotation.create_group("O").as_matrix()
    add(np.repeat(everything, len(cube), axis=0), cube)
    P, Q, scale = (np.concatenate(parts) for parts in zip(*found, strict=True))
    turn, shift = disagreements(samples, P, Q, scale)
    rank = np.log(turn + _LEAST) + np.log(shift + _LEAST)
    order = dict.fromkeys([*np.argsort(rank, kind="stable")[:_BEST].tolist(), 0])
    return [Guess(P[k], Q[k], float(scale[k]), np.zeros((0, 4, 4))) for k in order]


def _placed(
    G: Array, S: Array, R_P: Array, R_Q: Array, *, free_scale: bool, tied: bool
) -> tuple[Array, Array, Array]:
    """P, Q (K, 4, 4) and s (K,) from K sets of samples (K, size, 4, 4) and their rotations."""
    k, size = G.shape[:2]
    unknowns = 6 + free_scale
    system = np.zeros((k, size, 3, unknowns))
    system[..., :3] = G[..., :3, :3]
    system[..., 3:6] = -np.eye(3)
    if tied:
        system[..., :3] += system[..., 3:6]
        system[..., 3:6] = 0.0
    seen = (R_P[:, None] @ S[..., :3, 3, None])[..., 0]
    wanted = -G[..., :3, 3]
    # As long as the rest, whatever the camera's unit, or small singular values would be lost.
    unit = np.linalg.norm(seen, axis=-1).mean(axis=1) + _LEAST
    if free_scale:
        system[..., 6] = -seen / unit[:, None, None]
    else:
        wanted = wanted + seen
    flat = system.reshape(k, -1, unknowns)
    x = (np.linalg.pinv(flat, rcond=_LEAST_SHARE) @ wanted.reshape(k, -1, 1))[..., 0]
    target, camera = x[:, :3], x[:, :3] if tied else x[:, 3:6]
    scale = np.ones(k)
    if free_scale:
        # A scale that is not positive means that the triple says nothing about it.
        scale = unit / np.maximum(x[:, 6], 1e-9)
    return make_pose(R_P, camera), make_pose(R_Q, target), scale


def _leading(G: Array, S: Array, *, tied: bool) -> Array:
    """R_P (K, 3, 3) of the leading singular vectors, from rotations (K, size, 3, 3)."""
    system = np.einsum("kmba,kmcd->kadbc", G, S).reshape(-1, 9, 9)
    if tied:
        leading = np.linalg.eigh(system + system.swapaxes(1, 2))[1][:, :, -1]
    else:
        leading = np.linalg.svd(system)[2][:, 0]
    found = leading.reshape(-1, 3, 3)
    sign = np.where(np.linalg.det(found) < 0.0, -1.0, 1.0)
    return nearest_rotation(sign[:, None, None] * found)


def _agreeing(G: Array, S: Array, R_P: Array, *, tied: bool) -> tuple[Array, Array]:
    """From any R_P to a pair that fits: each is the best for the other, by turns.

    Where a whole family of pairs fits, the leading pair of singular vectors need not be in it.
    """
    camera = target = R_P
    for _ in range(_ALTERNATIONS):
        target = nearest_rotation(np.einsum("kmba,kbc,kmcd->kad", G, camera, S, optimize=True))
        camera = nearest_rotation(np.einsum("kmab,kbc,kmdc->kad", G, target, S, optimize=True))
    return (camera, camera) if tied else (camera, target)


def disagreements(samples: Samples, P: Array, Q: Array, scale: Array) -> tuple[Array, Array]:
    """Medians over samples of turn [rad] and shift [m] by which K guesses miss them, each (K,)."""
    G, S = samples.carriers, samples.sensed
    to_camera = P[:, None, :3, :3].swapaxes(-1, -2)
    R = to_camera @ G[:, :3, :3] @ Q[:, None, :3, :3]
    reach = (G[:, :3, :3] @ Q[:, None, :3, 3:])[..., 0] + G[:, :3, 3] - P[:, None, :3, 3]
    t = (to_camera @ reach[..., None])[..., 0]
    # |R - R'| in the Frobenius norm is sqrt(8) times the sine of half the angle.
    half = np.linalg.norm(R - S[:, :3, :3], axis=(-2, -1)) / np.sqrt(8.0)
    turn: Array = 2.0 * np.arcsin(np.minimum(half, 1.0))
    shift: Array = np.linalg.norm(t - S[:, :3, 3] / scale[:, None, None], axis=-1)
    return np.asarray(np.median(turn, axis=1)), np.asarray(np.median(shift, axis=1))
