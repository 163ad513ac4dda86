"""Commands that bring what the flange carries to where a sensor of a set-up wants it."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.arm.measurements import Frame, Instrument
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.engine.robot import Acting
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import Placement
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.knowledge import carried, looks
from handeye.errors import InvalidInput
from handeye.geometry import invert, make_pose
from handeye.observations import PointTarget

BASE = "base"
"""What stands for the frame of the base, beside the names of sensors."""


class SetupCommands:
    """Joint commands of a calibrated set-up.

    Args:
        fit: arm and set-up as found.
        sensor: in whose frame targets are given: of a tracker, of a camera on a stand, or "base".
            By default the first that looks and does not move, or else the base.
        marker: name of what the flange carries and is to be brought there; by default what that
            sensor sees.

    Raises:
        InvalidInput: a name that is not there.
    """

    def __init__(self, fit: MixedFit, sensor: str | None = None, marker: str | None = None) -> None:
        still = [one for one in fit.measurements if one.sight.setup == "eye_to_hand"]
        eyes = [one for one in still if looks(one)]
        frames = {BASE: Frame.known()} | {one.sight.sensor.name: one.sight.sensor for one in eyes}
        points = {_carried_name(one): carried(one) for one in still}
        if not still:
            raise InvalidInput(
                "nothing that the flange carries was measured from outside, so that there is "
                "nothing to bring anywhere: in this set-up the flange carries the sensors"
            )
        first = next((one for one in eyes if sensor in {None, one.sight.sensor.name}), still[0])
        sensor = sensor or (first.sight.sensor.name if looks(first) else BASE)
        marker = marker or _carried_name(first)
        for what, name, known in (("sensor", sensor, frames), ("marker", marker, points)):
            if name not in known:
                raise InvalidInput(f"no {what} is called {name}: choose from {', '.join(known)}")
        joints = np.concatenate([one.joints for one in fit.given])
        at = make_pose(np.eye(3), points[marker])
        placement = Placement(invert(frames[sensor].reference), at)
        arm = fit.problem.arm
        model = PlacedArm(arm, placement, joints.min(axis=0), joints.max(axis=0))
        self.sensor, self.marker = sensor, marker
        self.joint_names = arm.joint_names
        self._robot = ArmRobot(model, fit.sheet)
        frames_of_kernel = len(self._robot.chain.names) - fit.problem.n_arm
        x = np.concatenate([np.zeros(frames_of_kernel), fit.posterior.x[: fit.problem.n_arm]])
        self._acting = Acting(x, None, self._robot.settings.envelope)

    def command(self, targets: PointTarget) -> Array:
        """Encoder readings (N, n) for N targets in the sensor's frame.

        Raises:
            InvalidInput: naming the targets that cannot be reached from their postures.
        """
        return self._robot.commands(self._acting, self._robot.target_rows(targets))


def _carried_name(one: Instrument) -> str:
    """Of a target that is a frame of its own, or of a point of the flange."""
    target = one.sight.target
    return one.sight.points.name if target.name == Frame.known().name else target.name
