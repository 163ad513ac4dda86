"""Where instruments and targets are, before anything is known of the errors of the arm."""

from collections.abc import Sequence
from itertools import accumulate
from typing import Any, TypeVar, cast

import numpy as np
from scipy.optimize import least_squares

from handeye.arrays import Array
from handeye.calibration.arm.measurements.seeing import Instrument
from handeye.calibration.arm.measurements.unknowns import Unknown

# Tolerances are for what is left after the fit of the whole arm; a start may be this much worse.
_WIDE = 10.0
_LEAST = 1e-9
_TIMES, _ROUNDS = 10, 50
# What is left must become smaller than this part of itself for another fit to be worth it.
_WORTH = 0.9

Placed = TypeVar("Placed", bound=Instrument)


def settled(instrument: Placed, flanges: Array) -> tuple[Placed, float]:
    """The same instrument, with references where they fit best on an arm without errors.

    Least squares with a soft L1 loss of residuals over the median of their channel, and of unknowns
    over ten times their tolerance: again from where that ends, as long as it helps, so that only
    what the rows leave open stays near where it began. flanges: nominal T_base_flange (N, 4, 4).
    Returns too the median of what is left, which tells a better start from a worse one.
    """
    widths = [_WIDE * block.tolerance for block in instrument.blocks]
    left = _left(instrument, flanges)
    if not widths:
        return instrument, float(np.linalg.norm(left))
    for _ in range(_TIMES):
        placed = _fitted(instrument, flanges, widths, left)
        before, left = left, _left(placed, flanges)
        instrument = placed
        if np.linalg.norm(left) > _WORTH * np.linalg.norm(before):
            break
    return instrument, float(np.linalg.norm(left))


def agreeing(instruments: Sequence[Instrument], flanges: Sequence[Array]) -> list[Instrument]:
    """The same instruments, where what has one name in several has one reference.

    It is the first one's; what else the later ones do not know is `settled` again beside it.
    flanges: nominal T_base_flange (N, 4, 4) of each.

    Raises:
        InvalidInput: two different things have the same name.
    """
    found: dict[str, Unknown] = {}
    out: list[Instrument] = []
    for instrument, poses in zip(instruments, flanges, strict=True):
        shared = {
            block.name: found[block.name] for block in instrument.blocks if block.name in found
        }
        placed = instrument
        if shared:
            held = instrument.given({name: one.held() for name, one in shared.items()})
            placed = settled(held, poses)[0].given(shared)
        found |= {unknown.name: unknown for unknown in placed.unknowns if unknown.free.any()}
        out.append(placed)
    return out


def _fitted(instrument: Placed, flanges: Array, widths: Sequence[Array], scale: Array) -> Placed:
    wide, ends = np.concatenate(widths), list(accumulate(map(len, widths)))[:-1]

    def linearised(z: Array) -> tuple[Array, Array]:
        r, _, by_blocks = instrument.equations(flanges, tuple(np.split(wide * z, ends)))
        slopes = np.concatenate(by_blocks, axis=2) * wide / scale[:, np.newaxis]
        return (
            np.concatenate([z, (r / scale).reshape(-1)]),
            np.concatenate([np.eye(len(z)), slopes.reshape(-1, len(z))]),
        )

    found: Any = least_squares(
        lambda z: linearised(z)[0], np.zeros(len(wide)), lambda z: linearised(z)[1],
        loss="soft_l1", x_scale="jac", max_nfev=_ROUNDS,
    )  # fmt: skip
    x = cast("Array", wide * found.x)
    names = [block.name for block in instrument.blocks]
    return instrument.moved(dict(zip(names, np.split(x, ends), strict=True)))


def linear(system: Array, wanted: Array) -> Array:
    """x (m,) of the least squares of system (..., m) x = wanted, the shortest if there are many."""
    flat = wanted.reshape(-1)
    return cast("Array", np.linalg.lstsq(system.reshape(len(flat), -1), flat, rcond=None)[0])


def _left(instrument: Instrument, flanges: Array) -> Array:
    """(k,) median size of residuals at the references, or the least that counts."""
    own = tuple(np.zeros(len(block.names)) for block in instrument.blocks)
    r = instrument.equations(flanges, own).residuals
    size = np.median(np.abs(r), axis=0) if len(r) else np.ones(r.shape[1])
    return np.maximum(size, _LEAST)
