"""What a robot sees of its own hand, and where it is asked to reach.

Every type holds one observation (fields without a leading axis) or N of them (fields with a
leading axis N); `observations[i]` and slices pick from N. Units are metres, radians and seconds.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Self

import numpy as np

from handeye.arrays import Array, finite
from handeye.errors import InvalidInput


@dataclass(frozen=True, eq=False)
class _Batch:
    """Frozen fields that share one leading axis, or have none; checked when made.

    Each class names the shape that follows the leading axis in `_SHAPES`: () for numbers, (3,) for
    vectors of three, (None,) for vectors of any length. Raises InvalidInput for values that are not
    finite real numbers or do not fit together.
    """

    _SHAPES: ClassVar[dict[str, tuple[int | None, ...]]] = {}

    def __post_init__(self) -> None:
        kind = type(self).__name__
        leads: dict[str, tuple[int, ...]] = {}
        for field in fields(self):
            if getattr(self, field.name) is None and field.default is None:
                continue
            array = finite(getattr(self, field.name), field.name)
            object.__setattr__(self, field.name, array)
            lead = _leading_axes(array.shape, self._SHAPES[field.name])
            if lead is None:
                wanted = [width or "n" for width in self._SHAPES[field.name]]
                one, many = (", ".join(map(str, shape)) for shape in (wanted, ["N", *wanted]))
                raise InvalidInput(
                    f"{field.name} must have shape ({one}) for one {kind} or ({many}) for N, "
                    f"got {array.shape}"
                )
            leads[field.name] = lead
        if len(set(leads.values())) > 1:
            lengths = ", ".join(f"{n} {lead[0] if lead else 'one'}" for n, lead in leads.items())
            raise InvalidInput(f"the fields of {kind} differ in number: {lengths}")

    def __len__(self) -> int:
        name = fields(self)[0].name
        first: Array = getattr(self, name)
        if first.ndim == len(self._SHAPES[name]):
            raise TypeError(f"a single {type(self).__name__} has no length")
        return len(first)

    def __getitem__(self, index: Any) -> Self:
        values = ((f.name, getattr(self, f.name)) for f in fields(self))
        return type(self)(**{name: v if v is None else v[index] for name, v in values})

    def __iter__(self) -> Iterator[Self]:
        return (self[i] for i in range(len(self)))


def _leading_axes(have: tuple[int, ...], want: tuple[int | None, ...]) -> tuple[int, ...] | None:
    """() or (N,), what comes before the wanted shape; None if the shape is another."""
    split = len(have) - len(want)
    fits = 0 <= split <= 1 and all(
        w is None or w == h for w, h in zip(want, have[split:], strict=True)
    )
    return have[:split] if fits else None


@dataclass(frozen=True, eq=False)
class StereoTarget(_Batch):
    """A thing seen by a stereo head on a pointing axis, to be reached with a given elbow.

    pointing      encoder reading of the pointing axis, gamma_meas [rad], ()  or (N,)
    range         measured range r_meas [m]
    eccentricity  measured angle from the pointing axis eps_meas [rad]
    elbow         sign of beta: +1 or -1; which of the two arm solutions to use
    """

    _SHAPES: ClassVar[dict[str, tuple[int | None, ...]]] = {
        "pointing": (),
        "range": (),
        "eccentricity": (),
        "elbow": (),
    }

    pointing: Array
    range: Array
    eccentricity: Array
    elbow: Array

    def __post_init__(self) -> None:
        super().__post_init__()
        if not np.all(np.abs(self.elbow) == 1.0):
            raise InvalidInput(f"elbow must be 1 or -1, the sign of beta, got {self.elbow}")


@dataclass(frozen=True, eq=False)
class StereoObservation(_Batch):
    """The hand of a planar arm seen by a stereo head, with every encoder read at that moment.

    time    [s] or trial number, () or (N,)
    joints  encoder readings (alpha_meas, beta_meas) [rad], (2,) or (N, 2)
    The other fields are those of StereoTarget.
    """

    _SHAPES: ClassVar[dict[str, tuple[int | None, ...]]] = {
        "time": (),
        "joints": (2,),
        "pointing": (),
        "range": (),
        "eccentricity": (),
    }

    time: Array
    joints: Array
    pointing: Array
    range: Array
    eccentricity: Array

    @property
    def target(self) -> StereoTarget:
        """The sighting as a thing to reach again, with the elbow the arm had."""
        elbow = np.where(self.joints[..., 1] >= 0.0, 1.0, -1.0)
        return StereoTarget(self.pointing, self.range, self.eccentricity, elbow)


@dataclass(frozen=True, eq=False)
class PointTarget(_Batch):
    """A point to bring the marker to, in the sensor's frame.

    position  [m], (3,) or (N, 3)
    posture   joint angles to stay near, which choose one of the arm's solutions [rad],
              (n,) or (N, n)
    """

    _SHAPES: ClassVar[dict[str, tuple[int | None, ...]]] = {
        "position": (3,),
        "posture": (None,),
    }

    position: Array
    posture: Array


@dataclass(frozen=True, eq=False)
class PointObservation(_Batch):
    """A marker on the hand located by a camera or tracker, with the joints at that moment.

    time          [s], () or (N,)
    joints        encoder readings [rad], (n,) or (N, n)
    position      marker in the sensor's frame [m], (3,) or (N, 3)
    orientation   marker in the sensor's frame as a unit quaternion wxyz, (4,) or (N, 4), or None
    position_std  standard deviation of each component [m], (3,) or (N, 3), or None
    """

    _SHAPES: ClassVar[dict[str, tuple[int | None, ...]]] = {
        "time": (),
        "joints": (None,),
        "position": (3,),
        "orientation": (4,),
        "position_std": (3,),
    }

    time: Array
    joints: Array
    position: Array
    orientation: Array | None = None
    position_std: Array | None = None

    @property
    def target(self) -> PointTarget:
        """The sighting as a point to reach again from the same posture."""
        return PointTarget(self.position, self.joints)


Observation = StereoObservation | PointObservation
Target = StereoTarget | PointTarget
