"""From a guess to the most likely values, given samples of which some are wrong.

By turns: the unknowns as weighted least squares, how large the noise is, and how far to believe
each sample (an expectation-maximisation of the likelihood that `noise` and `robust` describe).
"""

from dataclasses import dataclass
from typing import NamedTuple, cast

import numpy as np
from scipy.optimize import least_squares

from handeye.arrays import Array
from handeye.calibration.hand_eye import noise, robust
from handeye.calibration.hand_eye.beliefs import Tolerances
from handeye.calibration.hand_eye.model import Guess, Model
from handeye.calibration.hand_eye.robust import Belief
from handeye.calibration.hand_eye.turns import inverse_right_jacobian, left_jacobian, turned_by

# Gain of the log-likelihood in a round that is none.
_SETTLED = 3e-3
MOST_ROUNDS = 60
# The next round starts where this one ends.
_MOST_STEPS = 6
# Share of gross samples before the first look.
_GROSS = 0.2
# The stated tolerances count as much as the errors of this many links that were seen.
_STATED = 1.0


class Fit(NamedTuple):
    """What refinement found.

    guess           the unknowns
    variances       (K,) of the noise
    belief          in the samples
    tolerances      of the links as they turned out
    log_likelihood  of all samples together
    """

    guess: Guess
    variances: Array
    belief: Belief
    tolerances: Tolerances
    log_likelihood: float


@dataclass(frozen=True, eq=False)
class Refinement:
    """Fits of one model. `tied` keeps camera and target the same pose (`model.motions`)."""

    model: Model
    tolerances: Tolerances
    tied: bool = False

    def fit(self, guess: Guess, basis: Array | None = None, rounds: int = MOST_ROUNDS) -> Fit:
        """The most likely values near a guess, changing only along the columns of basis (p, q)."""
        model = self.model
        basis = self.free() if basis is None else basis
        room = robust.room_of(model.samples.distance)
        carriers, tolerances = self.carriers(guess), self.tolerances
        v = noise.first_variances(model.residuals(guess), len(carriers))
        weighed = noise.normalised(model.residuals(guess), v, carriers)
        belief = robust.believe(*weighed, room, _GROSS)
        likelihood = -np.inf
        for _ in range(rounds):
            before = likelihood
            spreads = noise.covariances(v, carriers)
            guess = self._stepped(guess, basis, spreads, belief, tolerances)
            carriers = self.carriers(guess)
            r, J = model.residuals(guess), model.jacobian(guess) @ basis
            prior = basis.T @ np.diag(self.prior(tolerances)) @ basis
            v, spread = noise.improved(v, carriers, r, J, prior, belief.weights, belief.good)
            weighed = noise.normalised(r, v, carriers)
            belief = robust.believe(*weighed, room, belief.gross)
            tolerances = self._tolerances(guess, basis @ spread @ basis.T)
            likelihood = robust.log_likelihood(*weighed, room, belief)
            if abs(likelihood - before) < _SETTLED:
                break
        return Fit(guess, v, belief, tolerances, likelihood)

    def free(self) -> Array:
        """All changes (p, q) that the model allows."""
        every = np.eye(self.model.n_unknowns)
        if not self.tied:
            return every
        every[6:12, :6] = np.eye(6)
        return np.delete(every, slice(6, 12), axis=1)

    def prior(self, tolerances: Tolerances) -> Array:
        """Information (p,) about each unknown before any sample: that of the links."""
        out = np.zeros(self.model.n_unknowns)
        each = np.repeat([tolerances.angle, tolerances.length], 3)
        n = self._n_links
        out[len(out) - 6 * n :] = np.tile(1.0 / each**2, n)
        return out

    def carriers(self, guess: Guess) -> Array:
        """V of `noise.carriers` at a guess."""
        links = self.model.links
        by_joints = None if links is None else links.by_joints
        return noise.carriers(self.model.by_flange(guess), by_joints)

    def information(self, fit: Fit, basis: Array) -> Array:
        """Of the samples about changes along the columns of basis, (q, q), without priors."""
        J = self.model.jacobian(fit.guess) @ basis
        inverse = np.linalg.inv(noise.covariances(fit.variances, self.carriers(fit.guess)))
        counted = fit.belief.good * robust.sharpness(fit.belief.freedom)
        shape = J.shape[0] * J.shape[1], J.shape[2]
        return (J * counted[:, None, None]).reshape(shape).T @ (inverse @ J).reshape(shape)

    @property
    def _n_links(self) -> int:
        return 0 if self.model.links is None else self.model.links.count

    def _stepped(
        self, guess: Guess, basis: Array, C: Array, belief: Belief, tolerances: Tolerances
    ) -> Guess:
        """The guess with the least sum of w_i r_i^T C_i^-1 r_i, of the links' squares, and |y|^2.

        The last keeps what is not determined from running away; once settled it is nothing.
        """
        if not basis.shape[1]:
            return guess
        model, n = self.model, self._n_links
        roots = np.linalg.cholesky(np.linalg.inv(C)).swapaxes(1, 2)
        roots = roots * np.sqrt(belief.weights)[:, None, None]
        by_tolerance = 1.0 / np.repeat([tolerances.angle, tolerances.length], 3)

        def residuals(y: Array) -> Array:
            here = guess.moved(basis @ y)
            r = (roots @ model.residuals(here)[..., None]).reshape(-1)
            return np.concatenate([r, (departures(here.links) * by_tolerance).reshape(-1), y])

        def jacobian(y: Array) -> Array:
            x = basis @ y
            J = (roots @ (model.jacobian(guess, x) @ basis)).reshape(-1, basis.shape[1])
            of_links = np.zeros((n, 6, len(x)))
            here = departures(guess.moved(x).links)[:, :3]
            first = len(x) - 6 * n
            for i in range(n):
                turn = x[first + 6 * i : first + 6 * i + 3]
                block = of_links[i, :, first + 6 * i : first + 6 * i + 6]
                block[:3, :3] = inverse_right_jacobian(-here[i]) @ left_jacobian(turn)
                block[3:, 3:] = np.eye(3)
            of_links *= by_tolerance[:, None]
            return np.concatenate([J, of_links.reshape(-1, len(x)) @ basis, np.eye(len(y))])

        found = least_squares(
            residuals,
            np.zeros(basis.shape[1]),
            jacobian,
            method="lm",
            # Radians and metres as they are: scaled by the Jacobian, the first steps along what is
            # known a million times worse than the rest would be a million times too short.
            x_scale=1.0,
            xtol=1e-12,
            ftol=1e-12,
            gtol=1e-12,
            max_nfev=_MOST_STEPS,
        )
        return guess.moved(basis @ cast("Array", found.x))

    def _tolerances(self, guess: Guess, spread: Array) -> Tolerances:
        """Expected squares of what the links depart, with the stated tolerances among them."""
        n = self._n_links
        if not n:
            return self.tolerances
        squares = departures(guess.links) ** 2
        squares += np.diag(spread)[len(spread) - 6 * n :].reshape(n, 6)
        stated = np.array([self.tolerances.angle, self.tolerances.length])
        seen = squares.reshape(n, 2, 3).sum(axis=(0, 2)) + 3.0 * _STATED * stated**2
        angle, length = np.sqrt(seen / (3.0 * (n + _STATED)))
        return Tolerances(float(angle), float(length))


def departures(links: Array) -> Array:
    """Rotation vector and shift (m, 6) of each link's departure (m, 4, 4)."""
    return np.concatenate([turned_by(links[:, :3, :3]), links[:, :3, 3]], axis=1)
