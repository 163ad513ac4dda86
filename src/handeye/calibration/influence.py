"""Which rows of a log do not fit the others, so that a person knows which to look at."""

from typing import Any

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.calibration.combined import Combined
from handeye.calibration.expected import expected_at_rows
from handeye.calibration.results import HeldOut, Influence
from handeye.calibration.session import AnyCalibrator
from handeye.observations import Observation, PointObservation

# Median length of a normally distributed k-vector whose components have standard deviation 1.
_MEDIAN_LENGTH = {2: 1.177, 3: 1.538}
# So much of an ordinary error, at least, is none of the sensor's: no row is exact.
_OWN = 0.3


def influence(
    calibrator: AnyCalibrator,
    seen: Observation,
    held: HeldOut | None,
    *,
    since: int = 0,
    believed: Booleans | None = None,
) -> Influence:
    """What each row says against the others.

    Held-out rows are judged by a calibrator that never saw them. Their error over its expected
    size, |e_i| / (c sqrt(s^2 + s_i^2)), is 1 for the row in the middle: c is the median length of a
    vector of unit normal components, s follows from the median error, so that outliers do not
    count, and s_i is the standard deviation that the row itself states.

    believed (N,): rows that a fit to all of them counts; without it, those that were believed when
    they came.
    """
    n = len(seen)
    residual = np.full(n, np.nan)
    times = np.full(n, np.nan)
    everything: Observation = seen
    learned = calibrator.errors(everything[since:])
    lengths = np.linalg.norm(learned, axis=1)
    stated = _stated(calibrator, seen)
    residual[since:] = lengths
    times[since:] = lengths / _expected(lengths, stated[since:], learned.shape[1])
    if held is not None and len(held.rows):
        lengths = np.linalg.norm(held.after, axis=1)
        residual[held.rows] = lengths
        times[held.rows] = lengths / _expected(lengths, stated[held.rows], held.after.shape[1])
    left_out = np.zeros(n, np.bool_) if believed is None else ~believed
    if believed is None and isinstance(calibrator, Combined):
        doubted = [e.observation for e in calibrator.events if e.kind == "outlier"]
        left_out[[i for i in doubted if i < n]] = True
    return Influence(residual, times, left_out, _surely(calibrator, everything, held))


def _surely(calibrator: AnyCalibrator, seen: Any, held: HeldOut | None) -> Array | None:
    """How far off each row (N,) was expected to be, by who had not seen it where somebody had not.

    None where nobody knows.
    """
    if held is None or held.expected is None:
        return expected_at_rows(calibrator, seen)
    out = np.empty(len(seen))
    out[held.rows] = held.expected
    others = np.setdiff1d(np.arange(len(seen)), held.rows)
    if len(others):
        rest = expected_at_rows(calibrator, seen[others])
        if rest is None:
            return None
        out[others] = rest
    return out


def _stated(calibrator: AnyCalibrator, seen: Observation) -> Array:
    """Standard deviation (N,) of each row's measurement [m]; 0 where nothing states it."""
    if isinstance(seen, PointObservation):
        std = seen.position_std
        return np.zeros(len(seen)) if std is None else np.sqrt(np.mean(std**2, axis=1))
    model: Any = getattr(calibrator, "model", None)
    head = model.nominal.head
    along = head.range_std(seen.range, seen.eccentricity)
    across = seen.range * head.eccentricity_std(seen.eccentricity)
    return np.sqrt(0.5 * (along**2 + across**2))


def _expected(lengths: Array, stated: Array, k: int) -> Array:
    """Ordinary length (N,) of each error; a little above 0 where all are exact."""
    s = float(np.median(lengths)) / _MEDIAN_LENGTH[k]
    own = max(s**2 - float(np.median(stated)) ** 2, (_OWN * s) ** 2)
    return np.maximum(_MEDIAN_LENGTH[k] * np.sqrt(own + stated**2), 1e-12)
