"""The combined calibrator and its rivals against the least error there can be, as measures."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, replace

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined, floor
from handeye.calibration.drift import Drift, steady
from handeye.calibration.estimation import ParameterEstimator
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import AnyCalibrator, WorldStreams, position_errors
from handeye.calibration.world import PlanarWorld, Region
from handeye.observations import StereoObservation
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Quantities
from handeye.thesis.plants import NOMINAL

RIVALS: dict[str, Callable[[PlanarModel], AnyCalibrator]] = {
    "combined": Combined,
    "network": NetworkCorrection,
    "estimator": ParameterEstimator,
    "nominal": Nominal,
}
"""Every calibrator as a user gets it, with nothing adjusted."""

WITHIN = 1.1
"""Times the floor within which a change counts as corrected."""


@dataclass(frozen=True)
class Combining:
    """Calibrators that start from nominal kinematics on an unknown plant, and the same sightings.

    plant     the actual robot
    rivals    names in RIVALS, the first being the one that is judged
    region    where the hand works
    drift     what becomes of the plant
    outliers  share of sightings in which something else was seen than the hand
    marks     observations after which everyone is tested, ascending
    quoted    marks at which a figure is asked for
    tests     fresh poses of a test, without outliers
    floor     the plant whose floor counts, where the actual one has errors that nobody could
              undo: the same without them
    """

    plant: PlanarPlant
    rivals: tuple[str, ...] = tuple(RIVALS)
    region: Region = Region()
    drift: Drift = steady
    outliers: float = 0.0
    marks: tuple[int, ...] = (0, 10, 20, 30, 50, 100, 200, 300, 500)
    quoted: tuple[int, ...] = ()
    tests: int = 1000
    floor: PlanarPlant | None = None

    @property
    def world(self) -> PlanarWorld:
        """The robot at work."""
        return PlanarWorld(self.plant, self.region, drift=self.drift)

    @property
    def floor_world(self) -> PlanarWorld:
        """Where the floor is measured."""
        return replace(self.world, plant=self.floor or self.plant)


def calibration_curves(setting: Combining, replicate: int, effort: Effort) -> Quantities:
    """Learning curves over the observations learned.

    error_NAME   mean position error of each rival [m]
    floor        of who knows the plant [m], at the same poses with the same noise
    ratio        of the first rival's error to the floor, where noise leaves one
    NAME_MARK    the point of each of these curves at a quoted mark
    """
    marks = [effort.of(mark, least=1) if mark else 0 for mark in setting.marks]
    tested = _tested(setting, marks, replicate, effort.of(setting.tests))
    at = np.array(marks, np.float64)
    *errors, least = (Curve(at, row) for row in tested.T)
    named = dict(zip((f"error_{name}" for name in setting.rivals), errors, strict=True))
    curves = {**named, "floor": least}
    if setting.plant.head.pixel_pitch > 0.0:
        curves["ratio"] = Curve(at, errors[0].value / least.value)
    quoted = {
        f"{name}_{mark}": float(curve.value[setting.marks.index(mark)])
        for name, curve in curves.items()
        for mark in setting.quoted
    }
    return {**curves, **quoted}


def recovery(setting: Combining, replicate: int, effort: Effort) -> Quantities:
    """After a change at the first mark: the curves of `calibration_curves`, counted from there.

    recovery  observations of the plant as it is now until the first rival's error is within 10 %
              of the floor, and stays there up to the last mark; the last mark if it never does
    """
    curves = calibration_curves(setting, replicate, effort)
    first = effort.of(setting.marks[0])
    since = {
        name: Curve(curve.at - first, curve.value) if isinstance(curve, Curve) else curve
        for name, curve in curves.items()
    }
    ratio = since["ratio"]
    assert isinstance(ratio, Curve)
    far = np.flatnonzero(ratio.value > WITHIN)
    back = 0 if not far.size else min(int(far[-1]) + 1, len(ratio.at) - 1)
    return {**since, "recovery": float(ratio.at[back])}


def following(setting: Combining, replicate: int, effort: Effort) -> Quantities:
    """The curves of `calibration_curves`, and over their second half the mean error over floor.

    tracking_NAME  of each rival, the mean of all tests over the mean floor
    """
    curves = calibration_curves(setting, replicate, effort)
    least = curves["floor"]
    assert isinstance(least, Curve)
    late = least.at > 0.5 * least.at[-1]
    for name in setting.rivals:
        error = curves[f"error_{name}"]
        assert isinstance(error, Curve)
        ratio = error.value[late].mean() / least.value[late].mean()
        curves = {**curves, f"tracking_{name}": float(ratio)}
    return curves


def _tested(setting: Combining, marks: list[int], replicate: int, tests: int) -> Array:
    """Mean errors (marks, rivals + 1) [m] of all rivals and of who knows the plant."""
    world, streams = setting.world, WorldStreams.of(replicate)
    wrong = stream("combined: seen instead of the hand", replicate)
    model = model_for(setting.plant)
    rivals = [RIVALS[name](model) for name in setting.rivals]
    rows: list[list[float]] = []
    learned = 0
    for mark in marks:
        if mark > learned:
            trials = np.arange(learned, mark)
            seen = world.observe(trials, streams.train_poses, streams.train_noise)
            seen = with_outliers(seen, setting.outliers, setting.plant, wrong)
            for rival in rivals:
                rival.observe_many(seen)
            learned = mark
        same = deepcopy(streams)
        misses = position_errors(world, rivals, mark, streams, tests)
        lengths = [np.linalg.norm(miss, axis=1) for miss in misses]
        lengths.append(floor(setting.floor_world, mark, same, tests))
        rows.append([float(length.mean()) for length in lengths])
    return np.array(rows)


def model_for(plant: PlanarPlant) -> PlanarModel:
    """The nominal model of a plant: kinematics are as drawn, the head's noise is as stated."""
    head = replace(NOMINAL.head, pixel_pitch=plant.head.pixel_pitch)
    return PlanarModel(replace(NOMINAL, head=head))


def with_outliers(
    seen: StereoObservation, share: float, plant: PlanarPlant, rng: np.random.Generator
) -> StereoObservation:
    """The same sightings, but in a share of them something else was seen, anywhere in the field."""
    n, half = len(seen), 0.5 * plant.head.field_of_view
    elsewhere = rng.random(n) < share
    far = plant.arm.reach + float(np.hypot(plant.v_x, plant.v_y))
    r, eccentricity = far * rng.random(n), half * (2.0 * rng.random(n) - 1.0)
    return replace(
        seen,
        range=np.where(elsewhere, r, seen.range),
        eccentricity=np.where(elsewhere, eccentricity, seen.eccentricity),
    )
