"""A fit put together for the person who has to act on it."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.hand_eye import noise
from handeye.calibration.hand_eye.beliefs import Mounting
from handeye.calibration.hand_eye.directions import Directions
from handeye.calibration.hand_eye.model import POSES, Guess
from handeye.calibration.hand_eye.refinement import Fit, Refinement
from handeye.calibration.hand_eye.result import HandEye
from handeye.calibration.hand_eye.samples import Samples
from handeye.calibration.hand_eye.turns import cross_matrix
from handeye.calibration.hand_eye.wording import NAMES, advice, in_words

_FEW = 8
_MANY_WRONG = 0.3
# Information about what could be anywhere [1/rad^2], [1/m^2].
_NOTHING = 1e-6
# A sample that leaves less than this of its own variance is the only one to tell something.
_ALONE = 1e-6


def summary(
    samples: Samples,
    refinement: Refinement,
    fit: Fit,
    found: Directions,
    mounting: Mounting,
    suspected: tuple[str, ...],
) -> HandEye:
    """Results in the frames and the order in which the samples came.

    suspected: what was probably meant in another way (`mistakes`).
    """
    model, guess = refinement.model, fit.guess
    C = _covariance(samples, refinement, fit, found, mounting)
    in_hand = samples.setup == "eye_in_hand"
    on_flange, in_base = (guess.camera, guess.target) if in_hand else (guess.target, guess.camera)
    of_both = C[:POSES, :POSES]
    if refinement.tied:
        in_base, of_both = _first_pose(samples, guess, C[:6, :6])
    elif not in_hand:
        swap = np.r_[6:12, 0:6]
        of_both = of_both[np.ix_(swap, swap)]

    r, given = model.residuals(guess), model.samples.as_given
    V = refinement.carriers(guess)
    covariances = noise.covariances(fit.variances, V)
    stds = np.sqrt(np.einsum("nii->ni", covariances))
    distance = samples.distance / guess.scale
    rows = np.r_[0:6] if in_hand else np.r_[6:12]
    changes = np.zeros((7, found.open.shape[1]))
    changes[:6] = found.open[rows]
    if model.free_scale:
        changes[6] = found.open[POSES]
    words = in_words(changes, NAMES[samples.setup].on_flange, distance)
    good = given(fit.belief.good)
    return HandEye(
        setup=samples.setup,
        X=on_flange,
        Z=in_base,
        covariance=of_both,
        scale=guess.scale,
        scale_std=guess.scale * float(np.sqrt(C[POSES, POSES])) if model.free_scale else 0.0,
        residuals=given(r),
        normalised=given(r / stds),
        good=good,
        influence=given(_influence(refinement, fit, found, covariances)),
        noise=noise.noise(fit.variances),
        links=None if model.links is None else guess.links,
        condition=found.condition,
        undetermined=words,
        status="\n".join([*suspected, *_status(samples, words, of_both, good, mounting)]),
    )


def _covariance(
    samples: Samples, refinement: Refinement, fit: Fit, found: Directions, mounting: Mounting
) -> Array:
    """(p, p): what the samples say along closed directions, the mounting along open ones."""
    closed, opened = found.closed, found.open
    prior = closed.T @ np.diag(refinement.prior(fit.tolerances)) @ closed
    told = closed @ np.linalg.inv(refinement.information(fit, closed) + prior) @ closed.T
    if opened.shape[1]:
        # Of what is in the base nothing is expected.
        expected = np.full(len(told), _NOTHING)
        each = np.repeat([mounting.turn_std, mounting.position_std], 3) ** -2.0
        first = 0 if samples.setup == "eye_in_hand" else 6
        expected[first : first + 6] = each
        if refinement.model.free_scale:
            expected[POSES] = 1.0
        told = told + opened @ np.linalg.inv((opened.T * expected) @ opened) @ opened.T
    return told


def _first_pose(samples: Samples, guess: Guess, C: Array) -> tuple[Array, Array]:
    """Z = A_0 X S_0 of a camera that counts its way from the first sample on, and (12, 12)."""
    A, S = samples.flanges[0], samples.sensed[0].copy()
    S[:3, 3] /= guess.scale
    R = A[:3, :3]
    carried = np.zeros((6, 6))
    carried[:3, :3] = carried[3:, 3:] = R
    carried[3:, :3] = -R @ cross_matrix(guess.camera[:3, :3] @ S[:3, 3])
    both = np.concatenate([np.eye(6), carried])
    return A @ guess.camera @ S, both @ C @ both.T


def _influence(refinement: Refinement, fit: Fit, found: Directions, C: Array) -> Array:
    """sqrt(d^T F d / q) (N,) where d is how far the unknowns move when a sample is left out.

    d = F^-1 J^T (C/w - J F^-1 J^T)^-1 r, the exact change of a weighted linear fit; inf where the
    others do not determine the unknowns.
    """
    J = refinement.model.jacobian(fit.guess) @ found.closed
    r = refinement.model.residuals(fit.guess)
    w = np.maximum(fit.belief.weights, 1e-9)[:, None, None]
    prior = found.closed.T @ np.diag(refinement.prior(fit.tolerances)) @ found.closed
    q = max(J.shape[2], 1)
    shape = J.shape[0] * J.shape[1], J.shape[2]
    told = (J * w).reshape(shape).T @ (np.linalg.inv(C) @ J).reshape(shape) + prior
    through = J @ np.linalg.inv(told)
    left = C / w - through @ J.swapaxes(1, 2)
    roots = np.linalg.cholesky(np.linalg.inv(C / w))
    alone = np.linalg.eigvalsh(roots.swapaxes(1, 2) @ left @ roots)[:, 0] < _ALONE
    pull = (np.linalg.pinv(left, hermitian=True) @ r[..., None])[..., 0]
    moved = (through.swapaxes(1, 2) @ pull[..., None])[..., 0]
    cook = np.maximum(np.sum((moved @ told) * moved, axis=1), 0.0) / q
    return np.where(alone, np.inf, np.sqrt(cook))


def _status(
    samples: Samples, words: tuple[str, ...], C: Array, good: Array, mounting: Mounting
) -> list[str]:
    names = NAMES[samples.setup]
    lines: list[str] = []
    if words:
        lines.append(
            f"not determined by these {len(samples.order)} poses: {'; '.join(words)}. There the "
            f"expected mounting decides (standard deviations {mounting.position_std:.3g} m and "
            f"{np.degrees(mounting.turn_std):.3g} degrees); {advice(samples.flanges, names)}"
        )
    else:
        shift, turn = np.sqrt(np.trace(C[3:6, 3:6])), np.sqrt(np.trace(C[:3, :3]))
        lines.append(
            f"everything is determined: the {names.on_flange} on the flange to {shift * 1e3:.2g} "
            f"mm and {np.degrees(turn):.2g} degrees (one standard deviation)"
        )
        if len(samples.order) < _FEW:
            lines.append(
                f"{len(samples.order)} poses leave little to check them with: add some dozens"
            )
    wrong = np.flatnonzero(good < 0.5)
    if len(wrong):
        which = ", ".join(str(i) for i in wrong[:10]) + (", ..." if len(wrong) > 10 else "")
        lines.append(f"{len(wrong)} of {len(good)} samples look wrong and do not count: {which}")
    if len(wrong) > _MANY_WRONG * len(good):
        lines.append("with so many wrong, check setup, units, and which pose belongs to which")
    return lines
