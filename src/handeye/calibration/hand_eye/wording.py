"""What the samples leave open, in words, and which poses would tell it."""

from typing import NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.calibration.hand_eye.samples import Setup
from handeye.calibration.hand_eye.turns import turned_by

# A part of a direction smaller than this goes unmentioned: of a turn [rad per unit].
_MENTIONED = 1e-2
# Turns of the flange about an axis count from this size on, as a share of the largest.
_TURNS = 0.1
# A flange that turns less than this does not turn [rad].
_LEAST_TURN = 0.02
_FEW = 10


class Names(NamedTuple):
    """What sits on the flange, and what in the world."""

    on_flange: str
    in_base: str


NAMES: dict[Setup, Names] = {
    "eye_in_hand": Names("camera", "target"),
    "eye_to_hand": Names("target", "camera"),
}


def in_words(changes: Array, name: str, distance: float) -> tuple[str, ...]:
    """Names for the space spanned by columns (7, k): turn and shift on the flange, growth of scale.

    distance [m] makes a turn comparable with a shift.
    """
    if not changes.shape[1]:
        return ()
    scaled = changes * np.array([distance] * 3 + [1.0] * 3 + [distance])[:, None]
    left, sizes, _ = np.linalg.svd(scaled, full_matrices=False)
    scaled = left[:, sizes > _MENTIONED * sizes[0]]
    words: list[str] = []
    growing, scaled = _split(scaled, slice(6, 7))
    turning, shifting = _split(scaled, slice(0, 3))
    if growing.shape[1]:
        words.append("the scale of what the camera measures")
    words += _along(turning[:3], f"orientation of the {name} about", "in every way")
    words += _along(shifting[3:6], f"translation of the {name} along", "in any direction")
    return tuple(words)


def _split(space: Array, rows: slice) -> tuple[Array, Array]:
    """Parts of a space (n, k) that change these rows, and the part that does not."""
    if not space.shape[1]:
        return space, space
    _, sizes, right = np.linalg.svd(space[rows])
    sizes = np.concatenate([sizes, np.zeros(len(right) - len(sizes))])
    does = sizes > _MENTIONED
    return space @ right[does].T, space @ right[~does].T


def _along(space: Array, what: str, everywhere: str) -> list[str]:
    k = space.shape[1]
    if k == 0:
        return []
    left, _, _ = np.linalg.svd(space, full_matrices=True)
    if k >= 3:
        return [f"{what.rsplit(' ', 1)[0]} {everywhere}"]
    if k == 1:
        return [f"{what} {_vector(left[:, 0])} of the flange"]
    # A plane of directions is easier to read as the one that is left.
    how = "across" if what.endswith("along") else "about any axis across"
    return [f"{what.rsplit(' ', 1)[0]} {how} {_vector(left[:, 2])} of the flange"]


def _vector(v: Array) -> str:
    v = v * np.sign(v[np.argmax(np.abs(v))])
    return "(" + ", ".join(f"{c:.2f}" for c in np.round(v, 2) + 0.0) + ")"


def turning_axes(flanges: Array) -> tuple[int, Array]:
    """About how many axes the flange turns, and the main one in its own axes (3,)."""
    R = flanges[:, :3, :3]
    pairs = turned_by(R[:, None].swapaxes(-1, -2) @ R[None]).reshape(-1, 3)
    _, sizes, axes = np.linalg.svd(pairs, full_matrices=False)
    sizes = sizes / np.sqrt(len(pairs))
    if sizes[0] < _LEAST_TURN:
        return 0, axes[0]
    return int(np.sum(sizes > max(_TURNS * sizes[0], _LEAST_TURN))), axes[0]


def advice(flanges: Array, names: Names) -> str:
    """Which poses to add."""
    count, axis = turning_axes(flanges)
    if count == 0:
        return "the flange does not turn: add poses that turn it about two axes by 30 degrees"
    if count == 1:
        return (
            f"the flange turns about its axis {_vector(axis)} only: add poses that turn it about "
            "another axis by 30 degrees or more"
        )
    if len(flanges) < _FEW:
        return "add poses: some dozens are good, turned by 30 degrees or more about different axes"
    return (
        "the samples scatter more than the motion can average: turn the flange farther, bring "
        f"{names.on_flange} and {names.in_base} nearer to each other, and check setup, units and "
        "which pose belongs to which"
    )
