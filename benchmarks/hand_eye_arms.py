"""Hand-eye calibration with an arm that errs, on many simulated sets.

    python benchmarks/hand_eye_arms.py [--sets 30] [--first 100] [--json FILE]

kinhec's track robot_error has two sequences in the tier `smoke`, which is too few to tell solvers
apart. Here the same arm, a Puma 560, and the same errors are drawn anew for as many sets as asked
for: 15 stations from which a camera on the flange sees the target within 25 degrees of its axis and
0.25 to 1 m away, 2 mrad and 1, 1 and 3 mm of noise of the camera, and of the arm either 1 mrad of
every joint's reading ("joints"), or 1 mm and 0.1 degrees of every DH number and 0.1 mrad of
readings ("geometry"). Compared are kinhec's best solvers on that track.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from hand_eye import Arm
from kinhec import se3
from kinhec.generator import perturbed_model
from kinhec.kinematics import forward_kinematics_batch
from kinhec.noise import camera_se3_gaussian
from kinhec.robots import get_robot
from kinhec.solvers.axxb import park_martin
from kinhec.solvers.axyb import refine_lm_axyb, shah
from rich.console import Console
from rich.progress import track
from rich.table import Table

from handeye.arrays import Array
from handeye.calibration.hand_eye import solve, solve_arm
from handeye.geometry import invert

STATIONS, KINDS = 15, ("joints", "geometry")
CONE, NEAR, FAR = np.radians(25.0), 0.25, 1.0
SPREAD = np.array([0.5, 0.5, 0.5, 1.2, 1.2, 1.5])
TURN, SHIFT = 2e-3, (1e-3, 1e-3, 3e-3)


def stations(rng: np.random.Generator, true: Any, X: Array) -> tuple[Array, Array]:
    """Joints (N, 6) from which the target is in view, and where it is (4, 4)."""
    low, high = np.array(true.q_min), np.array(true.q_max)
    middle = rng.uniform(0.3 * low, 0.3 * high)
    ahead = se3.make_transform(se3.random_rotation(rng), np.array([0, 0, rng.uniform(0.4, 0.8)]))
    target = forward_kinematics_batch(true, middle[None])[0] @ X @ ahead
    found = np.empty((0, 6))
    while len(found) < STATIONS:
        q = np.clip(middle + rng.uniform(-1.0, 1.0, (200, 6)) * SPREAD, low, high)
        place = (invert(forward_kinematics_batch(true, q) @ X) @ target)[:, :3, 3]
        away = np.linalg.norm(place, axis=1)
        seen = (place[:, 2] > np.cos(CONE) * away) & (away > NEAR) & (away < FAR)
        found = np.concatenate([found, q[seen]])
    return found[:STATIONS], target


def one_set(kind: str, number: int) -> Iterator[tuple[str, float, float]]:
    """Solver, and by how much X is wrong [mm], [degrees]."""
    robot, arm = get_robot("puma560"), Arm("puma560")
    rng = np.random.default_rng((number, kind == "geometry"))
    X = se3.make_transform(se3.random_rotation(rng), rng.normal(size=3) * 0.05)
    true = robot if kind == "joints" else perturbed_model(robot, rng, 1e-3, np.radians(0.1))
    q, target = stations(rng, true, X)
    S = camera_se3_gaussian(
        rng, invert(forward_kinematics_batch(true, q) @ X) @ target, TURN, SHIFT
    )
    q = q + rng.normal(0.0, 1e-3 if kind == "joints" else 1e-4, q.shape)
    A, B = arm.poses(q), invert(S)
    start = shah(A, B)
    i, j = np.triu_indices(len(A), 1)
    found = {
        "handeye": solve(A, S).X,
        "handeye, with the arm": solve_arm(arm, q, S).X,
        "shah": start[0],
        "shah+lm": refine_lm_axyb(A, B, *start)[0],
        "park_martin, all pairs": park_martin(invert(A[i]) @ A[j], S[i] @ invert(S[j])),
    }
    for solver, each in found.items():
        turn, shift = se3.pose_error(each, X)
        yield solver, float(shift), float(turn)


def main(
    sets: Annotated[int, typer.Option(min=1)] = 30,
    first: Annotated[int, typer.Option(help="Number of the first set.")] = 100,
    file: Annotated[Path | None, typer.Option("--json", help="Where to write the numbers.")] = None,
) -> None:
    """Solve all sets and print a table for each kind of error."""
    numbers: list[dict[str, Any]] = []
    for kind in KINDS:
        rows: dict[str, list[tuple[float, float]]] = {}
        for number in track(range(first, first + sets), kind, console=Console(stderr=True)):
            for solver, shift, turn in one_set(kind, number):
                rows.setdefault(solver, []).append((shift, turn))
        table = Table("", "mm, median", "mm, mean", "deg, median", "deg, mean",
                      title=f"errors of the {kind}: {sets} sets")  # fmt: skip
        for solver, errors in rows.items():
            mm, deg = np.array(errors).T
            table.add_row(
                solver, f"{np.median(mm):.3f}", f"{mm.mean():.3f}", f"{np.median(deg):.4f}",
                f"{deg.mean():.4f}",
            )  # fmt: skip
            numbers += [{"kind": kind, "solver": solver, "mm": mm.tolist(), "deg": deg.tolist()}]
        Console().print(table)
    if file is not None:
        file.write_text(json.dumps(numbers), encoding="utf-8")


if __name__ == "__main__":
    typer.run(main)
