"""A ball at the flange in sockets of a base: an arm calibrated by its encoders alone, as a measure.

Two sockets, 50 mm apart, of a base that stands at several unknown places; every row of a file is
the joints at which the ball sat in one socket. Nobody knows where: the arm's model is right if the
ball is always found in the same two points, and these are as far apart as they are.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.arm.measurements import Points, Touches
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.setups.fit import fit_measurements
from handeye.errors import InvalidInput
from handeye.geometry import transform
from handeye.robots.urdf import UrdfArm
from handeye.thesis.experiment import Effort, Quantities
from handeye.thesis.real_data import ABSENT, real_data

DATA = "ball_in_sockets"
APART = 0.05
"""Between the two sockets of a base [m]."""


@dataclass(frozen=True)
class Sockets:
    """One arm's folder of places, and the model that is fitted.

    folder  of the places; each has hole_0.csv and hole_1.csv, joints [rad], no header
    urdf    the nominal arm; the ball is the origin of its link `ball`
    sheet   how far the arm may be from nominal, None for the default
    """

    folder: str
    urdf: str
    ball: str = "ball_link"
    sheet: ArmSheet | None = None


class Held(NamedTuple):
    """Joints (N, n) at one place, and the socket of each row (N,), 0 or 1."""

    joints: Array
    socket: Integers


class Score(NamedTuple):
    """Distances (N,) of the ball from its socket's mean, and how wrong the sockets' distance is."""

    consistency: Array
    distortion: float


def left_out(setting: Sockets, replicate: int, effort: Effort) -> Quantities:
    """Each place is left out once: the arm is fitted to the others, and judged there.

    consistency          mean distance of the ball from its socket's mean [m], mean over places
    distortion           how wrong the distance of the two sockets is [m], mean over places
    nominal_consistency, nominal_distortion
                         the same of the arm as its maker describes it
    PLACE                consistency at one place [m]
    """
    del replicate
    arm, places = sockets_data(setting)
    rows: dict[str, tuple[Score, Score]] = {}
    for place in list(places)[: effort.of(len(places), least=1)]:
        others = {name: held for name, held in places.items() if name != place}
        held = places[place]
        rows[place] = (
            score(arm.poses(held.joints)[:, :3, 3], held),
            fitted(arm, others, held, setting),
        )
    named: dict[str, float] = {}
    for prefix, part in (("nominal_", 0), ("", 1)):
        scores = [pair[part] for pair in rows.values()]
        named[f"{prefix}consistency"] = float(np.mean([s.consistency.mean() for s in scores]))
        named[f"{prefix}distortion"] = float(np.mean([s.distortion for s in scores]))
    return named | {place: float(fit.consistency.mean()) for place, (_, fit) in rows.items()}


def sockets_data(setting: Sockets) -> tuple[UrdfArm, dict[str, Held]]:
    """The nominal arm, and what was held at each place, in the order of their names.

    Raises:
        InvalidInput: the measurements are absent.
    """
    folder = real_data(DATA)
    if folder is None:
        raise InvalidInput(ABSENT)
    arm = UrdfArm.from_file(folder / "urdf" / setting.urdf, tip=setting.ball)
    places = sorted(path for path in (folder / setting.folder).iterdir() if path.is_dir())
    return arm, {path.name: _held(path) for path in places}


def fitted(arm: UrdfArm, places: dict[str, Held], at: Held, setting: Sockets) -> Score:
    """How an arm that was fitted to some places does at another."""
    ball = Points.near("ball", tolerance=1e-3)
    sockets = [
        Touches.start(
            held.joints, arm.poses(held.joints), held.socket,
            geometry=[(0.0, 0.0, 0.0), (APART, 0.0, 0.0)], tip=ball, name="sockets", plate=place,
        )
        for place, held in places.items()
    ]  # fmt: skip
    fit = fit_measurements(arm, sockets, setting.sheet)
    found = fit.unknowns["ball"]
    assert isinstance(found, Points)
    return score(transform(fit.flanges(at.joints), found.reference[0]), at)


def score(balls: Array, held: Held) -> Score:
    """Of where the ball was by an arm's model, (N, 3) [m]."""
    means = np.array([balls[held.socket == k].mean(axis=0) for k in (0, 1)])
    away = np.linalg.norm(balls - means[held.socket], axis=1)
    return Score(away, float(abs(np.linalg.norm(means[0] - means[1]) - APART)))


def _held(place: Path) -> Held:
    rows = [np.loadtxt(place / f"hole_{k}.csv", delimiter=",", ndmin=2) for k in (0, 1)]
    return Held(np.concatenate(rows), np.repeat([0, 1], [len(part) for part in rows]))
