"""Commands that bring what a link carries to where a sensor of a set-up wants it."""

from typing import TypeVar

import numpy as np

from handeye.arrays import Array, Integers, shaped
from handeye.calibration.arm.acting import ARRIVED
from handeye.calibration.arm.measurements import Frame, Instrument
from handeye.calibration.arm.robot import SETTINGS
from handeye.calibration.hand_eye.turns import cross_matrix
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.knowledge import carried, looks
from handeye.errors import InvalidInput
from handeye.geometry import transform
from handeye.observations import PointTarget

BASE = "base"
"""What stands for the frame of the base, beside the names of sensors."""

_ITERATIONS = 200
_REACHED = 1e-5  # [m], below what sensors resolve: good enough where the arm is nearly stretched
_DAMPING = 1e-3  # of the reach: limits the step near singular postures
_LARGEST_STEP = 0.3  # [rad] or [m], so that the arm stays on the side of its posture

Thing = TypeVar("Thing")


class SetupCommands:
    """Joint commands of a calibrated set-up.

    The chain that moves is the one between the link on which the sensor sits and the link that
    carries the marker, whether it was measured as such or not. Joints that move the sensor stay
    where the posture of a target has them.

    Args:
        fit: arm and set-up as found.
        sensor: in whose frame targets are given: of a tracker, of a camera on a stand or on a head
            that moves, or "base". By default the first that looks at what a flange carries, or
            else the base.
        marker: name of what a link carries and is to be brought there; by default what that sensor
            sees.

    Raises:
        InvalidInput: a name that is not there, or a marker that no joint moves against the sensor.
    """

    def __init__(self, fit: MixedFit, sensor: str | None = None, marker: str | None = None) -> None:
        arm = fit.problem.arm
        still = [one for one in fit.measurements if one.sight.setup == "eye_to_hand"]
        if not still:
            raise InvalidInput(
                "nothing that the flange carries was measured from outside, so that there is "
                "nothing to bring anywhere: in this set-up the flange carries the sensors"
            )
        seen = [one for one in still if sensor in {None, one.sight.sensor.name} and looks(one)]
        first = (seen or still)[0]
        sensor = sensor or (first.sight.sensor.name if seen else BASE)
        marker = marker or _carried_name(first)
        points = {_carried_name(one): (one.link or arm.tip, carried(one)) for one in still}
        link, self._point = _named("marker", marker, points)
        frames = {BASE: (arm.base, Frame.known())}
        for one in filter(looks, fit.measurements):
            on = one.link or arm.tip
            if one.sight.setup == "eye_to_hand":
                on = one.base or arm.base
            if on != link:
                frames[one.sight.sensor.name] = (on, one.sight.sensor)
        base, self._frame = _named("sensor", sensor, frames)
        self.sensor, self.marker, self._fit = sensor, marker, fit
        self._arm = arm.between(link, base)
        self.joint_names = self._arm.joint_names

    def command(self, targets: PointTarget) -> Array:
        """Encoder readings (N, n) for N targets in the sensor's frame.

        Damped Gauss-Newton from the posture of each, `dq = J^T (J J^T + damping^2)^-1 e`, within
        limits, with the Jacobian of the nominal arm: that of the arm as found is little other.

        Raises:
            InvalidInput: naming the targets that cannot be reached from their postures.
        """
        arm = self._arm
        goals = transform(self._frame.reference, targets.position)
        q = shaped(targets.posture, (len(goals), len(self.joint_names)), "posture").copy()
        free = ~arm.held
        missed, going = np.full(len(q), np.inf), np.arange(len(q))
        for _ in range(_ITERATIONS):
            q[:, free] = np.clip(q[:, free], arm.lower[free], arm.upper[free])
            nominal, places = self._places(q[going])
            errors = goals[going] - places
            missed[going] = np.linalg.norm(errors, axis=1)
            far = missed[going] > ARRIVED
            going = going[far]
            if not going.size:
                break
            by = arm.jacobians(q[going])
            lever = cross_matrix((nominal[:, :3, :3] @ self._point)[far])
            J = (by[:, :3] - lever @ by[:, 3:]) * free
            square = J @ J.swapaxes(1, 2) + (_DAMPING * arm.reach) ** 2 * np.eye(3)
            step = np.linalg.solve(square, errors[far][..., np.newaxis])
            step = (J.swapaxes(1, 2) @ step)[..., 0]
            most = np.max(np.abs(step), axis=1, keepdims=True)
            q[going] += step * np.minimum(1.0, _LARGEST_STEP / np.maximum(most, ARRIVED))
        _refuse(arm.name, np.flatnonzero(~(missed <= _REACHED)), missed)
        return q

    def _places(self, joints: Array) -> tuple[Array, Array]:
        """Nominal T_base_link (N, 4, 4), and where the marker is in the base's frame (N, 3).

        As found, but no farther from nominal than any correction may bring it.
        """
        arm = self._arm
        nominal = arm.poses(joints)
        before = transform(nominal, self._point)
        learned = transform(self._fit.flanges(joints, arm.tip, arm.base), self._point)
        size = np.linalg.norm(learned - before, axis=1, keepdims=True)
        part = np.minimum(1.0, SETTINGS.envelope / np.maximum(size, ARRIVED))
        return nominal, before + part * (learned - before)


def _refuse(arm: str, far: Integers, missed: Array) -> None:
    if far.size:
        listed = ", ".join(f"{i + 1} (by {missed[i]:.3g} m)" for i in far[:5])
        more = f" and {far.size - 5} more" if far.size > 5 else ""
        raise InvalidInput(
            f"{arm} cannot bring the marker to target {listed}{more}: it is out of reach or beyond "
            "a joint limit; give a position in reach or a posture nearer to it"
        )


def _named(what: str, name: str, known: dict[str, Thing]) -> Thing:
    if name not in known:
        raise InvalidInput(f"no {what} is called {name}: choose from {', '.join(known)}")
    return known[name]


def _carried_name(one: Instrument) -> str:
    """Of a target that is a frame of its own, or of a point of the flange."""
    target = one.sight.target
    return one.sight.points.name if target.name == Frame.known().name else target.name
