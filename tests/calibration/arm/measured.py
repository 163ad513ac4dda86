"""One made-up measurement of every kind, without noise, and the truth behind it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.arrays import Array, Integers
from handeye.calibration.arm.measurements import (
    Distances,
    Frame,
    Instrument,
    Numbers,
    PixelSightings,
    PlaneContacts,
    Points,
    PointSightings,
    PoseSightings,
    Sight,
    StereoSightings,
    Touches,
    lens,
)
from handeye.calibration.arm.measurements.seeing import PointInstrument
from handeye.geometry import make_pose

N = 12


def inverse(T: Array) -> Array:
    """Of poses, the slow way."""
    return np.asarray(np.linalg.inv(T), np.float64)


def pose(rng: np.random.Generator, shift: float = 0.3, turn: float = 3.0) -> Array:
    return make_pose(
        Rotation.from_rotvec(turn * rng.uniform(-0.55, 0.55, 3)).as_matrix(),
        shift * rng.standard_normal(3),
    )


def flanges(rng: np.random.Generator, n: int = N) -> Array:
    return np.array([pose(rng) for _ in range(n)])


def looking(rng: np.random.Generator, away: float = 2.0) -> Array:
    """T_base_camera (4, 4) of a camera at some distance that looks at the base's origin."""
    R = Rotation.from_rotvec(rng.uniform(-1.0, 1.0, 3)).as_matrix()
    return make_pose(R, -away * R[:, 2] + 0.1 * rng.standard_normal(3))


def sight(rng: np.random.Generator, setup: str, places: Array, which: Integers) -> Sight:
    camera = looking(rng)
    return Sight(
        setup,  # pyright: ignore[reportArgumentType]
        Frame.near("sensor", camera),
        Frame.near("target", pose(rng, 0.1)),
        Points.near("points", places),
        which,
    )


def some(rng: np.random.Generator) -> dict[str, object]:
    which = np.concatenate([np.arange(4), rng.integers(0, 4, N - 4)])
    return {"places": 0.1 * rng.standard_normal((4, 3)), "which": which}


def points(rng: np.random.Generator, setup: str) -> Instrument:
    return PointSightings(
        joints=np.zeros((N, 6)), measured=rng.standard_normal((N, 3)), name="tracker",
        sight=sight(rng, setup, **some(rng)),  # pyright: ignore[reportArgumentType]
    )  # fmt: skip


def poses(rng: np.random.Generator, setup: str) -> Instrument:
    return PoseSightings(
        joints=np.zeros((N, 6)), measured=flanges(rng), std=np.full((N, 6), 1e-4), name="probe",
        sight=Sight(
            setup,  # pyright: ignore[reportArgumentType]
            Frame.near("sensor", pose(rng)), Frame.near("target", pose(rng)),
            Points.known(), np.zeros(N, np.int64),
        ),
    )  # fmt: skip


CAMERA = lens("eye", (900.0, 910.0, 640.0, 360.0), (-0.2, 0.05, 1e-3, -2e-3, 0.01), 1.0)


def pixels(rng: np.random.Generator, setup: str) -> Instrument:
    return PixelSightings(
        joints=np.zeros((N, 6)), measured=rng.uniform(0.0, 700.0, (N, 2)), name="left",
        sight=sight(rng, setup, **some(rng)), camera=CAMERA,  # pyright: ignore[reportArgumentType]
    )  # fmt: skip


def touches(rng: np.random.Generator) -> Instrument:
    made = some(rng)
    base = sight(rng, "eye_to_hand", np.zeros((1, 3)), np.zeros(N, np.int64))
    return Touches(
        joints=np.zeros((N, 6)), measured=np.zeros((N, 3)), sight=base,
        places=Points.near("sockets", made["places"]), touched=made["which"],  # pyright: ignore[reportArgumentType]
    )  # fmt: skip


def distances(rng: np.random.Generator) -> Instrument:
    zero = Numbers("zero", np.array([0.01]), np.array([0.02]), (("zero", "m"),))
    base = sight(rng, "eye_to_hand", np.zeros((1, 3)), np.zeros(N, np.int64))
    return Distances(
        joints=np.zeros((N, 6)), measured=np.ones((N, 1)), sight=base, zero=zero, std=np.array(1e-4)
    )


def contacts(rng: np.random.Generator) -> Instrument:
    base = sight(rng, "eye_to_hand", np.zeros((1, 3)), np.zeros(N, np.int64))
    return PlaneContacts(joints=np.zeros((N, 6)), measured=np.zeros((N, 1)), sight=base)


def stereo(rng: np.random.Generator) -> Instrument:
    optics = Numbers(
        "optics", np.full(3, 0.1), np.array([0.04, 0.03, 0.9]),
        (("eta", "rad"), ("zeta", ""), ("sigma", "")),
    )  # fmt: skip
    base = sight(rng, "eye_to_hand", np.zeros((1, 3)), np.zeros(N, np.int64))
    return StereoSightings(
        joints=np.zeros((N, 6)), measured=rng.uniform(0.5, 1.0, (N, 2)), sight=base, optics=optics,
        pointing=rng.uniform(-1.0, 1.0, N),
    )  # fmt: skip


KINDS: dict[str, Callable[[np.random.Generator], Instrument]] = {
    "points, eye to hand": lambda rng: points(rng, "eye_to_hand"),
    "points, eye in hand": lambda rng: points(rng, "eye_in_hand"),
    "poses, eye to hand": lambda rng: poses(rng, "eye_to_hand"),
    "poses, eye in hand": lambda rng: poses(rng, "eye_in_hand"),
    "pixels, eye to hand": lambda rng: pixels(rng, "eye_to_hand"),
    "pixels, eye in hand": lambda rng: pixels(rng, "eye_in_hand"),
    "touches": touches,
    "distances": distances,
    "plane contacts": contacts,
    "stereo head": stereo,
}
"""Every kind; a new one is registered here."""


def zeros(instrument: Instrument) -> tuple[Array, ...]:
    return tuple(np.zeros(len(block.names)) for block in instrument.blocks)


def predicted(instrument: Instrument, poses: Array, own: tuple[Array, ...]) -> Array:
    """(N, k) what is predicted of values that are no poses."""
    assert isinstance(instrument, PointInstrument)
    return instrument.measured - instrument.equations(poses, own).residuals


def as_measured(instrument: Instrument, poses: Array) -> Instrument:
    """The same with measurements that its references would give without error."""
    if isinstance(instrument, PoseSightings):
        return replace(instrument, measured=instrument.poses(poses, zeros(instrument)))
    return replace(instrument, measured=predicted(instrument, poses, zeros(instrument)))  # pyright: ignore[reportCallIssue]
