"""What the camera should see, and how that changes with everything that is not known.

The camera sits at P on its carrier, the target at Q on the other; G is the target's carrier in the
camera's, from the arm. Then the camera sees the target at

    S = P^-1 G Q,     R = R_P^T R_G R_Q,     t = s R_P^T (R_G t_Q + t_G - t_P)

which is A X = Z B: eye in hand G = A^-1, P = X and Q = Z; eye to hand G = A, P = Z and Q = X. s is
the unit of a camera that knows no metres, else 1. Residuals are in the camera's axes: first the
rotation vector [rad] of R_measured R^T, then t_measured - t.
"""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from handeye.arrays import Array
from handeye.calibration.hand_eye.links import Links
from handeye.calibration.hand_eye.samples import Samples, Setup
from handeye.calibration.hand_eye.turns import (
    cross_matrix,
    inverse_right_jacobian,
    left_jacobian,
    turn,
    turned_by,
)
from handeye.geometry import invert, make_pose

# Unknowns of P and of Q: rotation vector, then translation, both in the carrier's axes.
POSES = 12


@dataclass(frozen=True, eq=False)
class Guess:
    """Values for everything unknown.

    camera, target  P and Q (4, 4)
    scale           s; 1 for a camera that knows metres
    links           how each link departs from the arm's model (m, 4, 4); m = 0 for none
    """

    camera: Array
    target: Array
    scale: float
    links: Array

    def moved(self, x: Array) -> Self:
        """Changed by x: turns R <- exp(x) R and shifts t <- t + x of P, Q and the links.

        x = (turn and shift of P, of Q, log of the growth of s where it is free, of each link)
        """
        k = len(x) - POSES - 6 * len(self.links)
        return replace(
            self,
            camera=_moved(self.camera, x[:6]),
            target=_moved(self.target, x[6:12]),
            scale=self.scale * float(np.exp(x[POSES : POSES + k].sum())),
            links=_moved(self.links, x[POSES + k :].reshape(-1, 6)),
        )


@dataclass(frozen=True, eq=False)
class Model:
    """The equations of N samples; `links` where errors of the arm are among the unknowns."""

    samples: Samples
    free_scale: bool = False
    links: Links | None = None

    @property
    def n_unknowns(self) -> int:
        """Length of x."""
        return POSES + self.free_scale + (0 if self.links is None else 6 * self.links.count)

    def flanges(self, guess: Guess) -> Array:
        """T_base_flange (N, 4, 4) with the guess's links."""
        return self.samples.flanges if self.links is None else self.links.flanges(guess.links)

    def residuals(self, guess: Guess) -> Array:
        """Measured minus predicted (N, 6)."""
        seen = self.samples.sensed
        R, t, *_ = self._seen(guess)
        out = np.empty((len(seen), 6))
        out[:, :3] = turned_by(seen[:, :3, :3] @ R.swapaxes(1, 2))
        out[:, 3:] = seen[:, :3, 3] - t
        return out

    def jacobian(self, guess: Guess, x: Array | None = None) -> Array:
        """Derivative (N, 6, n_unknowns) of the residuals at guess.moved(x) by x."""
        x = np.zeros(self.n_unknowns) if x is None else x
        here = guess.moved(x)
        _, t, to_camera, R_G, reach = self._seen(here)
        out = np.zeros((len(t), 6, self.n_unknowns))
        to_target, s = to_camera @ R_G, here.scale
        # Of the prediction: turn of what is seen in camera axes, then its shift.
        out[:, :3, 0:3] = -to_camera
        out[:, 3:, 0:3] = s * to_camera @ cross_matrix(reach)
        out[:, 3:, 3:6] = -s * to_camera
        out[:, :3, 6:9] = to_target
        out[:, 3:, 9:12] = s * to_target
        n = POSES
        if self.free_scale:
            out[:, 3:, n] = t
            n += 1
        if self.links is not None:
            by_flange = self.by_flange(here, measured=False)
            by_links = self.links.jacobian(here.links)
            turns = left_jacobian(x[n:].reshape(-1, 6)[:, :3])
            for i in range(self.links.count):
                block = by_links[:, :, 6 * i : 6 * i + 6].copy()
                block[:, :, :3] = block[:, :, :3] @ turns[i]
                out[:, :, n + 6 * i : n + 6 * i + 6] = by_flange @ block
        for start in (0, 6):
            out[:, :, start : start + 3] = out[:, :, start : start + 3] @ left_jacobian(
                x[start : start + 3]
            )
        return self._of_residuals(out, here)

    def by_flange(self, guess: Guess, *, measured: bool = True) -> Array:
        """Derivative (N, 6, 6) of the residuals by a turn and a shift of each flange.

        Turn about the flange's origin and shift, both in axes of the base. Without `measured`
        the derivative of the prediction.
        """
        A = self.flanges(guess)
        _, _, to_camera, R_G, reach = self._seen(guess)
        out = np.zeros((len(A), 6, 6))
        beyond = R_G @ guess.target[:3, 3]
        if self.samples.setup == "eye_to_hand":
            out[:, :3, :3] = to_camera
            out[:, 3:, :3] = -guess.scale * to_camera @ cross_matrix(beyond)
            out[:, 3:, 3:] = guess.scale * to_camera
        else:
            back = A[:, :3, :3].swapaxes(1, 2)
            out[:, :3, :3] = -to_camera @ back
            whole = reach + guess.camera[:3, 3]
            out[:, 3:, :3] = guess.scale * to_camera @ cross_matrix(whole) @ back
            out[:, 3:, 3:] = -guess.scale * to_camera @ back
        return self._of_residuals(out, guess) if measured else out

    def _seen(self, guess: Guess) -> tuple[Array, Array, Array, Array, Array]:
        """Predicted R and t; R_P^T; R_G; target from camera in the axes of the camera's carrier."""
        A = self.flanges(guess)
        G = invert(A) if self.samples.setup == "eye_in_hand" else A
        to_camera = guess.camera[:3, :3].T
        R_G = G[:, :3, :3]
        reach = R_G @ guess.target[:3, 3] + G[:, :3, 3] - guess.camera[:3, 3]
        R = to_camera @ R_G @ guess.target[:3, :3]
        return R, guess.scale * reach @ to_camera.T, to_camera, R_G, reach

    def _of_residuals(self, of_prediction: Array, guess: Guess) -> Array:
        """log(R_measured (exp(d) R)^T) = log(E exp(-d)), so a turn d enters with -K(log E)."""
        K = inverse_right_jacobian(self.residuals(guess)[:, :3])
        of_prediction[:, :3] = -K @ of_prediction[:, :3]
        of_prediction[:, 3:] *= -1.0
        return of_prediction


def motions(samples: Samples) -> Samples:
    """The N - 1 motions from each sample to the next as samples with P = Q.

    The camera moved from S_k-1 to S_k, so S_k-1 S_k^-1 = P^-1 (G_k-1 G_k^-1) P: the rest of the
    equations is that of a target on the same carrier as the camera.
    """
    S, G = samples.sensed, samples.carriers
    moves = G[:-1] @ invert(G[1:])
    # The other setup's convention, in which G is the arm's own pose.
    steps = S[:-1] @ invert(S[1:])
    return Samples(moves, steps, np.arange(len(moves)), _TO_HAND, samples.distance)


_TO_HAND: Setup = "eye_to_hand"


def _moved(T: Array, x: Array) -> Array:
    return make_pose(turn(x[..., :3]) @ T[..., :3, :3], T[..., :3, 3] + x[..., 3:])
