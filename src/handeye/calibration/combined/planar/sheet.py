"""How far a robot may be from its nominal model, as a data sheet states it."""

from dataclasses import dataclass, fields

from handeye.arrays import scalar


@dataclass(frozen=True)
class DataSheet:
    """Manufacturing tolerances of a planar hand-eye robot, as standard deviations.

    link             lengths of the arm's links [m]
    eye              place of the eye and its pointing axis [m]
    offset           zeros of the three encoders [rad]
    range_scale      factor on every range, a number
    joint_curve      error of an arm joint over its own angle: eccentric gears, encoder disc [rad]
    joint_length     angle over which that error changes its course [rad]; a gear that is eccentric
                     once a turn has a little more than one
    pointing_curve   the same of the pointing axis [rad]
    pointing_length  shorter, since a traction drive turns several times for one turn of the eye
    ripple           fine structure of every joint curve, over a third of a radian [rad]
    lens             distortion of a measured eccentricity at the edge of the field [rad]
    range_curve      range error that no scale explains, over the span of ranges [m]
    unexplained      what the model leaves over, at first: [rad], and [m] of range. Adjusted by what
                     is seen, never below `resolution`
    resolution       the least of it [rad], [m]

    The defaults are those of a robot put together with a tape measure and a protractor.

    Raises InvalidInput unless all are positive.
    """

    link: float = 0.02
    eye: float = 0.05
    offset: float = 0.1
    range_scale: float = 0.2
    joint_curve: float = 1e-2
    joint_length: float = 1.2
    pointing_curve: float = 1e-2
    pointing_length: float = 0.7
    ripple: float = 5e-4
    lens: float = 3e-3
    range_curve: float = 8e-3
    unexplained: float = 3e-5
    resolution: float = 1e-5

    def __post_init__(self) -> None:
        for field in fields(self):
            scalar(getattr(self, field.name), f"data sheet: {field.name}", above=0.0)
