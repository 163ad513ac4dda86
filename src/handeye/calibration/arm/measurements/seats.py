"""What each frame and point of a fit is fixed to: a link of the robot, or another frame."""

from collections.abc import Sequence

from handeye.calibration.arm.measurements.positions import Touches
from handeye.calibration.arm.measurements.seeing import Instrument
from handeye.calibration.arm.measurements.unknowns import Frame, Unknown
from handeye.errors import InvalidInput
from handeye.robots.urdf import UrdfArm

_ITSELF = Frame.known().name


def seats(arm: UrdfArm, instruments: Sequence[Instrument]) -> dict[str, str]:
    """By name, the link or the frame in which each frame and each unknown point is.

    Raises:
        InvalidInput: two of one name are fixed to different things.
    """
    found: dict[str, str] = {}
    for one in instruments:
        for unknown, seat in _seated(arm, one):
            if unknown.name == _ITSELF or not (isinstance(unknown, Frame) or unknown.free.any()):
                continue
            other = found.setdefault(unknown.name, seat)
            if other != seat:
                raise InvalidInput(
                    f"{unknown.name} is fixed to {other} in one measurement and to {seat} in "
                    "another: what has the same name is the same thing; give one another name, or "
                    "say on which link it is"
                )
    return found


def _seated(arm: UrdfArm, one: Instrument) -> list[tuple[Unknown, str]]:
    """The frames and points of an instrument, and where each is."""
    link, base = one.link or arm.tip, one.base or arm.base
    sensor, target, points = one.sight.unknowns
    on, over = (link, base) if one.sight.setup == "eye_in_hand" else (base, link)
    out: list[tuple[Unknown, str]] = [(sensor, on), (target, over)]
    out.append((points, over if target.name == _ITSELF else target.name))
    if isinstance(one, Touches):
        out.append((one.places, on if sensor.name == _ITSELF else sensor.name))
    return out
