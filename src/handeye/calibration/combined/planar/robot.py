"""The planar robot: its chain, its commands, and how they miss."""

from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.calibration.combined.planar.acting import act_many, judge, missed
from handeye.calibration.combined.planar.chain import planar_chain, seen_rows, target_rows
from handeye.calibration.combined.planar.kernels import PARAMETERS
from handeye.calibration.combined.planar.sheet import DataSheet
from handeye.calibration.combined.planar.suggesting import sightings_of
from handeye.calibration.engine.robot import Acting, Judged
from handeye.calibration.engine.settings import Settings
from handeye.calibration.estimation.parameters import plant_with
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.world import Region
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap
from handeye.observations import StereoObservation, StereoTarget


class PlanarRobot:
    """Implements `Robot` for a planar arm and a stereo head on a pointing axis.

    Args:
        model: nominal kinematics; its head says how noisy sightings are.
        sheet: how far the robot may be from nominal.

    Raises:
        InvalidInput: a nominal plant that drifts.
    """

    def __init__(self, model: PlanarModel, sheet: DataSheet) -> None:
        self.model = model
        self.chain = planar_chain(model, sheet)
        self.doubt = (sheet.unexplained, sheet.resolution)
        self.settings = Settings()
        # The network is told everything, also of a head that foveates.
        self.space = PlanarModel(model.nominal).space
        self.n_outputs = 2

    def seen_rows(self, observations: StereoObservation) -> Array:
        """One observation (5,) or N (N, 5)."""
        return seen_rows(observations)

    def target_rows(self, target: StereoTarget) -> Array:
        """The same of targets: joints are only told by the elbow."""
        return target_rows(target)

    def posed_rows(self, rows: Array, joints: Array) -> Array:
        """Targets with joints."""
        posed = rows.copy()
        posed[:, :2] = joints
        return posed

    def judge(self, x: Array, row: Array, envelope: float) -> Judged:
        """Misses by nominal kinematics, as for every other calibrator."""
        joints, misses = np.empty((2, 2)), np.empty((2, 2))
        judge(self.chain.kernel, x, row, envelope, joints, misses)
        return Judged(misses, joints)

    def inputs(self, row: Array, judged: Judged) -> Array:
        """Learned command and sighting (5,)."""
        return np.concatenate([judged.joints[1], row[2:]])

    def explained(self, row: Array, shift: Array) -> Array:
        """The row with the joints that would have brought the hand there without the shift."""
        explained = row.copy()
        explained[:2] += self._turned(row[:2], -shift)
        return explained

    def errors(self, acting: Acting, rows: Array) -> Array:
        """Misses (N, 2) of the commands for sightings of the hand."""
        targets = rows.copy()
        targets[:, 0], targets[:, 1] = 0.0, np.where(rows[:, 1] >= 0.0, 1.0, -1.0)
        out = np.empty((len(rows), 2))
        for i, joints in enumerate(self.commands(acting, targets)):
            missed(self.chain.kernel, rows[i], joints, out[i])
        return out

    def commands(self, acting: Acting, rows: Array) -> Array:
        """Readings (N, 2) for sightings (N, 5)."""
        joints = self._acted(acting, np.zeros((len(rows), 2)), rows)
        if acting.correct is None:
            return joints
        shifts = acting.correct(np.concatenate([joints, rows[:, 2:]], axis=1))
        return self._acted(acting, self._turned(joints, shifts), rows)

    def candidates(self, x: Array, region: Any, n: int) -> tuple[Array, Array]:
        """Poses of a `Region`, by default all of the robot's."""
        where = Region() if region is None else region
        if not isinstance(where, Region):
            raise InvalidInput(f"the planar robot works in a Region, got {region!r}")
        return sightings_of(self.chain.kernel, x, where, n)

    def corrected(self, x: Array) -> PlanarPlant:
        """The nominal plant with the estimated parameters."""
        return plant_with(self.model.nominal, (self.chain.nominal + x)[:PARAMETERS])

    def _turned(self, joints: Array, shifts: Array) -> Array:
        """Changes of joints (..., 2) that shift the nominal hand (..., 2) [m], within reach."""
        arm = self.model.nominal.arm
        moved = arm.inverse(arm.tips(joints) + shifts, np.where(joints[..., 1] < 0.0, -1.0, 1.0))
        return wrap(moved - joints)

    def _acted(self, acting: Acting, extra: Array, rows: Array) -> Array:
        joints, held = np.empty((len(rows), 2)), np.zeros(len(rows), np.bool_)
        act_many(self.chain.kernel, acting.x, extra, rows, acting.envelope, joints, held)
        return joints
