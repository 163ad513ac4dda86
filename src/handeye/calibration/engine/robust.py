"""Which observations of the window are outliers, whatever was thought of them before."""

from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from handeye.calibration.engine.filter import Bank, Rules, relearn
from handeye.calibration.engine.stepping import restart, window_squares, window_surprises

_ROUNDS = 10
# Squared residuals this many times their robust scale count half as much.
_SOFT = 8.0


def find_outliers(
    kernel: NamedTuple, rules: Rules, bank: Bank, hypotheses: tuple[int, ...], gate: float
) -> None:
    """Set the window's weights: 0 for outliers, 1 for the rest.

    An M-estimate from what was known before the window: with r^2 the squared residual of an
    observation and s^2 their robust scale, at least 1, it counts by `1 / (s^2 + r^2 / 8)`. From a
    wrong start all are large, s with them, and the priors hold the estimate until s falls. The
    hypotheses go one after the other, stiff ones first, since they cannot bend to an outlier.
    Outliers are then those whose surprise is beyond the gate, times its robust scale if that is
    above 1.
    """
    inside = min(int(bank.counts[0]), len(bank.weights))
    middle = float(chi2.median(bank.lines.shape[2]))
    squares = np.zeros(len(bank.weights))
    for place, h in enumerate(hypotheses):
        restart(bank, h)
        if place == 0:
            window_squares(kernel, rules, bank, h, squares)
        for _ in range(_ROUNDS):
            scale = max(1.0, float(np.median(squares[:inside])) / middle)
            bank.weights[:inside] = 1.0 / (scale + squares[:inside] / _SOFT)
            relearn(kernel, rules, bank, h, 1)
            window_squares(kernel, rules, bank, h, squares)
    window_surprises(kernel, rules, bank, hypotheses[-1], squares)
    limit = gate * max(1.0, float(np.median(squares[:inside])) / middle)
    bank.weights[:inside] = squares[:inside] < limit
