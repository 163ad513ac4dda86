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
    (placed,), left = _together([instrument], [flanges])
    return placed, left


def agreeing(instruments: Sequence[Instrument], flanges: Sequence[Array]) -> list[Instrument]:
    """The same instruments, where what has one name in several has one reference.

    At first it is the first one's, and what else the later ones do not know is `settled` again
    beside it; then all are, together. flanges: nominal T_base_flange (N, 4, 4) of each.

    Raises:
        InvalidInput: two different things have the same name.
    """
    found: dict[str, Unknown] = {}
    out: list[Instrument] = []
    agreed = False
    for instrument, poses in zip(instruments, flanges, strict=True):
        shared = {
            block.name: found[block.name] for block in instrument.blocks if block.name in found
        }
        placed = instrument
        if shared:
            agreed = True
            held = instrument.given({name: one.held() for name, one in shared.items()})
            placed = settled(held, poses)[0].given(shared)
        found |= {unknown.name: unknown for unknown in placed.unknowns if unknown.free.any()}
        out.append(placed)
    return _together(out, flanges)[0] if agreed else out


def _together(
    instruments: Sequence[Placed], flanges: Sequence[Array]
) -> tuple[list[Placed], float]:
    """`settled` for several that share what has one name."""
    placed = list(instruments)
    left = [_left(one, poses) for one, poses in zip(placed, flanges, strict=True)]
    if any(one.blocks for one in placed):
        for _ in range(_TIMES):
            placed = _fitted(placed, flanges, left)
            before = left
            left = [_left(one, poses) for one, poses in zip(placed, flanges, strict=True)]
            if _size(left) > _WORTH * _size(before):
                break
    return placed, _size(left)


def _fitted(
    instruments: Sequence[Placed], flanges: Sequence[Array], scales: Sequence[Array]
) -> list[Placed]:
    blocks = {block.name: block for one in instruments for block in one.blocks}
    ends = list(accumulate((len(block.names) for block in blocks.values()), initial=0))
    places = dict(zip(blocks, map(slice, ends, ends[1:]), strict=False))
    wide = _WIDE * np.concatenate([block.tolerance for block in blocks.values()])

    def linearised(z: Array) -> tuple[Array, Array]:
        x, residuals, slopes = wide * z, [z], [np.eye(len(z))]
        for one, poses, scale in zip(instruments, flanges, scales, strict=True):
            own = tuple(x[places[block.name]] for block in one.blocks)
            r, _, by_blocks = one.equations(poses, own)
            by_all = np.zeros((*r.shape, len(z)))
            for block, by_block in zip(one.blocks, by_blocks, strict=True):
                at = places[block.name]
                by_all[:, :, at] = by_block * wide[at] / scale[:, np.newaxis]
            residuals.append((r / scale).reshape(-1))
            slopes.append(by_all.reshape(-1, len(z)))
        return np.concatenate(residuals), np.concatenate(slopes)

    found: Any = least_squares(
        lambda z: linearised(z)[0], np.zeros(len(wide)), lambda z: linearised(z)[1],
        loss="soft_l1", x_scale="jac", max_nfev=_ROUNDS,
    )  # fmt: skip
    x = cast("Array", wide * found.x)
    changes = {name: x[at] for name, at in places.items()}
    return [one.moved(changes) for one in instruments]


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


def _size(left: Sequence[Array]) -> float:
    return float(np.linalg.norm(np.concatenate(left)))
