"""Shapes and finiteness, checked once at every public boundary."""

from collections.abc import Sequence
from operator import index
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from handeye.errors import InvalidInput

Array = NDArray[np.float64]
"""Every real array of the package: double precision."""

Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]


def finite(value: ArrayLike, name: str) -> Array:
    """`value` as a double array (shared if it is one), or InvalidInput if not finite numbers."""
    try:
        raw: NDArray[Any] = np.asarray(value)
    except ValueError as ragged:
        raise InvalidInput(f"{name} is ragged: every row needs the same length") from ragged
    if raw.dtype.kind not in "biuf":
        raise InvalidInput(f"{name} must be real numbers, got an array of type {raw.dtype}")
    array = np.ascontiguousarray(raw, dtype=np.float64).reshape(raw.shape)
    if not np.isfinite(array).all():
        bad = np.argwhere(~np.isfinite(array))
        where = f" at index {tuple(int(i) for i in bad[0])}" if array.ndim else ""
        raise InvalidInput(f"{name} must be finite, got {array[tuple(bad[0])]}{where}")
    return array


def shaped(value: ArrayLike, shape: Sequence[int | None], name: str) -> Array:
    """`value` as a finite double array of `shape`, where None allows any length.

    Example: `shaped(points, (None, 3), "points")` accepts (N, 3).
    """
    array = finite(value, name)
    fits = array.ndim == len(shape) and all(
        want is None or want == have for want, have in zip(shape, array.shape, strict=True)
    )
    if not fits:
        wanted = ", ".join("N" if n is None else str(n) for n in shape)
        raise InvalidInput(f"{name} must have shape ({wanted}), got {array.shape}")
    return array


def scalar(
    value: float, name: str, *, above: float | None = None, least: float | None = None
) -> float:
    """`value` as a finite float that is `> above` and `>= least`, or InvalidInput."""
    number = float(shaped(value, (), name))
    if above is not None and not number > above:
        raise InvalidInput(f"{name} must be greater than {above}, got {number}")
    if least is not None and not number >= least:
        raise InvalidInput(f"{name} must be at least {least}, got {number}")
    return number


def count(value: SupportsIndex, name: str, *, least: int = 1) -> int:
    """`value` as an int of at least `least`, or InvalidInput; a truth value is no count."""
    try:
        number = index(value)
    except TypeError:
        number = None
    if number is None or isinstance(value, bool | np.bool_) or number < least:
        raise InvalidInput(f"{name} must be a whole number of at least {least}, got {value!r}")
    return number
