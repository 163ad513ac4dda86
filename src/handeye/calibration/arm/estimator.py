"""A calibrator that fits all that was observed at once."""

from dataclasses import replace

import numpy as np
from scipy.linalg import solve_triangular

from handeye.arrays import Array
from handeye.calibration.arm.corrected import CorrectedArm
from handeye.calibration.arm.evidence import Posterior, solve
from handeye.calibration.arm.kernels import joint_at
from handeye.calibration.arm.log_system import LogSystem
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.calibrator import Feedback
from handeye.calibration.engine.robot import Acting
from handeye.calibration.placed_arm import PlacedArm
from handeye.errors import InvalidInput
from handeye.observations import PointObservation, PointTarget

FINE = CurveTerms(own=64, others=6)
"""Harmonics of a fit: more than can be seen, for those not seen are switched off."""

# Fitted for the first time after so many observations, then whenever there are so many times more.
_FIRST, _MORE = 24, 1.5


class ArmEstimator:
    """Fits an arm with errors in every stage to all observations, and its priors with them.

    Unlike `Combined` it keeps every observation and its cost grows with them; in return the order
    does not matter, and widths of priors and noise are those of greatest evidence (`evidence`), so
    that far finer error curves can be offered than the data must support. It does not follow drift
    and knows no changes.

    While it observes it fits anew when the observations have grown by half, and before it is next
    asked for `errors` or `command`.

    Args:
        model: nominal kinematics, placed.
        sheet: how far the arm may be from nominal; by default `ArmSheet` with curves `FINE`.
    """

    def __init__(self, model: PlacedArm, sheet: ArmSheet | None = None) -> None:
        self.model = model
        self.sheet = sheet or replace(ArmSheet(), curves=FINE)
        self.robot = ArmRobot(model, self.sheet)
        self._seen: list[Array] = []
        self._posterior: Posterior | None = None
        self._fitted: int = 0
        self._acting = self._with(np.zeros(len(self.robot.chain.names)))

    @property
    def n_observations(self) -> int:
        """So far."""
        return sum(len(rows) for rows in self._seen)

    @property
    def seen(self) -> Array:
        """(N, w) every observation, as the kernel reads it."""
        width = self.robot.chain.n_seen
        return np.concatenate(self._seen) if self._seen else np.empty((0, width))

    @property
    def x(self) -> Array:
        """The estimate (n_x,), in the order of `names`."""
        self._settle()
        return self._acting.x

    @property
    def names(self) -> tuple[str, ...]:
        """Of the unknowns."""
        return self.robot.chain.names

    def posterior(self) -> Posterior:
        """What is known of the unknowns after all observations.

        Raises:
            InvalidInput: before there are any.
        """
        self._settle()
        if self._posterior is None:
            raise InvalidInput("nothing was observed yet: observe first")
        return self._posterior

    def std(self) -> Array:
        """Standard deviations (n_x,) of the unknowns."""
        if not self._seen:
            return self.robot.chain.tolerance.copy()
        found = self.posterior()
        half = solve_triangular(found.root, np.eye(len(found.root)), lower=True)
        return np.sqrt(np.sum(half**2, axis=0)) * self.robot.chain.tolerance

    @property
    def plant(self) -> CorrectedArm:
        """The arm as fitted, but for its curves."""
        return self.robot.corrected(self.x)

    def observe(self, observation: PointObservation) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        if observation.joints.ndim != 1:
            raise InvalidInput("observe needs one observation; for N of them use observe_many")
        feedback = self.observe_many(observation[np.newaxis])
        return Feedback(feedback.error[0], feedback.allocated[0])

    def observe_many(self, observations: PointObservation) -> Feedback:
        """The same for N, in order: the same result as one by one."""
        if observations.joints.ndim != 2:
            raise InvalidInput("observe_many needs a leading axis; for one observation use observe")
        rows = self.robot.seen_rows(observations)
        errors = np.empty((len(rows), 3))
        at = 0
        while at < len(rows):
            due = max(_FIRST, int(np.ceil(_MORE * self._fitted))) - self.n_observations
            some = slice(at, at + max(due, 1))
            errors[some] = self.robot.errors(self._acting, rows[some])
            self._seen.append(rows[some])
            at += len(rows[some])
            if due <= len(rows[some]):
                self._settle()
        return Feedback(errors, np.zeros(len(rows), np.bool_))

    def errors(self, observations: PointObservation) -> Array:
        """Errors (N, 3) [m] on N observations, learning nothing."""
        self._settle()
        return self.robot.errors(self._acting, self.robot.seen_rows(observations))

    def command(self, target: PointTarget) -> Array:
        """Joint commands (encoder readings) for one target or N."""
        self._settle()
        rows = self.robot.target_rows(target)
        if rows.ndim == 1:
            return self.robot.commands(self._acting, rows[np.newaxis])[0]
        return self.robot.commands(self._acting, rows)

    def restore(self, seen: Array, x: Array) -> None:
        """Go on from observations (N, w) and the estimate (n_x,) that came of them.

        Raises:
            InvalidInput: for other shapes.
        """
        if seen.shape[1:] != (self.robot.chain.n_seen,) or x.shape != self._acting.x.shape:
            raise InvalidInput(f"{seen.shape} and {x.shape} are not what this arm learns from")
        self._seen = [seen]
        if len(seen):
            self.robot.hold_curves(seen)
        self._posterior = None
        self._acting = self._with(x)
        self._fitted = len(seen)

    def __repr__(self) -> str:
        """How much was observed, and how many unknowns there are."""
        curves = len(self.names) - joint_at(self.robot.kernel, len(self.robot.kernel.slides))
        return (
            f"ArmEstimator({self.n_observations} observations, {len(self.names)} unknowns, "
            f"{curves} of them of error curves)"
        )

    def _settle(self) -> None:
        """Fit what was not fitted yet."""
        n = self.n_observations
        if n in {0, self._fitted} and (n == 0 or self._posterior is not None):
            return
        self.robot.hold_curves(self.seen)
        system = LogSystem(self.robot.kernel, self.robot.chain.tolerance, self.seen)
        self._posterior = solve(system)
        self._acting = self._with(self._posterior.x)
        self._fitted = n

    def _with(self, x: Array) -> Acting:
        return Acting(x, None, self.robot.settings.envelope)
