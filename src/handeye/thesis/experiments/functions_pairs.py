"""What do two sigmoids of opposite gain add up to?

Section A.6.6, figures A.6 to A.8.
"""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.networks.layered import fourier_network, pair
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities

ORDER = 4
_POINTS = 2000


@dataclass(frozen=True)
class Paired:
    """A pair of hyperbolic tangents: gain, distance of the thresholds, and |x| up to which."""

    gain: float
    apart: float
    reach: float


def pair_shape(setting: Paired, replicate: int, effort: Effort) -> Quantities:
    """Curves over x, and how far they are from what they should be, over the height of two.

    rising, falling, sum  the two tangents and their sum
    wave                  1 + cos(x) over one period around the pair, the segment of 1 + sin(x - r)
                          from trough to trough; nothing beyond
    inside, outside       largest difference of the sum from `wave` in and beyond that period
    as_printed            from 1 + sin(x - r) where -pi <= x - r <= pi, with the crest at the pair
    pulse                 largest difference from a pulse between the thresholds, except where the
                          tangents are not yet within 1 % of their ends
    module, sinusoid      over one period: the sum less one, and the cosine that it stands for
    """
    del replicate
    points = effort.of(_POINTS, least=200)
    half = 0.5 * setting.apart
    x = np.linspace(-setting.reach, setting.reach, points + 1)
    rising, falling = np.tanh(setting.gain * (x + half)), np.tanh(setting.gain * (half - x))
    total = pair(x, setting.gain, setting.apart)
    period = np.linspace(-np.pi, np.pi, points + 1)
    beyond = np.linspace(np.pi, setting.reach + np.pi, points + 1)
    steep = np.arctanh(0.99) / setting.gain
    settled = np.abs(np.abs(x) - half) > steep
    wave = np.where(np.abs(x) <= np.pi, 1.0 + np.cos(x), 0.0)
    inside = pair(period, setting.gain, setting.apart)
    return {
        "rising": Curve(x, rising),
        "falling": Curve(x, falling),
        "sum": Curve(x, total),
        "wave": Curve(x, wave),
        "inside": _largest(inside - 1.0 - np.cos(period)),
        "outside": _largest(pair(beyond, setting.gain, setting.apart)),
        "as_printed": _largest(
            pair(period - 0.5 * np.pi, setting.gain, setting.apart) - 1.0 - np.sin(period)
        ),
        "pulse": _largest((total - np.where(np.abs(x) < half, 2.0, 0.0))[settled]),
        "module": Curve(period, inside - 1.0),
        "sinusoid": Curve(period, np.cos(period)),
    }


def _largest(differences: Array) -> float:
    """Over the height of a pair of steps, two."""
    return 0.5 * float(np.max(np.abs(differences)))


def series_shape(setting: int, replicate: int, effort: Effort) -> Quantities:
    """A triangle by the first harmonics of its Fourier series, and by networks of pairs.

    function, series  the triangle 1 - |x| over [-1, 1] and its series up to the order, less 1/2
    network           pairs with the same coefficients
    harmonic-1, ...   what the pairs of each harmonic add to it
    """
    del replicate
    x = np.linspace(-1.0, 1.0, effort.of(_POINTS, least=200) + 1)
    n = np.arange(1, setting + 1)
    coefficients = np.column_stack(
        [2.0 * (1.0 - np.cos(n * np.pi)) / (n * np.pi) ** 2, np.zeros(setting)]
    )
    terms = coefficients[:, 0] * np.cos(np.pi * np.outer(x, n))

    def by_pairs(given: Array) -> Curve:
        network = fourier_network(-1.0, 1.0, setting, given)
        return Curve(x, network.predict_many(x[:, np.newaxis])[:, 0])

    alone = {
        f"harmonic-{k}": by_pairs(np.where(n[:, np.newaxis] == k, coefficients, 0.0))
        for k in n.tolist()
    }
    return {
        "function": Curve(x, 0.5 - np.abs(x)),
        "series": Curve(x, terms.sum(axis=1)),
        "network": by_pairs(coefficients),
        **alone,
    }


PAIRED_SIGMOIDS = Experiment(
    id="paired-sigmoids",
    settings={
        "steep": Paired(gain=50.0, apart=np.pi, reach=2.0 * np.pi),
        "smooth": Paired(gain=1.0, apart=np.pi, reach=2.0 * np.pi),
    },
    measure=pair_shape,
    deterministic=True,
)

PAIRED_SERIES = Experiment(
    id="paired-series",
    settings={"triangle": ORDER},
    measure=series_shape,
    deterministic=True,
)
