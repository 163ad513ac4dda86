"""Every kind of model with observations it can learn from, for the suites that run over all."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import Any

import numpy as np

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.models import AnyModel, PlanarMap, PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import Placement
from handeye.calibration.session import AnyCalibrator, WorldStreams
from handeye.calibration.world import PlanarWorld
from handeye.geometry import make_pose, matrix_from_wxyz
from handeye.observations import PointObservation, StereoObservation
from handeye.robots.planar import TwoLinkArm
from handeye.robots.urdf import load_arm
from handeye.thesis.plants import NOMINAL, NORMAL

PLACEMENT = Placement(
    make_pose(matrix_from_wxyz([0.9, 0.1, -0.3, 0.3]), [0.4, -1.2, 0.8]),
    make_pose(matrix_from_wxyz([1.0, 0.2, 0.0, -0.4]), [0.03, 0.05, 0.12]),
)


@dataclass(frozen=True)
class Case:
    """A model, and N noisy observations of a robot that differs from it.

    exact      the model with observations that it predicts without error, if it can
    noise_free observations as in `seen`, without noise
    """

    name: str
    model: Any
    seen: Any
    noise_free: Any
    exact: Any

    def __str__(self) -> str:
        return self.name


def sightings(plant=NORMAL, n=60, replicate=0, **world) -> StereoObservation:
    """What a planar world shows in n trials."""
    streams = WorldStreams.of(replicate)
    return PlanarWorld(plant, **world).observe(
        np.arange(n), streams.train_poses, streams.train_noise
    )


def _planar(name: str, model: AnyModel, *, exact: bool = True, **world) -> Case:
    true = NOMINAL.without_noise()
    return Case(
        name,
        model,
        sightings(**world),
        sightings(NORMAL.without_noise(), **world),
        (model, sightings(true, **world)) if exact else None,
    )


def _placed(name: str, arm: Any, low, high) -> Case:
    rng = np.random.default_rng(5)
    joints = rng.uniform(low, high, (60, len(low)))
    model = PlacedArm(arm, PLACEMENT, np.asarray(low), np.asarray(high))
    time = np.arange(60.0)
    right = PointObservation(time, joints, PLACEMENT.predict(arm, joints))
    wrong = replace(right, position=PLACEMENT.predict(arm, joints + 0.01 * np.sin(joints + 1.0)))
    # A planar arm cannot follow noise out of its plane.
    noise = rng.normal(scale=2e-4, size=(60, 3)) * ([1.0, 1.0, 0.0] if len(low) == 2 else 1.0)
    noisy = replace(wrong, position=wrong.position + noise @ PLACEMENT.T_sensor_base[:3, :3].T)
    return Case(name, model, noisy, wrong, (model, right))


def _arms() -> list[Case]:
    cases = [_placed("two links in space", TwoLinkArm(1.0, 0.8), [-2.0, 0.4], [2.0, 2.2])]
    if find_spec("pinocchio") is None:
        return cases
    low, high = [-1.0, -2.0, 0.5, -1.5, -2.0, -1.0], [1.0, -0.8, 2.0, 0.5, -1.0, 1.0]
    return [*cases, _placed("ur10", load_arm("ur10"), low, high)]


CASES = [
    _planar("planar", PlanarModel(NOMINAL)),
    _planar("planar, foveating", PlanarModel(NOMINAL, foveate=True), foveate=True),
    _planar("whole planar map", PlanarMap(NOMINAL), exact=False),
    *_arms(),
]

KINDS: list[Callable[[AnyModel], AnyCalibrator]] = [Nominal, NetworkCorrection]
