"""Where an instrument of a set-up could measure: within the joints' limits, and in its view."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.calibration.arm.measurements import (
    Distances,
    Frame,
    Instrument,
    PixelSightings,
    PlaneContacts,
    StereoSightings,
    Touches,
)
from handeye.calibration.arm.measurements.lens import project, straightened
from handeye.calibration.arm.measurements.sight import carriers
from handeye.calibration.arm.measurements.unknowns import Unknown
from handeye.calibration.setups.fit import MixedFit
from handeye.calibration.setups.knowledge import looks
from handeye.calibration.view import View, turned_away
from handeye.errors import InvalidInput
from handeye.geometry import invert
from handeye.geometry.angles import wrap

# Poses drawn to find so many in view, as a multiple.
_DRAWN = 50
# A lens that bends a point of the picture back to where it is, it does so to within this.
_SAME = 1e-6


def title(one: Instrument) -> str:
    """The name of an instrument, or what it sees and by what."""
    target, points = one.sight.target, one.sight.points
    sensor: Unknown = one.sight.sensor
    if isinstance(one, PixelSightings):
        sensor = one.camera
    elif sensor.name == Frame.known().name and isinstance(one, Touches):
        sensor = one.places
    seen = points if target.name == Frame.known().name else target
    return one.name or f"{seen.name} by {sensor.name}"


def not_free(one: Instrument) -> str | None:
    """Why poses of an instrument cannot be chosen; None where they can."""
    if isinstance(one, Touches | PlaneContacts):
        return "what is touched says where the arm must be"
    if isinstance(one, Distances) and np.ptp(one.measured) == 0.0:
        return "its distance is always the same, and says where the arm must be"
    return None


class FreePoses:
    """Poses at which one instrument of a fit could measure.

    Args:
        fit: arm and set-up as found.
        one: the instrument, as found.
        view: what sensors see, None where nothing is said of it.
        sizes: width and height of cameras' pictures by name; in others pixels stay where some were.
    """

    def __init__(
        self,
        fit: MixedFit,
        one: Instrument,
        view: View | None,
        sizes: Mapping[str, tuple[int, int]],
    ) -> None:
        self.arm = fit.problem.arm.between(one.link, one.base)
        self._fit, self._one, self._sizes = fit, one, sizes
        self._asked = view is not None
        view = view or View()
        # A wire has no axis along which it looks; of a tracker the user knows what its axis is.
        self._view = view if looks(one) else replace(view, half_angle=np.pi)
        self._facing, self._front, self._ahead = np.pi, 1.0, False
        self.oriented = looks(one) and one.sight.target.name != Frame.known().name
        """Whether what is seen has a front."""
        if not looks(one):
            return
        T, s = self._seen(one.joints)
        self._ahead = bool(np.all(s[np.arange(len(s)), one.sight.which, 2] > 0.0))
        if self.oriented:
            away = turned_away(T, 1.0)
            self._front = 1.0 if np.median(away) <= 0.5 * np.pi else -1.0
            # What was seen from one side alone has but one.
            one_sided = np.all(self._front * (0.5 * np.pi - away) > 0.0)
            self._facing = min(view.facing, 0.5 * np.pi if one_sided else np.pi)

    def draw(
        self, n: int, rng: np.random.Generator, *, wider: bool = False
    ) -> tuple[Array, Array | None]:
        """At most n postures (N, m) in view and, of a head on a pan axis, where that stands (N,).

        In the range in which the joints were, half of them between two postures that were measured
        in; or, if `wider`, anywhere within the limits where, unless a view was asked for, what is
        seen comes into the space in which it was seen.

        Raises:
            InvalidInput: no posture in view.
        """
        rows, tried = self._one.joints, _DRAWN * n
        low, high = self._ends(wider=wider)
        q = rng.uniform(low, high, (tried, len(low)))
        if not wider:
            a, b = rows[rng.integers(len(rows), size=(2, tried // 2))]
            share = rng.uniform(size=(len(a), 1))
            q[::2] = np.clip(a + share * (b - a), low, high)
        T, s = self._seen(q)
        good = self._in_view(T, s)
        if wider and not self._asked:
            there = self._seen(rows)[1].reshape(-1, 3)
            good &= np.all((s >= there.min(axis=0)) & (s <= there.max(axis=0)), axis=(1, 2))
        pointing = None
        if isinstance(self._one, StereoSightings):
            pointing, turned = _pointings(self._one, s[:, 0], rng)
            good &= turned
        if not good.any():
            raise InvalidInput(
                f"{title(self._one)}: none of {tried} poses tried is in view; check angles and "
                "distances, and that sensors look along their z axes"
                + ("" if wider else ", or look beyond the working range with --wider")
            )
        return q[good][:n], None if pointing is None else pointing[good][:n]

    def _ends(self, *, wider: bool) -> tuple[Array, Array]:
        """Lowest and highest readings (m,); joints without limits turn half a turn either way."""
        low, high = self._one.joints.min(axis=0), self._one.joints.max(axis=0)
        lower, upper = self.arm.lower, self.arm.upper
        if not wider:
            return np.clip(low, lower, upper), np.clip(high, lower, upper)
        freely = np.isinf(lower) | np.isinf(upper)
        return (
            np.where(freely, np.minimum(low, -np.pi), lower),
            np.where(freely, np.maximum(high, np.pi), upper),
        )

    def _seen(self, joints: Array) -> tuple[Array, Array]:
        """T_sensor_target (N, 4, 4), and its P points in the sensor's frame (N, P, 3)."""
        sight = self._one.sight
        A = self._fit.flanges(joints, self._one.link, self._one.base)
        T = invert(sight.sensor.reference) @ carriers(sight.setup, A) @ sight.target.reference
        points = sight.points.reference
        return T, points @ T[:, :3, :3].swapaxes(1, 2) + T[:, np.newaxis, :3, 3]

    def _in_view(self, T: Array, s: Array) -> Booleans:
        """At which poses (N,) all points can be seen."""
        good = np.asarray(self._view.within(s).all(axis=1), np.bool_)
        if self._ahead:
            good &= np.all(s[:, :, 2] > 0.0, axis=1)
        if self._facing < np.pi:
            good &= turned_away(T, self._front) <= self._facing
        if isinstance(self._one, PixelSightings):
            good[good] = self._in_picture(self._one, s[good])
        return good

    def _in_picture(self, one: PixelSightings, s: Array) -> Booleans:
        """At which poses (N,) all points (N, P, 3), which are ahead, are in the picture."""
        low, high = one.measured.min(axis=0), one.measured.max(axis=0)
        if one.camera.name in self._sizes:
            low, high = np.full(2, -0.5), np.array(self._sizes[one.camera.name]) - 0.5
        flat, numbers = s.reshape(-1, 3), one.camera.reference
        uv, _, _ = project(numbers, flat)
        good = np.asarray(((uv >= low) & (uv <= high)).all(axis=1), np.bool_)
        # Far outside, the polynomial of a lens may turn back into the picture.
        with np.errstate(over="ignore", invalid="ignore"):
            back = straightened(numbers, uv[good])
            good[good] = np.all(np.abs(back - flat[good, :2] / flat[good, 2:]) < _SAME, axis=1)
        return np.asarray(good.reshape(s.shape[:2]).all(axis=1), np.bool_)


def _pointings(one: StereoSightings, s: Array, rng: np.random.Generator) -> tuple[Array, Booleans]:
    """Where the pan axis of a head stands [rad] that sees points (N, 3) as far aside as it has.

    And at which it has stood there (N,).
    """
    low, high = float(one.pointing.min()), float(one.pointing.max())
    aside = rng.choice(one.measured[:, 1], len(s))
    middle = 0.5 * (low + high)
    pointing = middle + wrap(np.arctan2(s[:, 1], s[:, 0]) - aside - middle)
    return pointing, (pointing >= low) & (pointing <= high)
