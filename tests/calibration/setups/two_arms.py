"""A torso with two arms and a head that pans and tilts, measured from all sides, in files."""

from functools import cache
from pathlib import Path

import numpy as np
from tests.calibration.arm.measured import pose
from tests.calibration.setups.setup_world import MATRIX, PIXEL, pixels, xyz
from tests.robots.made import TORSO

from handeye.arrays import Array
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.arm.tree import OWN_FRAMES, JointTree, Seen, TreeChain
from handeye.geometry import invert, make_pose, transform
from handeye.robots.urdf import UrdfArm

NOISE = 5e-5
SHEET = ArmSheet(compliance=0.0)
CHAINS = {
    "left": ("left_hand", "base"), "right": ("right_hand", "base"), "elbow": ("left_c", "base"),
    "sees left": ("left_hand", "camera"), "sees right": ("right_hand", "camera"),
    "own left": ("left_hand", "torso"), "own right": ("right_hand", "torso"),
}  # fmt: skip
"""By table, the link that carries a marker, and the link of what sees it."""
TOGETHER = tuple(CHAINS)[:5]
APART = tuple(CHAINS)[5:]
"""Arms that share nothing: each has a tracker on the torso of its own."""


@cache
def torso() -> UrdfArm:
    return UrdfArm.from_text(TORSO, "left_hand", "torso")


@cache
def chains() -> dict[str, UrdfArm]:
    return {table: torso().between(*ends) for table, ends in CHAINS.items()}


class TwoArms:
    """The robot with errors as a sheet allows; a tracker beside it, a camera on its head."""

    def __init__(self, seed: int, sheet: ArmSheet = SHEET) -> None:
        self.rng = np.random.default_rng(seed)
        seen = [Seen(arm, np.zeros((0, len(arm.joint_names)))) for arm in chains().values()]
        self.tree = JointTree(seen, sheet.curves, compliant=False)
        tolerance = sheet.tolerances(self.tree.kernel)[OWN_FRAMES:]
        self.x = tolerance * self.rng.standard_normal(len(tolerance))
        self.tracker = make_pose(pose(self.rng)[:3, :3], [2.5, 0.3, 1.2])
        self.camera = pose(self.rng, 0.01, 0.05)
        names = ("left", "right", "elbow")
        self.markers = {name: 0.05 * self.rng.standard_normal(3) for name in names}

    def flanges(self, table: str, joints: Array) -> Array:
        chain = TreeChain(chains()[table], self.tree)
        return chain.poses(self.x, chain.rows(joints))

    def seen(self, table: str, joints: Array) -> Array:
        """Where the marker of a table is before what sees it, (N, 3)."""
        at = self.markers[table.rsplit(maxsplit=1)[-1]]
        eye = self.camera if table.startswith("sees") else self.tracker
        return transform(invert(eye), transform(self.flanges(table, joints), at))

    def joints(self, table: str, n: int) -> Array:
        """Postures (n, m), such as a camera needs to have the marker in its picture."""
        names = chains()[table].joint_names
        if not table.startswith("sees"):
            return self.rng.uniform(-1.5, 1.5, (n, len(names)))
        q = self.rng.uniform(-1.5, 1.5, (60 * n, len(names)))
        q[:, :2] = self.rng.uniform(-0.8, 0.8, (len(q), 2))
        s = self.seen(table, q)
        u, v = pixels(np.maximum(s, [-9.0, -9.0, 0.1]), np.zeros(5)).T
        good = (s[:, 2] > 0.2) & (u > 0.0) & (u < 1919.0) & (v > 0.0) & (v < 1199.0)
        assert good.sum() >= n
        return q[good][:n]

    def write(self, folder: Path, rows: dict[str, int]) -> None:
        """A table of so many rows for each chain that is named."""
        for table, n in rows.items():
            q = self.joints(table, n)
            s = self.seen(table, q)
            if table.startswith("sees"):
                u, v = (pixels(s, np.zeros(5)) + PIXEL * self.rng.standard_normal((n, 2))).T
                columns = {"u_px": u, "v_px": v}
            else:
                columns = xyz(s + NOISE * self.rng.standard_normal((n, 3)))
            header = ",".join([*(f"{name}_rad" for name in chains()[table].joint_names), *columns])
            values = np.column_stack([q, *columns.values()])
            path = folder / f"{table}.csv"
            np.savetxt(path, values, delimiter=",", header=header, comments="", fmt="%.12g")


def entry(table: str) -> str:
    """Of a description."""
    link, base = CHAINS[table]
    name = f"{table.rsplit(maxsplit=1)[-1]} marker"
    if table.startswith("sees"):
        return (
            f"  - {{kind: pixels, file: {table}.csv, camera: eye, link: {link}, base: {base},"
            f" target: {name}}}\n"
        )
    sensor = f"tracker of {name}" if table in APART else "tracker"
    return (
        f"  - {{kind: points, file: {table}.csv, sensor: {sensor}, link: {link}, base: {base},"
        f" target: {name}}}\n"
    )


def described_torso(
    folder: Path, world: TwoArms, rows: dict[str, int], end: str = "arm: {compliance: 0}\n"
) -> Path:
    """The description beside its tables."""
    (folder / "torso.urdf").write_text(TORSO, encoding="utf-8")
    world.write(folder, rows)
    text = "robot: torso.urdf\nmeasurements:\n" + "".join(entry(table) for table in rows)
    if any(table.startswith("sees") for table in rows):
        matrix = ", ".join(map(str, MATRIX))
        text += f"cameras:\n  eye: {{matrix: [{matrix}], size: [1920, 1200]}}\n"
    path = folder / "setup.yaml"
    path.write_text(text + end, encoding="utf-8")
    return path
