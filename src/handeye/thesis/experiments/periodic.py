"""How well does a trained network follow heat that comes and goes?

Section 3.5.7, figures 3.35 to 3.38.
"""

from dataclasses import replace

import numpy as np

from handeye.arrays import Array, Integers
from handeye.calibration.calibrators import Nominal
from handeye.calibration.drift import Thermal
from handeye.calibration.models import PlanarModel
from handeye.thesis.analysis.first_order import fit_corner
from handeye.thesis.analysis.harmonic import fit_rectified_sine, fit_sine
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.learning import Learning
from handeye.thesis.plants import NOMINAL, NORMAL
from handeye.thesis.tracking import Shares, Trained, misses, sightings, trained, without_drift

PERIODS = (100, 200, 500, 1000, 2500, 5000)
TRIALS = 10_000
PARTS = 20

HOTTEST = Thermal(np.inf, phase_shift=0.5 * np.pi)


def periodic_response(setting: Learning, replicate: int, effort: Effort) -> Quantities:
    """Errors under drift of every period, each from the same trained network.

    Each trial is tested before it is learned. Amplitudes and phases are those of the later half of
    the trials, in two measures. One is the position error, to which eq 3.106 is fitted; its ratio
    is to the amplitude, fitted alike, of the same network's error with learning off. The other is
    the share of the displacement by the hottest moment that is left, with its sign, to which a sine
    is fitted (eq 3.103 without the absolute value).

    error-P, uncorrected-P     for period P: curves over the first two periods, mean lengths [m] in
                               twentieths of a period
    cycle-P, cycle-share-P     mean error and share over the later periods, by the time in a period
    ratio, lead, ..._std       curves over the period: of the error, amplitude ratio and lead [rad]
    floor, disturbance         level [m] of eq 3.106, and the amplitude [m] with learning off
    share_ratio, share_lead, ..._std   the same of the share
    corner, corner_by_ratio, corner_by_lead, share_corner
                               corner period [trials] of first-order models fitted to these
    """
    network, n = trained(setting, replicate, effort), effort.of(TRIALS)
    curves: dict[str, Curve] = {}
    rows: list[dict[str, float]] = []
    periods = [effort.of(period, least=PARTS) for period in PERIODS]
    for name, period in zip(PERIODS, periods, strict=True):
        drifting, row = _follow(setting, network, n, period)
        curves |= {f"{quantity}-{name}": curve for quantity, curve in drifting.items()}
        rows.append(row)
    at = np.array(periods, np.float64)
    bode = {name: Curve(at, np.array([row[name] for row in rows])) for name in rows[0]}
    corner = fit_corner(at, bode["ratio"].value, bode["lead"].value)
    share = fit_corner(at, bode["share_ratio"].value, bode["share_lead"].value)
    return {
        **curves,
        **bode,
        "corner": corner.both,
        "corner_by_ratio": corner.ratio,
        "corner_by_lead": corner.lead,
        "share_corner": share.both,
    }


def _follow(
    setting: Learning, network: Trained, n: int, period: int
) -> tuple[dict[str, Curve], dict[str, float]]:
    """Curves and fitted numbers of n trials under drift of a period."""
    learner, streams = network.copy()
    drifts = (Thermal(period), HOTTEST)
    seen, hottest = (sightings(replace(setting.world, drift=d), streams, n) for d in drifts)
    displacement = misses(learner, hottest) - misses(
        learner, sightings(without_drift(setting.world), streams, n)
    )
    frozen = np.linalg.norm(misses(learner, seen), axis=1)
    errors = learner.observe_many(seen).error
    uncorrected = Nominal(PlanarModel(NOMINAL)).observe_many(seen).error
    error, shares = np.linalg.norm(errors, axis=1), Shares.of(errors, displacement)

    t = np.arange(n)
    late = t >= n // 2
    moving = fit_rectified_sine(t[late], error[late], period)
    still = fit_rectified_sine(t[late], frozen[late], period)
    share = fit_sine(t[late], shares.share[late], period, shares.weight[late])
    width = period // PARTS
    first = t < 2 * PARTS * width
    by_window, by_phase = t[first] // width, t[late] % period * PARTS // period
    curves = {
        "error": _means(by_window, error[first], width),
        "uncorrected": _means(by_window, np.linalg.norm(uncorrected, axis=1)[first], width),
        "cycle": _means(by_phase, error[late], period / PARTS),
        "cycle-share": _means(by_phase, shares.share[late], period / PARTS, shares.weight[late]),
    }
    return curves, {
        "ratio": moving.amplitude / still.amplitude,
        "ratio_std": moving.amplitude_std / still.amplitude,
        # A rectified sine repeats every half turn: the lead is told in the half around 45 degrees.
        "lead": (moving.phase + np.pi / 4.0) % np.pi - np.pi / 4.0,
        "lead_std": moving.phase_std,
        "floor": moving.level,
        "disturbance": still.amplitude,
        "share_ratio": share.amplitude,
        "share_ratio_std": share.amplitude_std,
        "share_lead": share.phase,
        "share_lead_std": share.phase_std,
    }


def _means(part: Integers, values: Array, width: float, weights: Array | None = None) -> Curve:
    """Weighted means of the values (N,) in each part (N,), at the middle of parts of a width."""
    w = np.ones_like(values) if weights is None else weights
    used = np.unique(part)
    sums = np.bincount(part, w * values)[used] / np.bincount(part, w)[used]
    return Curve(width * (0.5 + used.astype(np.float64)), sums)


PERIODIC = Experiment(
    id="periodic",
    settings={"200": Learning(NORMAL, 200)},
    measure=periodic_response,
)
