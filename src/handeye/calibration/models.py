"""What is known of a robot before it learns, in the form that a correction can be added to."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from handeye.arrays import Array
from handeye.calibration.plant import PlanarPlant
from handeye.geometry.angles import wrap
from handeye.networks.inputs import InputSpace
from handeye.observations import Observation, StereoObservation, StereoTarget, Target

O_contra = TypeVar("O_contra", bound=Observation, contravariant=True)
T_contra = TypeVar("T_contra", bound=Target, contravariant=True)

Correct = Callable[[Array], Array]
"""Network inputs (N, d) to corrections (N, m)."""


class HandEyeModel(Protocol[O_contra, T_contra]):
    """Nominal kinematics of arm and eye, and where a learned correction enters them.

    All methods work on N observations or targets at a time.
    """

    @property
    def space(self) -> InputSpace:
        """The space of the correction's inputs, d of them."""
        ...

    @property
    def n_outputs(self) -> int:
        """Components of a correction, m."""
        ...

    @property
    def resolution(self) -> float:
        """Errors of a correction below this, in its own units, are not worth learning."""
        ...

    def features(self, observations: O_contra) -> Array:
        """Inputs (N, d) of the correction for observations."""
        ...

    def needed(self, observations: O_contra) -> Array:
        """The corrections (N, m) that would have been right for observations."""
        ...

    def displacement(self, observations: O_contra, errors: Array) -> Array:
        """How far, (N, k) [m], the hand is off when corrections are wrong by errors (N, m)."""
        ...

    def command(self, targets: T_contra, correct: Correct) -> Array:
        """Joint commands (N, n) for targets, with corrections asked of `correct` as needed."""
        ...


AnyModel = HandEyeModel[Any, Any]


@dataclass(frozen=True)
class PlanarModel:
    """The planar arm and stereo head with nominal parameters (figure 3.5).

    Inputs: nominal arm angles alpha and beta, pointing angle, range, and, unless the head foveates,
    eccentricity. Corrections: the two joint angles, measured minus nominal [rad].
    """

    nominal: PlanarPlant
    foveate: bool = False
    resolution: float = 1e-3

    @property
    def space(self) -> InputSpace:
        """The box of the thesis's arm and head, in radians and metres."""
        alpha = beta = 0.8 * np.pi
        far = self.nominal.arm.reach + float(np.hypot(self.nominal.v_x, self.nominal.v_y))
        half_field = 0.5 * self.nominal.head.field_of_view
        low, high = [-alpha, -beta, -np.pi, 0.0], [alpha, beta, np.pi, far]
        seen = [] if self.foveate else [half_field]
        return InputSpace.box(low + [-e for e in seen], high + seen)

    @property
    def n_outputs(self) -> int:
        """Alpha and beta."""
        return 2

    def features(self, observations: StereoObservation) -> Array:
        """(N, 5), or (N, 4) when foveating."""
        return self._inputs(observations.target)

    def needed(self, observations: StereoObservation) -> Array:
        """Measured minus nominal joint angles (N, 2), on the circle (note E2)."""
        return wrap(observations.joints - self.nominal.joints_for(observations.target))

    def displacement(self, observations: StereoObservation, errors: Array) -> Array:
        """Nominal hand displacement (N, 2) between the measured joints and the ones commanded."""
        here = self.nominal.tips(observations.joints)
        return here - self.nominal.tips(observations.joints - errors)

    def command(self, targets: StereoTarget, correct: Correct) -> Array:
        """Nominal angles plus correction (N, 2)."""
        return wrap(self.nominal.joints_for(targets) + correct(self._inputs(targets)))

    def _inputs(self, targets: StereoTarget) -> Array:
        nominal = self.nominal.joints_for(targets)
        seen = [nominal[..., 0], nominal[..., 1], targets.pointing, targets.range]
        return np.stack(seen if self.foveate else [*seen, targets.eccentricity], axis=-1)


@dataclass(frozen=True)
class PlanarMap:
    """The same robot without kinematics: the whole hand-eye map is left to learn (section 3.5.9).

    Inputs: range, pointing angle, eccentricity and the elbow's side (+1 or -1). The correction is
    the joint angles themselves. The plant is used only to state errors in metres.
    """

    nominal: PlanarPlant
    resolution: float = 1e-3

    @property
    def space(self) -> InputSpace:
        """The box of the thesis's head, in metres, radians and the elbow's sign."""
        far = self.nominal.arm.reach + float(np.hypot(self.nominal.v_x, self.nominal.v_y))
        half_field = 0.5 * self.nominal.head.field_of_view
        return InputSpace.box([0.0, -np.pi, -half_field, -1.0], [far, np.pi, half_field, 1.0])

    @property
    def n_outputs(self) -> int:
        """Alpha and beta."""
        return 2

    def features(self, observations: StereoObservation) -> Array:
        """(N, 4)."""
        return self._inputs(observations.target)

    def needed(self, observations: StereoObservation) -> Array:
        """The measured joint angles (N, 2)."""
        return observations.joints

    def displacement(self, observations: StereoObservation, errors: Array) -> Array:
        """As PlanarModel."""
        return PlanarModel(self.nominal).displacement(observations, errors)

    def command(self, targets: StereoTarget, correct: Correct) -> Array:
        """Whatever was learned (N, 2)."""
        return correct(self._inputs(targets))

    def _inputs(self, targets: StereoTarget) -> Array:
        return np.stack(
            [targets.range, targets.pointing, targets.eccentricity, targets.elbow], axis=-1
        )
