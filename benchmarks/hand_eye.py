"""Hand-eye calibration beside kinhec's eleven solvers and OpenCV's seven, on kinhec's benchmark.

    python benchmarks/hand_eye.py [--tier smoke] [--seed S] [--least N] [--tracks A,B] [--json FILE]

kinhec generates its sequences itself (`smoke`: 46 in a minute or two) and chooses the keyframes;
every solver gets the same ones. With two or four sequences of a track, the best of eighteen solvers
is a matter of luck: `--seed` draws others of the same kinds, `--least` at least so many of each
track. "all noise known" is what a solver would reach that is told how large every error is
(`hand_eye_bound`); where it is missing, errors are not normal or not independent.

Ours is also told what a user knows of the camera: whether it measures metres (track monocular) and
whether it counts its way (visual odometry). The arm's joints and nominal model are given where the
reported poses are no more than these (track robot_error); there both `solve` and `solve_arm` are
shown. Motions about one axis do not determine the result and have a table of their own, with what
we say about each.
"""

import json
import statistics
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import cv2
import kinhec
import numpy as np
import typer
import yaml
from hand_eye_bound import known_noise
from hand_eye_rivals import Arm, opencv
from kinhec import benchmark as protocol
from kinhec import se3
from kinhec.cli import main as kinhec_command
from kinhec.plans import build_plan, load_tier
from rich.console import Console
from rich.table import Table

from handeye.calibration.hand_eye import HandEye, solve, solve_arm
from handeye.errors import InvalidInput
from handeye.geometry import invert

# Scatter of the turning axes below which a motion turns about one axis only (kinhec's measure).
ONE_AXIS = 1e-6
OURS, OURS_ARM = "handeye", "handeye, with the arm"
BOUND = "all noise known"
# Draws of the bootstrap.
DRAWS = 2000


class Outcome(NamedTuple):
    """Errors of X on one sequence, time, and what we said of it."""

    track: str
    sequence: str
    solver: str
    degrees: float
    millimetres: float
    milliseconds: float
    says: str = ""


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
    bound = known_noise(sequence, row, chosen, Arm(row.robot))
    if bound is not None:
        yield outcome(BOUND, bound, time.perf_counter())
    for name, solver in opencv(A, B):
        began = time.perf_counter()
        try:
            X = solver()
        except (cv2.error, InvalidInput):
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


def compared(outcomes: list[Outcome]) -> Iterator[str]:
    """Ours beside the best of kinhec's, by medians over the same sequences of a track."""
    rng = np.random.default_rng(0)
    for unit, of in (("mm", lambda o: o.millimetres), ("degrees", lambda o: o.degrees)):
        errors: dict[str, dict[str, float]] = {}
        for o in outcomes:
            errors.setdefault(o.solver, {})[o.sequence] = of(o)
        theirs = {name: errors[name] for name in protocol.SOLVERS if name in errors}
        best = min(theirs, key=lambda name: np.median(list(theirs[name].values())))
        for ours in (name for name in (OURS, OURS_ARM) if name in errors):
            both = [name for name in errors[ours] if name in errors[best]]
            pairs = np.array([(errors[ours][name], errors[best][name]) for name in both])
            drawn = np.median(pairs[rng.integers(0, len(pairs), (DRAWS, len(pairs)))], axis=1)
            low, high = np.quantile(drawn[:, 0] - drawn[:, 1], (0.025, 0.975))
            less = np.median(pairs[:, 0]) - np.median(pairs[:, 1])
            yield (
                f"{ours} against {best}: {less:+.4f} {unit} (95 %: {low:+.4f} to {high:+.4f}), "
                f"nearer in {np.mean(pairs[:, 0] < pairs[:, 1]):.0%} of {len(pairs)}"
            )


def generate(folder: Path, tier: str, seed: int | None, least: int, tracks: list[str]) -> None:
    """Sequences of each track into a folder of its own."""
    spec = load_tier(tier)
    for track in tracks or list(spec["tracks"]):
        spec = load_tier(tier) | ({} if seed is None else {"global_seed": seed})
        count = len(build_plan(spec, [track])[track])
        # Once is what the tier says, whatever it repeats.
        if least > count:
            spec["repeats_multiplier"] = -(-least // count) * spec.get("repeats_multiplier", 1)
        description = folder / f"{track}.yaml"
        description.write_text(yaml.safe_dump(spec), encoding="utf-8")
        what = ["--tier", str(description), "--tracks", track, "--out", str(folder / track)]
        kinhec_command(["generate", *what])


def main(
    tier: Annotated[str, typer.Option(help="Tier of kinhec, or its YAML file.")] = "smoke",
    seed: Annotated[int | None, typer.Option(help="Draw other sequences of the tier.")] = None,
    least: Annotated[int, typer.Option(help="At least so many sequences of each track.")] = 0,
    tracks: Annotated[str, typer.Option(help="These tracks only, with commas between.")] = "",
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the numbers.")] = None,
) -> None:
    """Measure all solvers on all sequences and print a table for each track."""
    outcomes: list[Outcome] = []
    with tempfile.TemporaryDirectory() as scratch:
        generate(Path(scratch), tier, seed, least, [t for t in tracks.split(",") if t])
        for folder in sorted(path for path in Path(scratch).iterdir() if path.is_dir()):
            for _, row in kinhec.load_manifest(folder).iterrows():
                outcomes += measured(kinhec.load_sequence(folder, row.sequence_id), row)
    console = Console(width=100)
    for track in dict.fromkeys(o.track for o in outcomes):
        of_track = [o for o in outcomes if o.track == track]
        console.print(table(track, of_track))
        for line in compared(of_track):
            console.print(line, highlight=False)
    for o in outcomes:
        if o.says:
            console.print(f"{o.sequence} ({o.track}), {o.solver}: not determined: {o.says}")
    if json_file is not None:
        rows = [o._asdict() for o in outcomes]
        json_file.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    typer.run(main)
