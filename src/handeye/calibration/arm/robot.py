"""A serial arm: its chain, its commands, and how they miss."""

from typing import Any

import numpy as np

from handeye.arrays import Array, shaped
from handeye.calibration.arm.acting import ARRIVED, Bounds, predicted, predicted_many, seek_many
from handeye.calibration.arm.chain import arm_chain
from handeye.calibration.arm.corrected import CorrectedArm, corrected
from handeye.calibration.arm.description import (
    describe,
    ends_of,
    expected_rows,
    seen_rows,
    target_rows,
)
from handeye.calibration.arm.residuals import measured_at
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.engine.robot import Acting, Judged
from handeye.calibration.engine.settings import Hypothesis, Settings
from handeye.calibration.placed_arm import PlacedArm
from handeye.errors import InvalidInput
from handeye.observations import PointObservation, PointTarget
from handeye.randomness import stream

SETTINGS = Settings(
    hypotheses=(
        Hypothesis("steady, with error curves"),
        Hypothesis("drifting at its base or marker, with error curves", walk=1e-4, memory=10_000.0),
    ),
    odds=1e9,
    envelope=0.2,
    patience=8,
)
"""How arms are learned by default."""
_REACHED = 1e-5  # [m], below what sensors resolve: good enough where the arm is nearly stretched
_ROUNDS = 6


class ArmRobot:
    """Implements `Robot` for an arm of a URDF file seen by a sensor that stands still.

    Args:
        model: nominal kinematics, placed; its `turn_std` says whether orientations are seen.
        sheet: how far the arm may be from nominal.
    """

    def __init__(self, model: PlacedArm, sheet: ArmSheet) -> None:
        self.model = model
        self.arm: Any = model.arm
        stages = self.arm.stages()
        kernel = describe(
            self.arm, model.placement, sheet.curves.table(stages.slides),
            turn_std=model.turn_std, compliant=sheet.compliance > 0.0, ends=sheet.curves.ends(),
        )  # fmt: skip
        self.kernel = kernel
        self.chain = arm_chain(kernel, self.arm.stage_names, sheet)
        self.doubt = (max(sheet.unexplained, model.noise), sheet.resolution)
        self.settings = SETTINGS
        self.space = model.space
        self.n_outputs = 3
        self._stages = stages
        self._n = len(model.arm.joint_names)

    def hold_curves(self, rows: Array) -> None:
        """From now on, beyond where joints stood in rows (N, w), curves keep the edge's value."""
        low, high = ends_of(self.kernel, rows)
        self.kernel = self.kernel._replace(low=low, high=high)

    def seen_rows(self, observations: PointObservation) -> Array:
        """One observation (w,) or N (N, w)."""
        if self.kernel.oriented and observations.orientation is None:
            raise InvalidInput(
                "this model expects measured orientations (its turn_std says how accurate they "
                "are): observe with orientations, or calibrate from positions alone"
            )
        return seen_rows(self.kernel, self.arm, observations)

    def target_rows(self, target: PointTarget) -> Array:
        """The same of targets, at their postures."""
        return target_rows(self.kernel, self.arm, target)

    def posed_rows(self, rows: Array, joints: Array) -> Array:
        """Targets with joints, and the loads there."""
        posed = rows.copy()
        posed[:, : self._n] = joints
        if self.kernel.compliant:
            posed[:, self._n : measured_at(self.kernel)] = self.arm.loads(joints)
        return posed

    def judge(self, x: Array, row: Array, envelope: float) -> Judged:
        """Measured minus predicted positions, nominal and learned."""
        places = np.empty((2, 3))
        predicted(self.kernel, x, np.zeros(3), row, envelope, places)
        joints = row[: self._n]
        return Judged(self._measured(row) - places, np.stack([joints, joints]))

    def inputs(self, row: Array, judged: Judged) -> Array:  # noqa: ARG002
        """Joints."""
        return row[: self._n]

    def explained(self, row: Array, shift: Array) -> Array:
        """The row with another measured position."""
        explained = row.copy()
        self._measured(explained)[:] -= shift
        return explained

    def errors(self, acting: Acting, rows: Array) -> Array:
        """Measured minus predicted positions (N, 3)."""
        places = np.empty((len(rows), 3))
        extra = self._extra(acting, rows)
        predicted_many(self.kernel, acting.x, extra, rows, acting.envelope, places)
        return self._measured(rows) - places

    def commands(self, acting: Acting, rows: Array) -> Array:
        """Joints (N, n) within limits, near the postures of targets, whose prediction is there.

        Raises:
            InvalidInput: naming the targets that cannot be reached from their postures.
        """
        goals, missed = np.ascontiguousarray(self._measured(rows)), np.empty(len(rows))
        posed = rows.copy()
        arm = self.arm
        bounds = Bounds(arm.lower, arm.upper, arm.held, acting.envelope, arm.reach)
        # Loads and network follow the joints, which they hardly change.
        for _ in range(_ROUNDS):
            before = posed[:, : self._n].copy()
            extra = self._extra(acting, posed)
            seek_many(self.kernel, acting.x, extra, goals, bounds, posed, missed)
            joints = posed[:, : self._n].copy()
            posed = self.posed_rows(posed, joints)
            if np.max(np.abs(joints - before), initial=0.0) * self.arm.reach < ARRIVED:
                break
        far = np.flatnonzero(~(missed <= _REACHED))
        if far.size:
            listed = ", ".join(f"{i + 1} (by {missed[i]:.3g} m)" for i in far[:5])
            more = f" and {far.size - 5} more" if far.size > 5 else ""
            raise InvalidInput(
                f"{self.arm.name} cannot bring the marker to target {listed}{more}: it is out of "
                "reach or beyond a joint limit; give a position in reach or a posture nearer to it"
            )
        return posed[:, : self._n].copy()

    def candidates(self, x: Array, region: Any, n: int) -> tuple[Array, Array]:
        """Poses of a region: joints (C, n) to choose from; by default n of the working range."""
        if region is None:
            low = np.maximum(self.model.low, self.model.arm.lower)
            high = np.minimum(self.model.high, self.model.arm.upper)
            joints = stream("combined: candidates", n).uniform(low, high, (n, self._n))
        else:
            joints = shaped(region, (None, self._n), "region (joints to choose from)")
        rows = expected_rows(self.kernel, self.arm, x, joints)
        return np.column_stack([joints, np.zeros(len(joints))]), rows

    def corrected(self, x: Array) -> CorrectedArm:
        """The arm with constants of x."""
        return corrected(self.kernel, self._stages, x)

    def _measured(self, rows: Array) -> Array:
        at = measured_at(self.kernel)
        return rows[..., at : at + 3]

    def _extra(self, acting: Acting, rows: Array) -> Array:
        if acting.correct is None:
            return np.zeros((len(rows), 3))
        return np.ascontiguousarray(acting.correct(rows[:, : self._n]))
