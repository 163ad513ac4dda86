"""Poses that would agree if they had been meant in another way.

A table of poses does not say what its author meant by it. Where samples disagree by more than any
camera errs, each usual mistake is undone and the closed forms (`starts`) try again; the one without
which the samples agree is named. Some mistakes make no sample disagree, and can only be guessed
from where they would put things.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from handeye.arrays import Array
from handeye.calibration.hand_eye.model import Guess
from handeye.calibration.hand_eye.samples import Samples, Setup
from handeye.calibration.hand_eye.starts import disagreements, starts
from handeye.calibration.hand_eye.wording import NAMES
from handeye.geometry import invert, make_pose, matrix_from_wxyz, wxyz_from_matrix

# Disagreement that noise alone explains, and that it can explain: turn [rad], share of distance.
_ORDINARY, _NOISY = 0.02, 0.05
# Below this, samples agree as well as any: turn [rad], and share of the distance.
_EXACT = 1e-4
# Turn times shift must become so many times smaller, and so many more if the unit is free too.
_BETTER, _BY_UNIT = 20.0, 3.0
# Fewer samples may agree with a mistake by chance: three can always be made to.
_FEWEST = 8
_TRIPLES = 40
# A robot is no larger than this, and what is mounted on a flange no farther away [m].
_HALL, _MOUNTED = 20.0, 0.4
# Lengths reported for one metre, and the unit of which they speak.
_UNITS = {1000.0: "millimetres", 100.0: "centimetres", 39.37: "inches"}
_NEAR_UNIT = 0.1

_OTHER: dict[Setup, Setup] = {"eye_in_hand": "eye_to_hand", "eye_to_hand": "eye_in_hand"}


class Reading(NamedTuple):
    """What the poses are if a mistake was made; the mistake in words."""

    mistake: str
    flanges: Array
    sensed: Array


def mistakes(samples: Samples, guess: Guess, *others: Reading) -> tuple[str, ...]:
    """What was probably meant in another way, in words; empty if nothing speaks for it.

    guess: as the samples are. others: readings to try besides the usual ones.
    """
    as_is = _sizes(samples, guess)
    if max(as_is) < _ORDINARY or len(samples.order) < _FEWEST:
        return implausible(samples, guess)
    best, found = _rank(as_is) - np.log(_BETTER), ""
    for free_scale in (False, True):
        best -= np.log(_BY_UNIT) * free_scale
        for mistake, flanges, sensed in (*_readings(samples), *others):
            read = Samples.of(flanges, sensed, samples.setup, in_order=False)
            for start in starts(read, free_scale=free_scale, tied=False, triples=_TRIPLES):
                sizes = _sizes(read, start)
                if max(sizes) < _NOISY and _rank(sizes) < best:
                    unit = _unit(start.scale) if free_scale else ""
                    best, found = _rank(sizes), ", and ".join(filter(None, (mistake, unit)))
    if not found:
        return implausible(samples, guess)
    return (f"the poses would agree if this were a mistake: {found}",)


def implausible(samples: Samples, guess: Guess) -> tuple[str, ...]:
    """Mistakes that no disagreement gives away, guessed from where things would be."""
    out: list[str] = []
    places = samples.flanges[:, :3, 3]
    extent = float(np.linalg.norm(places.max(axis=0) - places.min(axis=0)))
    if extent > _HALL:
        out.append(f"the flange would move over {extent:.0f} m: give positions in metres")
    in_hand = samples.setup == "eye_in_hand"
    X, Z = (guess.camera, guess.target) if in_hand else (guess.target, guess.camera)
    on_flange, in_base = (float(np.linalg.norm(T[:3, 3])) for T in (X, Z))
    if extent <= _HALL and on_flange > max(_MOUNTED, 2.0 * in_base):
        names = NAMES[samples.setup]
        either = "either poses of flange and target were exchanged, or " if in_hand else ""
        out.append(
            f"the {names.on_flange} would be {on_flange:.2f} m from the flange and the "
            f"{names.in_base} {in_base:.2f} m from the base: if that is not so, {either}they "
            "are T_flange_base and T_target_camera, the inverse of what is asked for"
        )
    return tuple(out)


def _sizes(samples: Samples, guess: Guess) -> tuple[float, float]:
    """Median turn [rad] and shift, as a share of the distance, by which samples miss a guess."""
    one = guess.camera[None], guess.target[None], np.array([guess.scale])
    turn, shift = disagreements(samples, *one)
    return float(turn[0]), float(shift[0]) * guess.scale / samples.distance


def _rank(sizes: tuple[float, float]) -> float:
    return float(np.sum(np.log(np.array(sizes) + _EXACT)))


def _readings(samples: Samples) -> Iterator[Reading]:
    A, S = samples.as_given(samples.flanges), samples.as_given(samples.sensed)
    yield Reading("", A, S)
    # To invert the one or the other makes the same equation, with camera and target exchanged.
    inverted = (
        "either the target's poses are T_target_camera, the inverse of T_camera_target, or the "
        "flange's are T_flange_base, the inverse of T_base_flange, or the setup is "
    )
    yield Reading(f"{inverted}{_OTHER[samples.setup]}", A, invert(S))
    for read, meant, by in (("w, x, y, z", "x, y, z, w", 1), ("x, y, z, w", "w, x, y, z", -1)):
        words = f"the quaternions of {{}} were read as {read} but are {meant}"
        yield Reading(words.format("the flange"), _reordered(A, by), S)
        yield Reading(words.format("the target"), A, _reordered(S, by))
        yield Reading(words.format("flange and target"), _reordered(A, by), _reordered(S, by))
    words = "the rotation matrices of {} are transposed, columns where rows belong"
    yield Reading(words.format("the flange"), _transposed(A), S)
    yield Reading(words.format("the target"), A, _transposed(S))
    yield Reading(words.format("flange and target"), _transposed(A), _transposed(S))
    yield Reading(
        "each pose of the target belongs to the one of the flange before it", A[:-1], S[1:]
    )
    yield Reading(
        "each pose of the target belongs to the one of the flange after it", A[1:], S[:-1]
    )


def _reordered(T: Array, by: int) -> Array:
    """The four numbers of each quaternion (w, x, y, z) moved on by so many places."""
    return make_pose(matrix_from_wxyz(np.roll(wxyz_from_matrix(T[:, :3, :3]), by, 1)), T[:, :3, 3])


def _transposed(T: Array) -> Array:
    return make_pose(T[:, :3, :3].swapaxes(1, 2), T[:, :3, 3])


def _unit(scale: float) -> str:
    for size, name in _UNITS.items():
        if abs(np.log(scale / size)) < _NEAR_UNIT:
            return f"the target's positions are in {name}, the flange's in metres"
        if abs(np.log(scale * size)) < _NEAR_UNIT:
            return f"the flange's positions are in {name}, the target's in metres"
    return (
        f"the camera's lengths are {scale:.3g} times what they should be: check the size of the "
        "target that it was told, or estimate its unit (free_scale)"
    )
