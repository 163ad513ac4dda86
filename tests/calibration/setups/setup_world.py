"""An arm with errors, where it can go, and tables of what is measured of it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from tests.calibration.arm.arms import arm

from handeye.arrays import Array
from handeye.calibration.arm.measurements import Frame, PlaneContacts, Points, Sight
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.geometry import invert

SHEET = replace(ArmSheet(), compliance=0.0, curves=CurveTerms(0, 0))
PLAIN = "arm: {compliance: 0}\ncurves: {own: 0, others: 0}\n"
MATRIX, LENS = (1200.0, 1210.0, 960.0, 600.0), (-0.1, 0.03, 1e-3, -5e-4, 0.0)
GRID = np.array([(0.04 * i, 0.04 * k, 0.0) for k in range(4) for i in range(5)])
FAR, NEAR, PIXEL = 5e-5, 5e-5, 0.15

Place = Callable[[Array], Array]


class Truth(NamedTuple):
    """Text of the description, and what is true of what it names: poses, points or numbers."""

    text: str
    of: Mapping[str, Array]


@cache
def nominal() -> ArmProblem:
    sight = Sight("eye_to_hand", Frame.near("p", np.eye(4)), Frame.known(), Points.known(), [0])  # pyright: ignore[reportArgumentType]
    row = PlaneContacts(joints=np.zeros((1, 6)), measured=np.zeros((1, 1)), sight=sight)
    return ArmProblem(arm(), [row], SHEET, SHEET.curves)


class World:
    """An arm with errors as its sheet allows, and a folder for tables."""

    def __init__(self, folder: Path, seed: int) -> None:
        self.folder, self.rng = folder, np.random.default_rng(seed)
        problem = nominal()
        self.x = problem.tolerance * self.rng.standard_normal(len(problem.tolerance))
        self.x[problem.n_arm :] = 0.0

    def flanges(self, joints: Array) -> Array:
        return nominal().flanges(self.x, joints)

    def joints(self, n: int) -> Array:
        return self.rng.uniform(-2.0, 2.0, (n, 6))

    def reaching(self, n: int, wanted: Place, std: float = 0.0) -> Array:
        """Joints (n, 6) where wanted (N, k), of poses (N, 4, 4), is noise: Newton from anywhere."""
        found: list[Array] = []
        while len(found) < n:
            q = self.joints(4 * n)
            off = self.noise(std, *wanted(self.flanges(q)).shape)

            def misses(flanges: Array, off: Array = off) -> Array:
                return wanted(flanges) - off

            for _ in range(40):
                r = misses(self.flanges(q))
                steps = 1e-6 * np.eye(6)
                J = np.stack([(misses(self.flanges(q + d)) - r) / 1e-6 for d in steps], axis=-1)
                step = -np.einsum("nij,nj->ni", np.linalg.pinv(J, rcond=1e-3), r)
                q = q + np.clip(step, -0.3, 0.3)
            good = (np.abs(misses(self.flanges(q))) < 1e-9).all(axis=1)
            found += list(q[good & (np.abs(q) < 3.0).all(axis=1)])
        return np.array(found[:n])

    def noise(self, std: float, *shape: int) -> Array:
        return std * self.rng.standard_normal(shape)

    def table(self, name: str, joints: Array, **columns: Array) -> None:
        header = ",".join([*(f"{j}_rad" for j in arm().joint_names), *columns])
        rows = np.column_stack([joints, *columns.values()])
        path = self.folder / name
        np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.12g")


def pixels(s: Array, lens: Array | tuple[float, ...] = LENS) -> Array:
    k1, k2, p1, p2, _ = lens
    a, b = s[:, 0] / s[:, 2], s[:, 1] / s[:, 2]
    q = a**2 + b**2
    g = 1.0 + k1 * q + k2 * q**2
    u = a * g + 2.0 * p1 * a * b + p2 * (q + 2.0 * a**2)
    v = b * g + p1 * (q + 2.0 * b**2) + 2.0 * p2 * a * b
    return np.column_stack([u, v]) * MATRIX[:2] + MATRIX[2:]


def xyz(points: Array) -> dict[str, Array]:
    return dict(zip(("x_m", "y_m", "z_m"), points.T, strict=True))


def carried(world: World, joints: Array, setup: str) -> Array:
    A = world.flanges(joints)
    return A if setup == "eye_to_hand" else invert(A)
