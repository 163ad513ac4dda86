"""Hand-eye calibration beside kinhec's eleven solvers and OpenCV's seven, on kinhec's benchmark.

    python benchmarks/hand_eye.py [--tier smoke] [--data FOLDER] [--json FILE]

kinhec generates its sequences itself (`smoke`: 46 in a minute) and chooses the keyframes; every
solver gets the same ones. Ours is also told what a user knows of the camera: whether it measures
metres (track monocular) and whether it counts its way (visual odometry). The arm's joints and
nominal model are given where the reported poses are no more than these (track robot_error); there
both `solve` and `solve_arm` are shown. Motions about one axis do not determine the result and have
a table of their own, with what we say about each.
"""

import json
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import cv2
import kinhec
import numpy as np
import typer
from kinhec import benchmark as protocol
from kinhec import se3
from kinhec.cli import main as kinhec_command
from kinhec.kinematics import forward_kinematics_batch, geometric_jacobian
from kinhec.robots import get_robot
from rich.console import Console
from rich.table import Table

from handeye.calibration.hand_eye import HandEye, solve, solve_arm
from handeye.geometry import invert, make_pose

# Scatter of the turning axes below which a motion turns about one axis only (kinhec's measure).
ONE_AXIS = 1e-6
OURS, OURS_ARM = "handeye", "handeye, with the arm"


class Arm:
    """A robot of kinhec as an `handeye.robots.arm.Arm`."""

    reach = 1.0

    def __init__(self, name: str) -> None:
        self.name = name
        self.robot = get_robot(name)
        self.joint_names = tuple(f"q{i + 1}" for i in range(self.robot.dof))
        self.lower, self.upper = np.array(self.robot.q_min), np.array(self.robot.q_max)
        self.held = np.zeros(self.robot.dof, np.bool_)

    def poses(self, joints: np.ndarray) -> np.ndarray:
        """As `handeye.robots.arm.Arm`."""
        return forward_kinematics_batch(self.robot, joints)

    def jacobians(self, joints: np.ndarray) -> np.ndarray:
        """As `handeye.robots.arm.Arm`."""
        return np.stack([geometric_jacobian(self.robot, q) for q in joints])


class Outcome(NamedTuple):
    """Errors of X on one sequence, time, and what we said of it."""

    track: str
    sequence: str
    solver: str
    degrees: float
    millimetres: float
    milliseconds: float
    says: str = ""


def opencv(A: np.ndarray, B: np.ndarray) -> Iterator[tuple[str, Callable[[], np.ndarray]]]:
    """OpenCV's solvers of A X = Z B, all as eye in hand: A X B^-1 = Z."""
    seen = invert(B)

    def of_hand_eye(method: int) -> np.ndarray:
        R, t = cv2.calibrateHandEye(
            list(A[:, :3, :3]),
            list(A[:, :3, 3]),
            list(seen[:, :3, :3]),
            list(seen[:, :3, 3]),
            method=method,
        )
        return make_pose(R, np.ravel(t))

    def of_robot_world(method: int) -> np.ndarray:
        back = invert(A)
        *_, R, t = cv2.calibrateRobotWorldHandEye(
            list(seen[:, :3, :3]),
            list(seen[:, :3, 3]),
            list(back[:, :3, :3]),
            list(back[:, :3, 3]),
            method=method,
        )
        return invert(make_pose(R, np.ravel(t)))

    for name in ("TSAI", "PARK", "HORAUD", "ANDREFF", "DANIILIDIS"):
        method = getattr(cv2, f"CALIB_HAND_EYE_{name}")
        yield f"OpenCV {name}", lambda method=method: of_hand_eye(method)
    for name in ("SHAH", "LI"):
        method = getattr(cv2, f"CALIB_ROBOT_WORLD_HAND_EYE_{name}")
        yield f"OpenCV {name}", lambda method=method: of_robot_world(method)


