"""Which measurement of a set-up to take next, and at which joints.

In units in which the posterior of the unknowns is N(0, 1), what is measured at a pose has slopes A
over its noise, and all that is predicted has slopes B. With K the covariance after the choices so
far, at first 1, and G = B^T B,

    K' = K - K A^T (1 + A K A^T)^-1 A K
    tr(K G) - tr(K' G) = tr((1 + A K A^T)^-1 A K G K A^T)

so that what a measurement is worth is known before it is taken (Fedorov 1972, "Theory of optimal
experiments"). Predicted is what the instruments would show where they have worked; the variances of
each channel count over their mean now, so that metres and pixels weigh the same.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import solve_triangular

from handeye.arrays import Array, Integers, count
from handeye.calibration.arm.measurements import Instrument, PoseSightings, StereoSightings
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.free_poses import FreePoses, not_free, title
from handeye.calibration.view import View
from handeye.errors import InvalidInput
from handeye.randomness import stream

# Poses of each measurement to choose from, and to predict at; rows linearised at a time.
_CANDIDATES, _PREDICTED, _CHUNK = 100, 200, 256
# Information so small, where 1 is what is known, is none.
_NOTHING = 1e-6


@dataclass(frozen=True, eq=False)
class SuggestedRow:
    """A measurement to take; of a camera and a board, a picture.

    measurement  name of the instrument, or what it sees and by what
    joint_names  of the joints between its links
    joints       (m,) encoder readings [rad], or [m] of joints that slide
    pointing     of a head on a pan axis, where that stands [rad]
    after        by channel, how well it is predicted once this and those before are taken
    """

    measurement: str
    joint_names: tuple[str, ...]
    joints: Array
    pointing: float | None
    after: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class SuggestedRows:
    """Measurements to take, the most useful first, each given the ones before.

    before  by channel, how well it is predicted now: root mean square over where its instruments
            have worked, of the expected length of the error, in the channel's unit
    units   of the channels
    left    measurements whose poses cannot be chosen, and why
    """

    rows: tuple[SuggestedRow, ...]
    before: Mapping[str, float]
    units: Mapping[str, str]
    left: tuple[str, ...]


def suggest_rows(
    fit: MixedFit,
    n: int,
    *,
    view: View | None = None,
    wider: bool = False,
    sizes: Mapping[str, tuple[int, int]] | None = None,
) -> SuggestedRows:
    """The n measurements that together make predictions most certain, chosen one after the other.

    Of every instrument whose poses can be chosen, at poses that `FreePoses.draw` gives.
    sizes: width and height of cameras' pictures by name.

    Raises:
        InvalidInput: n below 1, no poses to choose, none in view, or `facing` of mere points.
    """
    n, sizes = count(n, "n"), sizes or {}
    why = {i: not_free(one) for i, one in enumerate(fit.given)}
    left = tuple(f"{title(fit.given[i])}: {reason}" for i, reason in why.items() if reason)
    if len(left) == len(why):
        raise InvalidInput("there are no poses to choose:\n  " + "\n  ".join(left))
    facing = view is None or view.facing == np.pi
    slopes, rng = _Slopes(fit), stream("suggest: set-up", 0)
    predicted: dict[str, list[Array]] = {}
    offered: list[_Offer] = []
    for i in (i for i, reason in why.items() if reason is None):
        found = fit.measurements[i]
        free = FreePoses(fit, found, view, sizes)
        facing |= free.oriented
        count_of = len(found.sight.points.reference)
        joints, pointing = free.draw(_PREDICTED, rng)
        which = rng.integers(count_of, size=len(joints))
        B = slopes.of(fit.given[i], joints, which, pointing)
        for channel in dict.fromkeys(found.channels):
            own = np.array(found.channels) == channel
            predicted.setdefault(channel, []).append(B[:, own])
        joints, pointing = free.draw(max(_CANDIDATES, n), rng, wider=wider)
        A = slopes.told(fit.given[i], joints, np.arange(count_of), pointing)
        offered.append(_Offer(title(found), free.arm.joint_names, joints, pointing, A))
    if not facing:
        raise InvalidInput("nothing that is seen has a front: leave out facing")
    spread = _Spread({channel: np.concatenate(some) for channel, some in predicted.items()})
    before = spread.by_channel()
    units = {c: u for one in fit.given for c, u in zip(one.channels, one.units, strict=True)}
    rows = tuple(spread.take_best(offered) for _ in range(n))
    return SuggestedRows(rows, before, {channel: units[channel] for channel in before}, left)


class _Offer(NamedTuple):
    """Poses (c, m) of a measurement, and what each would tell (c, r, n)."""

    measurement: str
    joint_names: tuple[str, ...]
    joints: Array
    pointing: Array | None
    A: Array


class _Slopes:
    """Derivatives of what is measured at any poses, by unknowns of which the posterior is N(0, 1).

    With priors as wide as stated, at least (`Posterior.root`): what few rows could not show yet is
    what others may.
    """

    def __init__(self, fit: MixedFit) -> None:
        self._fit, self._root = fit, fit.posterior.root

    def of(self, one: Instrument, joints: Array, which: Integers, pointing: Array | None) -> Array:
        """(N, k, n) at N poses, each of one of the target's points."""
        parts = [slice(start, start + _CHUNK) for start in range(0, len(joints), _CHUNK)]
        return np.concatenate(
            [
                self._some(one, joints[at], which[at], None if pointing is None else pointing[at])
                for at in parts
            ]
        )

    def told(
        self, one: Instrument, joints: Array, points: Integers, pointing: Array | None
    ) -> Array:
        """(N, r, n) of all points at each of N poses, over the noise of ordinary rows."""
        c, p = len(joints), len(points)
        pan = None if pointing is None else np.repeat(pointing, p)
        J = self.of(one, np.repeat(joints, p, axis=0), np.tile(points, c), pan)
        errors = self._fit.posterior.errors
        channels = [self._fit.problem.channels.index(name) for name in one.channels]
        variance = np.median(one.std, axis=0) ** 2 + errors.noise[channels] ** 2
        told = (J * np.sqrt(errors.tails[channels] / variance)[:, np.newaxis]).reshape(
            c, -1, J.shape[-1]
        )
        # Of the many points of a picture most say what others say.
        sizes, ways = np.linalg.eigh(told @ told.swapaxes(1, 2))
        kept = max(int(np.sum(np.any(sizes > _NOTHING, axis=0))), 1)
        return ways[:, :, -kept:].swapaxes(1, 2) @ told

    def _some(self, one: Instrument, joints: Array, which: Integers, pan: Array | None) -> Array:
        fit, x = self._fit, self._fit.posterior.x
        own = fit.problem.own(one, x)
        flanges = fit.flanges(joints, one.link, one.base)
        there: dict[str, Any] = {"measured": np.zeros((len(joints), len(one.channels)))}
        if isinstance(one, PoseSightings):
            there["measured"] = one.poses(flanges, own)
        if isinstance(one, StereoSightings):
            there["pointing"] = pan
        sight, std = replace(one.sight, which=which), np.zeros(1)
        parts = replace(one, joints=joints, sight=sight, std=std, **there).equations(flanges, own)
        J = np.zeros((*parts.residuals.shape, len(x)))
        by_arm = fit.problem.slopes(x, joints, one.link, one.base)
        J[:, :, : fit.problem.n_arm] = parts.by_flange @ by_arm
        for block, by_block in zip(one.blocks, parts.by_blocks, strict=True):
            J[:, :, fit.problem.places[block.name]] += by_block
        flat = (J * fit.problem.tolerance).reshape(-1, len(x))
        return solve_triangular(self._root, flat.T, lower=True).T.reshape(J.shape)


