"""Arms that were measured in the real world: how well they are known after some of the rows."""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, Integers
from handeye.calibration.arm import ArmEstimator, ArmSheet, CurveTerms
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.log_run import calibrate_log
from handeye.calibration.placed import place
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.session import AnyCalibrator
from handeye.errors import InvalidInput
from handeye.geometry import wxyz_from_matrix
from handeye.io.records import Log
from handeye.observations import PointObservation
from handeye.robots.urdf import UrdfArm
from handeye.thesis.experiment import Curve, Effort, Quantities
from handeye.thesis.real_data import ABSENT, real_data

UR10, FR3, PANDA = "ur10_joint_configurations", "fr3_eye_in_hand", "ball_in_sockets"
_JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")

Split = Literal["random", "blocks", "order"]
BLOCKS = 5
_FIT_UR10, _FIT_FR3 = 1000, 75
# Test, then train: rows that place the frames, and marks with the rows after each that are counted.
_PLACING = 20
MARKS = (20, 50, 100, 300, 1000)
_AFTER = 100


@dataclass(frozen=True)
class Knowing:
    """What learns, and which rows are left out: another random part, or block, per replicate."""

    learner: Literal["placement", "network", "geometry", "curves", "combined"]
    split: Split = "random"


def learner_for(name: str, model: PlacedArm, effort: Effort) -> AnyCalibrator:
    """A calibrator that has seen nothing; with less effort, of arms with fewer harmonics.

    placement: nominal arm. network: a correction of where it puts the marker. geometry and curves:
    all rows at once, without error curves and with them. combined: the default, live, row by row.
    """
    match name:
        case "placement":
            return Nominal(model)
        case "network":
            return NetworkCorrection(model)
        case "geometry":
            return ArmEstimator(model, _sheet(CurveTerms(0, 0), effort))
        case "curves":
            return ArmEstimator(model, _sheet(FINE, effort))
        case _:
            return Combined(model, _sheet(CurveTerms(), effort))


def _sheet(curves: CurveTerms, effort: Effort) -> ArmSheet:
    share = min(effort.fraction, 1.0)
    some = CurveTerms(round(share * curves.own), round(share * curves.others))
    return replace(ArmSheet(), curves=some)


def ur10(setting: Knowing, replicate: int, effort: Effort) -> Quantities:
    """A UR10 under a laser tracker: errors of the probe's position on rows left out [m].

    mean, rms, p95; and of rows in order, tested before they are learned: error, a curve over the
    rows seen, each mean that of the next hundred, and mean, over all rows after the first twenty.
    """
    arm, seen = ur10_data()
    seen = seen[: effort.of(len(seen), 60)]
    n = len(seen)
    if setting.split == "order":
        return _in_order(setting, arm, seen, effort)
    if setting.split == "blocks":
        test = np.array_split(np.arange(n), BLOCKS)[replicate % BLOCKS]
    else:
        order = np.random.default_rng(replicate).permutation(n)
        test = np.sort(order[_FIT_UR10 * n // 1495 :])
    return _left_out(setting, arm, seen, test, effort)


def fr3(setting: Knowing, replicate: int, effort: Effort) -> Quantities:
    """A Franka Research 3 whose wrist camera looks at a board: mean, rms, p95 of its place [m].

    On the 39 of 114 poses that its data's README names.
    """
    del replicate
    arm, seen = fr3_data()
    order = np.random.default_rng(0).permutation(len(seen))
    return _left_out(setting, arm, seen, np.sort(order[_FIT_FR3:]), effort)


def _left_out(
    setting: Knowing, arm: UrdfArm, seen: PointObservation, test: Integers, effort: Effort
) -> Quantities:
    some = seen[np.setdiff1d(np.arange(len(seen)), test)]
    if setting.learner == "combined":
        return _summary(_default(arm, some).errors(seen[test]))
    calibrator = learner_for(setting.learner, _placed(arm, some), effort)
    calibrator.observe_many(some)
    return _summary(calibrator.errors(seen[test]))


def _default(arm: UrdfArm, seen: PointObservation) -> AnyCalibrator:
    """What `handeye calibrate` makes of a log of these rows."""
    log = Log("", arm.joint_names, seen, np.arange(len(seen)))
    return calibrate_log(log, arm, validate="none").calibrator


def _in_order(setting: Knowing, arm: UrdfArm, seen: PointObservation, effort: Effort) -> Quantities:
    calibrator = learner_for(setting.learner, _placed(arm, seen[:_PLACING]), effort)
    calibrator.observe_many(seen[:_PLACING])
    errors: Array = np.linalg.norm(calibrator.observe_many(seen[_PLACING:]).error, axis=1)
    marks = np.array([mark for mark in MARKS if mark < len(seen)])
    after = [errors[m - _PLACING : m - _PLACING + _AFTER].mean() for m in marks]
    return {"error": Curve(marks, np.array(after)), "mean": float(errors.mean())}


def _placed(arm: UrdfArm, seen: PointObservation) -> PlacedArm:
    model, _ = place(arm, seen)
    assert isinstance(model, PlacedArm)
    return model


def _summary(errors: Array) -> Quantities:
    lengths: Array = np.linalg.norm(errors, axis=1)
    return {
        "mean": float(lengths.mean()),
        "rms": float(np.sqrt(np.mean(lengths**2))),
        "p95": float(np.percentile(lengths, 95)),
    }


@cache
def ur10_data() -> tuple[UrdfArm, PointObservation]:
    """The UR10 and 1,495 sightings of the probe on its flange, in order of time.

    Raises:
        InvalidInput: the measurements are absent.
    """
    file = _folder(UR10) / "measurements_joint_configurations.csv"
    head, *lines = file.read_text(encoding="utf-8").splitlines()
    table = np.array([[float(v.replace(",", ".")) for v in line.split(";")] for line in lines])
    at = {name: i for i, name in enumerate(head.split(";"))}

    def columns(*names: str) -> Array:
        return table[:, [at[name] for name in names]]

    turns = columns("measurement_rx", "measurement_ry", "measurement_rz")
    R = Rotation.from_euler("XYZ", turns, degrees=True).as_matrix()
    seen = PointObservation(
        np.arange(len(table), dtype=np.float64),
        columns(*(f"{joint}_joint" for joint in _JOINTS)),
        columns(*(f"measurement_{axis}" for axis in "xyz")) / 1e3,
        wxyz_from_matrix(R),
        columns(*(f"measurement_std_{axis}" for axis in "xyz")) / 1e3,
    )
    return UrdfArm.shipped("ur10"), seen


@cache
def fr3_data() -> tuple[UrdfArm, PointObservation]:
    """The Franka arm and 114 poses of its wrist camera in the frame of a board.

    Raises:
        InvalidInput: the measurements are absent.
    """
    arm = UrdfArm.from_file(_folder(PANDA) / "urdf" / "panda.urdf", tip="panda_link8")
    data = np.genfromtxt(_folder(FR3) / "fr3_realsense_board.csv", delimiter=",", names=True)

    def columns(*names: str) -> Array:
        return np.stack([data[name] for name in names], axis=1)

    seen = PointObservation(
        np.arange(len(data), dtype=np.float64),
        columns(*(f"q{i}_rad" for i in range(1, 8))),
        columns(*(f"cam_in_board_{axis}_m" for axis in "xyz")),
        columns(*(f"cam_in_board_q{part}" for part in "wxyz")),
    )
    return arm, seen


def _folder(name: str) -> Path:
    folder = real_data(name)
    if folder is None:
        raise InvalidInput(ABSENT)
    return folder