def measured(sequence: Any, row: Any) -> Iterator[Outcome]:
    """All solvers on one sequence."""
    track = row.track
    if row.axis_scatter_lambda2 < ONE_AXIS:
        track = "one axis"
    offset = None if sequence.synchronous else sequence.time_offset
    A, B = sequence.axyb_poses(offset)
    chosen = protocol.motions.select_keyframes(
        A, protocol.KEYFRAME_MIN_ROT_DEG, protocol.KEYFRAME_MIN_TRANS_M, protocol.MAX_KEYFRAMES
    )
    if len(chosen) < 3:
        chosen = np.arange(len(A))
    A, B = A[chosen], B[chosen]
    S = invert(B) if sequence.eye_in_hand else B

    def outcome(solver: str, X: np.ndarray, began: float, says: str = "") -> Outcome:
        took = 1e3 * (time.perf_counter() - began)
        turn, shift = se3.pose_error(X, sequence.X)
        return Outcome(track, sequence.id, solver, float(turn), float(shift), took, says)

    def ours(solver: str, fit: HandEye, began: float) -> Outcome:
        return outcome(solver, fit.X, began, "; ".join(fit.undetermined))

    began = time.perf_counter()
    fit = solve(
        A,
        S,
        setup=row.configuration,
        free_scale=row.scale != 1.0,
        odometry=row.camera_noise_model == "vo_drift" and sequence.eye_in_hand,
    )
    yield ours(OURS, fit, began)
    if sequence.robot.q_meas is not None and row.camera_noise_model != "vo_drift":
        _, _, valid = sequence.paired_measurements(offset)
        joints = sequence.robot.q_meas
        as_reported = sequence.synchronous and row.scale == 1.0
        if as_reported and np.allclose(Arm(row.robot).poses(joints[valid][chosen]), A, atol=1e-9):
            began = time.perf_counter()
            fit = solve_arm(Arm(row.robot), joints[valid][chosen], S, setup=row.configuration)
            yield ours(OURS_ARM, fit, began)
    for name, solver in opencv(A, B):
        began = time.perf_counter()
        try:
            X = solver()
        except cv2.error:
            X = np.full((4, 4), np.nan)
        if np.isfinite(X).all():
            yield outcome(name, X, began)
    theirs = protocol.evaluate_sequence(sequence, list(protocol.SOLVERS), sync="oracle")
    for one in theirs:
        if one["ok"]:
            yield Outcome(
                track,
                sequence.id,
                one["solver"],
                one["X_rot_err_deg"],
                one["X_trans_err_mm"],
                one["runtime_ms"],
            )


def table(track: str, outcomes: list[Outcome]) -> Table:
    """Solvers of one track, best median position first."""
    solvers = {o.solver: [p for p in outcomes if p.solver == o.solver] for o in outcomes}
    n = max(len(of) for of in solvers.values())
    shown = Table(title=f"{track}: {n} sequences, errors of X")
    shown.add_column("solver")
    for column in ("n", "mm, median", "mm, 95 %", "deg, median", "deg, 95 %", "ms, median"):
        shown.add_column(column, justify="right")
    for solver, of in sorted(
        solvers.items(), key=lambda item: statistics.median(o.millimetres for o in item[1])
    ):
        mm, deg = [o.millimetres for o in of], [o.degrees for o in of]
        shown.add_row(
            solver,
            str(len(of)),
            f"{np.median(mm):.3f}",
            f"{np.quantile(mm, 0.95):.3f}",
            f"{np.median(deg):.4f}",
            f"{np.quantile(deg, 0.95):.4f}",
            f"{statistics.median(o.milliseconds for o in of):.1f}",
            style="bold" if solver.startswith(OURS) else None,
        )
    return shown


def main(
    tier: Annotated[str, typer.Option(help="Tier of kinhec, or its YAML file.")] = "smoke",
    data: Annotated[Path | None, typer.Option(help="Sequences generated before.")] = None,
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the numbers.")] = None,
) -> None:
    """Measure all solvers on all sequences and print a table for each track."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = data or Path(scratch) / "data"
        if data is None:
            kinhec_command(["generate", "--tier", tier, "--out", str(folder)])
        outcomes: list[Outcome] = []
        for _, row in kinhec.load_manifest(folder).iterrows():
            outcomes += measured(kinhec.load_sequence(folder, row.sequence_id), row)
    console = Console()
    for track in dict.fromkeys(o.track for o in outcomes):
        console.print(table(track, [o for o in outcomes if o.track == track]))
    for o in outcomes:
        if o.says:
            console.print(f"{o.sequence} ({o.track}), {o.solver}: not determined: {o.says}")
    if json_file is not None:
        rows = [o._asdict() for o in outcomes]
        json_file.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    typer.run(main)