class _Spread:
    """What is known of predictions (N, k, n) by channel, as measurements are taken."""

    def __init__(self, predicted: Mapping[str, Array]) -> None:
        self._each = {
            name: np.einsum("nki,nkj->ij", B, B, optimize=True) / len(B)
            for name, B in predicted.items()
        }
        self._wanted = sum((one / np.trace(one) for one in self._each.values()), start=np.zeros(()))
        self._known = np.eye(len(self._wanted))

    def by_channel(self) -> dict[str, float]:
        """Root mean square length of the expected error."""
        return {name: float(np.sqrt(np.sum(self._known * G))) for name, G in self._each.items()}

    def worth(self, A: Array) -> Array:
        """By how much each of c measurements (c, r, n) would lower the sum of variances, (c,)."""
        told = A @ self._known
        inside = np.eye(A.shape[1]) + told @ A.swapaxes(1, 2)
        lowered = told @ self._wanted @ told.swapaxes(1, 2)
        return np.trace(np.linalg.solve(inside, lowered), axis1=1, axis2=2)

    def take(self, A: Array) -> None:
        """Of a measurement (r, n)."""
        told = A @ self._known
        self._known = self._known - told.T @ np.linalg.solve(np.eye(len(A)) + told @ A.T, told)

    def take_best(self, offered: list[_Offer]) -> SuggestedRow:
        """The one of all that is worth most."""
        worth = [self.worth(one.A) for one in offered]
        best = int(np.argmax([some.max() for some in worth]))
        one, at = offered[best], int(np.argmax(worth[best]))
        self.take(one.A[at])
        # The same again would tell less than is expected of it: the arm errs the same.
        one.A[at] = 0.0
        pan = None if one.pointing is None else float(one.pointing[at])
        after = self.by_channel()
        return SuggestedRow(one.measurement, one.joint_names, one.joints[at], pan, after)
