"""What the rest of the package needs to know of an arm: a chain of joints from base to flange."""

from typing import Protocol

from handeye.arrays import Array, Booleans


class Arm(Protocol):
    """Forward kinematics of a serial arm with n joints."""

    @property
    def name(self) -> str:
        """For messages and reports."""
        ...

    @property
    def joint_names(self) -> tuple[str, ...]:
        """In the order of every joint array, base first."""
        ...

    @property
    def lower(self) -> Array:
        """Lower joint limits (n,) [rad] or [m], -inf where there is none."""
        ...

    @property
    def upper(self) -> Array:
        """Upper joint limits (n,) [rad] or [m], inf where there is none."""
        ...

    @property
    def held(self) -> Booleans:
        """(n,) which joints stay where they are when the marker is brought to a place."""
        ...

    @property
    def reach(self) -> float:
        """Upper bound of the distance from the base's origin to the flange's [m]."""
        ...

    def poses(self, joints: Array) -> Array:
        """T_base_flange (N, 4, 4) at joints (N, n)."""
        ...

    def jacobians(self, joints: Array) -> Array:
        """Velocity of the flange per joint velocity, (N, 6, n), at joints (N, n).

        Rows 0-2 are the linear velocity of the flange's origin [m/rad], rows 3-5 the angular
        velocity [rad/rad], both in the axes of the base.
        """
        ...
