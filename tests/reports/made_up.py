"""Plausible made-up runs to draw."""

from dataclasses import replace

import numpy as np

from handeye.calibration.results import (
    CalibrationResult,
    HeldOut,
    Influence,
    PartChange,
    Workspace,
)
from handeye.reports.demo import DemoRun
from handeye.reports.figures import PlanarArm, Stage


def ur_run(n=1495, held_out=True, rejected=(), log="ur10_log.csv", expected=True):
    """A six-joint arm whose second and third joint are off, learned down to its repeatability."""
    rng = np.random.default_rng(7)
    joints = rng.uniform(-np.pi, np.pi, (n, 6)) * (1.0, 0.4, 0.6, 0.8, 0.5, 1.0)
    bearing, height = joints[:, 0] * 0.5, 0.6 + 0.5 * np.sin(joints[:, 1])
    reach = 0.75 + 0.35 * np.cos(joints[:, 2])
    positions = np.stack([reach * np.cos(bearing), reach * np.sin(bearing), height], axis=1)
    wave = 0.9e-3 * np.sin(joints[:, 1] * 2) + 0.5e-3 * np.cos(joints[:, 2])
    before = np.stack(
        [wave, 0.6e-3 * np.sin(joints[:, 0]), 0.5e-3 - 0.7e-3 * np.cos(joints[:, 1] * 2)], axis=1
    ) + rng.normal(0.0, 1.2e-4, (n, 3))
    left = 0.22 + 0.78 * np.exp(-np.arange(n) / 250.0)
    online = before * left[:, None] + rng.normal(0.0, 1.3e-4, (n, 3))
    rows = np.sort(rng.permutation(n)[: n // 3])
    after = 0.26 * before[rows] + rng.normal(0.0, 1.2e-4, (len(rows), 3))
    turns = rng.normal(0.0, 1e-3, (len(rows), 3))
    held = HeldOut(
        rows, before[rows], after, rows * 5 // n, "blocks", 2.0 * turns, turns, np.full(5, 8e-5)
    )
    residual = np.linalg.norm(online, axis=1)
    sizes = 2e-4 + 1e-4 * rng.uniform(size=n)
    if expected:
        held = replace(held, expected=sizes[rows])
    return CalibrationResult(
        robot="ur10",
        log=log,
        method="network correction over nominal kinematics",
        joint_names=(
            "shoulder_pan",
            "shoulder_lift",
            "elbow",
            "wrist_1",
            "wrist_2",
            "wrist_3",
        ),
        joints=joints,
        positions=positions,
        before=before,
        online=online,
        n_neurons=np.minimum(np.arange(1, n + 1) // 2 + 1, 500),
        held_out=held if held_out else None,
        rejected=tuple(rejected),
        settings={"seed": "0", "neurons at most": "500", "held out": "one third", "log": log},
        times=np.arange(n) / 2.0,
        rows=np.arange(n) + 2,
        parts=(
            PartChange("zero of joint elbow", 8.2e-4, "elbow zero", -1.1e-3, 4e-5, "rad", 0.97),
            PartChange("placement of joint wrist_1", 3.1e-4, "shift x", 2.9e-4, 6e-5, "m", 0.62),
        ),
        undetermined=("scale of joint wrist_3",),
        influence=Influence(
            residual, residual / np.median(residual), residual > 3e-3, sizes if expected else None
        ),
        workspace=ur_workspace(positions) if expected else None,
    )


def ur_workspace(positions, n=600):
    """Postures near those of a log, and others that are known worse the lower they reach."""
    rng = np.random.default_rng(2)
    joints = rng.uniform(-np.pi, np.pi, (n, 6))
    worked = np.arange(n) % 2 == 0
    bearing, reach = joints[:, 0], np.sqrt(rng.uniform(0.05, 1.4, n))
    height = np.where(worked, rng.uniform(0.1, 1.1, n), rng.uniform(-1.0, 1.2, n))
    places = np.stack([reach * np.cos(bearing), reach * np.sin(bearing), height], axis=1)
    sizes = 2e-4 * (1.0 + reach) + np.where(worked, 0.0, 4e-4 * (1.2 - height))
    return Workspace(joints, places, sizes, worked, positions[:200])


def planar_run(n=300):
    """The planar robot without a held-out part; positions lie in a plane."""
    rng = np.random.default_rng(3)
    joints = rng.uniform(-0.8 * np.pi, 0.8 * np.pi, (n, 2))
    angle = joints[:, 0] + joints.sum(axis=1) * 0
    tip = np.stack([np.cos(angle) + np.cos(joints.sum(1)), np.sin(angle) + np.sin(joints.sum(1))])
    before = 0.03 * np.stack([np.cos(tip[0]), np.sin(tip[1] + 1)], 1)
    noise = rng.normal(0.0, 0.007, (n, 2))
    return CalibrationResult(
        robot="planar",
        log="planar.csv",
        method="network correction",
        joint_names=("alpha", "beta"),
        joints=joints,
        positions=np.stack([tip[0], tip[1], np.zeros(n)], axis=1),
        before=before + noise,
        online=before * np.exp(-np.arange(n) / 80.0)[:, None] + noise,
        n_neurons=np.arange(1, n + 1),
        held_out=None,
        rejected=(),
        settings={"seed": "1"},
    )


def demo_run():
    """Ten thousand reaches, bent by two degrees half way."""
    rng = np.random.default_rng(5)
    trials = np.sort(np.append(np.arange(0, 10_001, 200), 5000))
    bent = np.arange(len(trials)) > 25
    start = np.where(bent, 0.028, 0.033)
    since = np.where(bent, trials - 5000, trials)
    corrected = 0.0125 + start * np.exp(-since / 900.0) + rng.normal(0.0, 2e-4, len(trials))
    corrected[0] = 0.045
    uncorrected = np.where(bent, 0.071, 0.045) + rng.normal(0.0, 4e-4, len(trials))
    turn, radius = rng.uniform(-2.3, 2.3, 60), np.sqrt(rng.uniform(0.35, 3.6, 60))
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    wave = 0.045 * np.stack([np.cos(points[:, 1] * 1.4), np.sin(points[:, 0] * 1.2 + 0.6)], axis=1)

    def noise():
        return rng.normal(0.0, 0.0085, points.shape)

    swing = np.radians(2.0) * np.stack([-points[:, 1], points[:, 0]], axis=1)
    return DemoRun(
        trials=trials,
        corrected=corrected,
        corrected_std=np.full(len(trials), 0.006),
        uncorrected=uncorrected,
        network=1.5 * corrected,
        bend_trial=5000,
        bend=np.radians(2.0),
        noticed="encoder offset of alpha changed by +2.01 ± 0.05 degrees",
        noise_floor=0.009,
        before=Stage("Before learning", points, wave),
        learned=Stage("After 5,000 reaches", points, noise()),
        bent=Stage("Just bent by 2 degrees", points, swing + noise()),
        relearned=Stage("After 5,000 more", points, noise()),
        arm=PlanarArm(links=(1.0, 1.0), eye=(-1.0, 0.0)),
    )
