"""A network as a first-order system that follows a plant (section 3.5.7, eq 3.100 to 3.106).

`do/dt = k (T - o - floor)` with k = 1 / tau (eq 3.100): the error T - o is the plant's disturbance,
high-pass filtered, and the floor that the network leaves in any case. Times and periods count
trials.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, finite, scalar, shaped
from handeye.errors import InvalidInput


def amplitude_ratio(period: ArrayLike, tau: float) -> Array:
    """`rho / A = omega / sqrt(omega^2 + k^2)` (eq 3.104) at periods (...)."""
    return 1.0 / np.hypot(1.0, _lag(period, tau))


def phase_lead(period: ArrayLike, tau: float) -> Array:
    """`phi = arctan(k / omega)` (eq 3.105) [rad] at periods (...)."""
    return np.arctan(_lag(period, tau))


def corner_period(tau: float) -> float:
    """`2 pi tau`, at which the error has 1 / sqrt(2) of the disturbance and leads by 45 degrees."""
    return 2.0 * np.pi * scalar(tau, "tau", above=0.0)


def network_error(
    t: ArrayLike, period: float, tau: float, amplitude: float, floor: float = 0.0
) -> Array:
    """`rho |sin(omega t + phi)| + floor` (eq 3.106) at times t (...), transients gone.

    amplitude is that of the disturbance, A.
    """
    angle = 2.0 * np.pi * finite(t, "t") / scalar(period, "period", above=0.0)
    rho = amplitude * amplitude_ratio(period, tau)
    return rho * np.abs(np.sin(angle + phase_lead(period, tau))) + floor


def output(
    t: ArrayLike, period: float, tau: float, amplitude: float, floor: float, start: float
) -> Array:
    """Network output at times t (...) from `start` at t = 0 (eq 3.101, with C from the start)."""
    times = finite(t, "t")
    k = 1.0 / scalar(tau, "tau", above=0.0)
    omega = 2.0 * np.pi / scalar(period, "period", above=0.0)
    forced = k * (k * np.sin(omega * times) - omega * np.cos(omega * times))
    decay = np.exp(-k * times)
    return (
        amplitude * (forced + k * omega * decay) / (k * k + omega * omega)
        + floor * (decay - 1.0)
        + start * decay
    )


class CornerFit(NamedTuple):
    """A first-order model fitted to points of a Bode plot: corner period from ...

    both   amplitude ratio and phase together
    ratio  the amplitude ratio alone
    lead   the phase alone
    """

    both: float
    ratio: float
    lead: float


def fit_corner(periods: ArrayLike, ratio: ArrayLike, lead: ArrayLike) -> CornerFit:
    """The corner period that fits amplitude ratios and phase leads [rad], each (N,), best.

    Least squares of `ratio exp(i lead)` in the complex plane, which is right for estimates from
    equally many trials at every period; hence leads, taken alone, count in proportion to the ratio.
    """
    p = shaped(periods, (None,), "periods")
    if len(p) == 0 or np.any(p <= 0.0):
        raise InvalidInput("periods must be positive, and at least one")
    r, phi = shaped(ratio, p.shape, "ratio"), shaped(lead, p.shape, "lead")
    # A misfit may have several minima, and a grid finer than 0.1 % is as cheap as a search.
    least, most = float(p.min()) / 100.0, float(p.max()) * 100.0
    corners = np.geomspace(least, most, 20_001)[:, np.newaxis]
    lag = p / corners
    model_r, model_phi = 1.0 / np.hypot(1.0, lag), np.arctan(lag)
    across = model_r * np.exp(1j * model_phi) - r * np.exp(1j * phi)
    misfits = (np.abs(across) ** 2, (model_r - r) ** 2, (r * (model_phi - phi)) ** 2)
    return CornerFit(*(float(corners[np.argmin(m.sum(axis=1)), 0]) for m in misfits))


def _lag(period: ArrayLike, tau: float) -> Array:
    """`k / omega = period / (2 pi tau)`."""
    periods = finite(period, "period")
    if np.any(periods <= 0.0):
        raise InvalidInput("period must be positive")
    return periods / corner_period(tau)
