"""The streams of benchmarks/online.py: samples in the order in which they are learned, and others.

Inputs and targets are standardised by the first 500 samples. Replicates from 100 on are for
choosing settings: no row that they hold out or learn is held out by one below 100 where the
stream is measured and large enough (kin40k), or the noise and the draws are others.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.io import loadmat

from handeye.calibration.models import PlanarModel
from handeye.calibration.world import PlanarWorld
from handeye.randomness import stream as random_stream
from handeye.thesis.plants import NOMINAL, NORMAL

FIRST = 500
"""Samples from which everything that must be known beforehand is taken."""

_BESIDE = Path(__file__).resolve().parents[2] / "shared"
_DATA = Path(os.environ.get("HANDEYE_SHARED", _BESIDE)) / "data"
_CHOOSING = 100  # replicates from here on


class Stream(NamedTuple):
    """Standardised samples to learn, x (N, d), y (N, m), and held-out ones."""

    x: np.ndarray
    y: np.ndarray
    test_x: np.ndarray
    test_y: np.ndarray


def kin40k(replicate: int) -> Stream:
    """Forward kinematics of an arm of eight links; 10,000 rows, held out 5,000 (measured once)."""
    # NumPy unpacks the files itself.
    rows = np.loadtxt(_DATA / "kin40k/data.csv.gz", delimiter=",")
    masks = np.loadtxt(_DATA / "kin40k/test_mask.csv.gz", delimiter=",")
    fold = masks.argmax(axis=1)  # the ten test sets share no row
    learned, held = ((2, 3, 4), (0, 1)) if replicate < _CHOOSING else ((7, 8, 9), (5, 6))
    rng = random_stream("benchmark online: kin40k", replicate)
    learned_rows = rng.permutation(rows[np.isin(fold, learned)])[:10_000]
    return _standardised(learned_rows, rows[np.isin(fold, held)][:5_000], 8)


def sarcos(replicate: int) -> Stream:
    """Inverse dynamics of a real arm, seven torques; 4,000 random rows, the other 449 held out."""
    rows = loadmat(_DATA / "sarcos_test/sarcos_inv_test.mat")["sarcos_inv_test"]
    rng = random_stream("benchmark online: SARCOS", replicate)
    rows = rng.permutation(rows)
    return _standardised(rows[:4_000], rows[4_000:], 21)


def mackey_glass(replicate: int) -> Stream:
    """A chaotic series, s(t + 85) from s(t), s(t - 6), s(t - 12), s(t - 18) (Platt 1991).

    `ds/dt = 0.2 s(t - 17) / (1 + s(t - 17)^10) - 0.1 s(t)`; 10,000 samples in the order of time,
    one a unit of time, the 2,000 after them held out. No noise.
    """
    steps, delay = 10, 17  # of the integration in a unit of time; the delay in units
    start = 0.5 + random_stream("benchmark online: Mackey-Glass", replicate).random()
    series = np.full((1_000 + 12_000 + 18 + 85) * steps, start)
    for t in range(delay * steps, len(series) - 1):
        # Fourth-order Runge-Kutta; the delayed value between two steps is their mean.
        then, after = series[t - delay * steps], series[t - delay * steps + 1]
        grow = [0.2 * s / (1.0 + s**10) for s in (then, 0.5 * (then + after), after)]
        here, h = series[t], 1.0 / steps
        k1 = grow[0] - 0.1 * here
        k2 = grow[1] - 0.1 * (here + 0.5 * h * k1)
        k3 = grow[1] - 0.1 * (here + 0.5 * h * k2)
        k4 = grow[2] - 0.1 * (here + h * k3)
        series[t + 1] = here + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    s = series[1_000 * steps :: steps]
    now = np.arange(18, 18 + 12_000)
    rows = np.column_stack([s[now], s[now - 6], s[now - 12], s[now - 18], s[now + 85]])
    return _standardised(rows[:10_000], rows[10_000:], 4)


def cross(replicate: int) -> Stream:
    """Two ridges that cross in a hump, on a square; 10,000 samples with noise 0.1, 2,000 without.

    `max(exp(-10 a^2), exp(-50 b^2), 1.25 exp(-5 (a^2 + b^2)))` (Vijayakumar, D'Souza and Schaal
    2005).
    """
    rng = random_stream("benchmark online: cross", replicate)
    x = rng.uniform(-1.0, 1.0, size=(12_000, 2))
    a, b = x.T
    y = np.maximum(
        np.maximum(np.exp(-10.0 * a**2), np.exp(-50.0 * b**2)),
        1.25 * np.exp(-5.0 * (a**2 + b**2)),
    )
    y[:10_000] += 0.1 * rng.normal(size=10_000)
    rows = np.column_stack([x, y])
    return _standardised(rows[:10_000], rows[10_000:], 2)


def hand_eye(replicate: int) -> Stream:
    """The correction of the thesis's planar robot: what two joint angles lack at what the eye sees.

    Five inputs; 10,000 sightings of the hand with the noise of the normal plant, 2,000 without.
    """
    model = PlanarModel(NOMINAL)
    poses, noise = (
        random_stream(f"benchmark online: {name}", replicate) for name in ("poses", "noise")
    )
    parts: list[np.ndarray] = []
    for plant, n in ((NORMAL, 10_000), (NORMAL.without_noise(), 2_000)):
        seen = PlanarWorld(plant).observe(np.arange(n), poses, noise)
        parts.append(np.column_stack([model.features(seen), model.needed(seen)]))
    return _standardised(parts[0], parts[1], 5)


def _standardised(learned: np.ndarray, held: np.ndarray, n_inputs: int) -> Stream:
    first = learned[:FIRST]
    learned, held = ((rows - first.mean(axis=0)) / first.std(axis=0) for rows in (learned, held))
    parts = [part for rows in (learned, held) for part in np.split(rows, [n_inputs], axis=1)]
    return Stream(*(np.ascontiguousarray(part) for part in parts))


STREAMS: dict[str, Callable[[int], Stream]] = {
    "kin40k": kin40k,
    "SARCOS": sarcos,
    "Mackey-Glass": mackey_glass,
    "cross": cross,
    "hand-eye": hand_eye,
}
