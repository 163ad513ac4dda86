"""Changes of camera and target that the samples do not notice.

A direction d of the unknowns is determined if the samples tell more about it than

- a rough idea does: a tenth of a radian, and a tenth of the distance from camera to target, and
- noise alone would: wherever the reported turns scatter by s [rad], a shift of 1 m seems to move
  the target by s metres, whether the flange turns or not. Three times that is the least that
  counts.

With F the information of the samples and D that of a rough idea plus that of noise, these are the
generalised eigenvectors F d = f D d with f < 1.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh

from handeye.arrays import Array
from handeye.calibration.hand_eye import noise
from handeye.calibration.hand_eye.model import POSES
from handeye.calibration.hand_eye.refinement import Fit, Refinement

_ROUGH = 0.1
# Three times the noise, squared.
_ABOVE_NOISE = 9.0


class Directions(NamedTuple):
    """Columns of changes x of the unknowns.

    open (p, k)      not determined
    closed (p, q)    determined; with the links at the end
    condition        how much better the best is known than the worst, in units of a rough idea
    """

    open: Array
    closed: Array
    condition: float


def directions(refinement: Refinement, fit: Fit) -> Directions:
    """Which changes the samples determine, with the errors of the links averaged over."""
    basis = refinement.free()
    prior = basis.T @ np.diag(refinement.prior(fit.tolerances)) @ basis
    told = refinement.information(fit, basis) + prior
    n_links = 0 if refinement.model.links is None else 6 * refinement.model.links.count
    n = basis.shape[1] - n_links
    if n_links:
        told = told[:n, :n] - told[:n, n:] @ np.linalg.solve(told[n:, n:], told[n:, :n])
    placing = basis[:, :n]
    ignorance = placing.T @ np.diag(_ignorance(refinement, fit)) @ placing
    known, vectors = eigh(0.5 * (told + told.T), ignorance)
    loose = known < 1.0
    worst = max(float(known[0]), 1e-30)
    return Directions(
        placing @ vectors[:, loose],
        np.concatenate([placing @ vectors[:, ~loose], basis[:, n:]], axis=1),
        float(np.sqrt(known[-1] / worst)),
    )


def _ignorance(refinement: Refinement, fit: Fit) -> Array:
    """Diagonal (p,) of D."""
    model = refinement.model
    distance = model.samples.distance / fit.guess.scale
    rough = np.array([_ROUGH] * 3 + [_ROUGH * distance] * 3)
    out = np.zeros(model.n_unknowns)
    out[:POSES] = np.tile(1.0 / rough**2, 2)
    out[POSES:] = 1.0 / _ROUGH**2
    v = fit.variances
    inverse = np.linalg.inv(noise.covariances(v, refinement.carriers(fit.guess)))
    each = (np.einsum("n,nii->i", fit.belief.good, inverse)).reshape(2, 3).mean(axis=1)
    scatter = _ABOVE_NOISE * 2.0 * (v[6] + v[:3].mean())
    out[6:9] += scatter * each[0]
    out[9:12] += scatter * each[1] * fit.guess.scale**2
    return out
