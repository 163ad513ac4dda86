"""`handeye hand-eye`: pairs of poses in, the place of the camera out."""

from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import typer
from rich.console import Console
from rich.markup import escape

from handeye.arrays import Array, Integers
from handeye.calibration import hand_eye
from handeye.calibration.hand_eye import HandEye
from handeye.calibration.hand_eye.samples import Setup
from handeye.calibration.log_checks import in_order_of
from handeye.calibration.placed import arm_of
from handeye.cli.bags import read_any
from handeye.cli.console import check_places, err, out, table, write_json
from handeye.cli.found import WORST, print_rejected, say
from handeye.cli.robot import ROBOT_HELP, load_robot
from handeye.errors import InvalidInput
from handeye.geometry import make_pose, matrix_from_wxyz, wxyz_from_matrix
from handeye.io.bags import BagOptions
from handeye.io.files import replace_file
from handeye.io.pairs import read_pairs
from handeye.io.urdf_origins import xyz_rpy
from handeye.io.yaml_files import HandEyeFrames, hand_eye_yaml
from handeye.observations import PointObservation


class _Solved(NamedTuple):
    fit: HandEye
    rows: Integers
    rejected: tuple[str, ...]


def solve(
    pairs: Annotated[
        Path,
        typer.Argument(
            help="Table of pairs of poses; with --robot, a log or a recording with joints and "
            "the poses of the target.",
            show_default=False,
        ),
    ],
    robot: Annotated[
        str | None,
        typer.Option(help=f"Estimate the arm's own errors as well: {ROBOT_HELP}"),
    ] = None,
    tip: Annotated[str | None, typer.Option(help="Link of the URDF that is the flange.")] = None,
    eye_to_hand: Annotated[
        bool,
        typer.Option("--eye-to-hand", help="The camera stands in the world, the target moves."),
    ] = False,
    free_scale: Annotated[
        bool, typer.Option("--free-scale", help="The camera knows no metres: estimate its unit.")
    ] = False,
    yaml_file: Annotated[
        Path | None, typer.Option("--yaml", help="Write the result as easy_handeye2 stores it.")
    ] = None,
    name: Annotated[str, typer.Option(help="Name in the YAML file.")] = HandEyeFrames.name,
    base_frame: Annotated[str, typer.Option(help="The same: the base.")] = HandEyeFrames.base,
    effector_frame: Annotated[
        str, typer.Option(help="The same: the flange.")
    ] = HandEyeFrames.effector,
    camera_frame: Annotated[str, typer.Option(help="The same: the camera.")] = HandEyeFrames.camera,
    target_frame: Annotated[str, typer.Option(help="The same: the target.")] = HandEyeFrames.target,
    json_file: Annotated[
        str | None, typer.Option("--json", help="Also write the results as JSON; - prints them.")
    ] = None,
    skip_bad: Annotated[
        bool, typer.Option("--skip-bad", help="Use the good rows of a table that has bad ones.")
    ] = False,
) -> None:
    """Find where camera and target sit, from nothing but pairs of poses.

    The columns are flange_x_m, flange_y_m, flange_z_m, flange_qw, flange_qx, flange_qy, flange_qz
    and the same with target_: the flange in the base's frame and the target in the camera's.
    """
    check_places(None, json_file, None if yaml_file is None else str(yaml_file))
    setup: Setup = "eye_to_hand" if eye_to_hand else "eye_in_hand"
    if robot is None:
        read = read_pairs(pairs, skip_bad=skip_bad)
        fit = hand_eye.solve(read.flanges, read.sensed, setup=setup, free_scale=free_scale)
        solved = _Solved(fit, read.rows, tuple(map(str, read.rejected)))
    elif free_scale:
        raise InvalidInput("--free-scale goes without --robot only")
    else:
        solved = _with_arm(pairs, robot, tip, setup, skip_bad=skip_bad)
    if yaml_file is not None:
        frames = HandEyeFrames(name, base_frame, effector_frame, camera_frame, target_frame)
        camera = solved.fit.X if setup == "eye_in_hand" else solved.fit.Z
        replace_file(yaml_file, hand_eye_yaml(setup, camera, frames).encode())
        err().print(f"wrote {escape(str(yaml_file))}", highlight=False)
    if json_file is not None:
        write_json(_as_data(solved), json_file)
    if json_file != "-":
        _print(solved, out())


def _with_arm(path: Path, robot: str, tip: str | None, setup: Setup, *, skip_bad: bool) -> _Solved:
    arm = arm_of(load_robot(robot, tip))
    reading = read_any(path, BagOptions(), arm=arm, skip_bad=skip_bad)
    log = in_order_of(arm, reading.log)
    seen = log.observations
    if not isinstance(seen, PointObservation) or seen.orientation is None:
        raise InvalidInput(
            f"{path}: hand-eye calibration needs the target's orientation: the columns qw, qx, qy "
            "and qz, or poses in a recording"
        )
    sensed = make_pose(matrix_from_wxyz(seen.orientation), seen.position)
    fit = hand_eye.solve_arm(arm, seen.joints, sensed, setup=setup)
    return _Solved(fit, log.rows, tuple(map(str, reading.rejected)))


def _names(fit: HandEye) -> tuple[str, str]:
    if fit.setup == "eye_in_hand":
        return "T_flange_camera", "T_base_target"
    return "T_flange_target", "T_base_camera"


def _as_data(solved: _Solved) -> dict[str, Any]:
    fit = solved.fit
    X, Z = _names(fit)
    worst = np.linalg.norm(fit.normalised, axis=1)
    return {
        "setup": fit.setup,
        "status": fit.status,
        "determined": fit.determined,
        "undetermined": list(fit.undetermined),
        "n_observations": len(solved.rows),
        "n_rejected": len(solved.rejected),
        "rejected": list(solved.rejected),
        X: _pose_data(fit.X, fit.std[:6]),
        Z: _pose_data(fit.Z, fit.std[6:]),
        "covariance": fit.covariance.tolist(),
        "scale": fit.scale,
        "scale_std": fit.scale_std,
        "residual_position_rms": _rms(fit, slice(3, 6)),
        "residual_rotation_rms": _rms(fit, slice(3)),
        "samples": {
            "row": solved.rows.tolist() if len(worst) == len(solved.rows) else None,
            "good": fit.good.tolist(),
            "normalised": worst.tolist(),
            "influence": [None if np.isinf(i) else float(i) for i in fit.influence],
        },
        "outlier_rows": solved.rows[fit.outliers].tolist(),
        "unit": "m",
    }


def _pose_data(T: Array, std: Array) -> dict[str, Any]:
    return {
        "matrix": T.tolist(),
        "position": T[:3, 3].tolist(),
        "position_std": std[3:].tolist(),
        "quaternion_wxyz": wxyz_from_matrix(T[:3, :3]).tolist(),
        "rotation_std": std[:3].tolist(),
    }


def _rms(fit: HandEye, part: slice) -> float:
    """Root mean square length of the residuals of samples that are no outliers."""
    values = fit.residuals[fit.good >= 0.5][:, part]
    return float(np.sqrt(np.sum(values**2) / max(len(values), 1)))


def _print(solved: _Solved, console: Console) -> None:
    fit = solved.fit
    shown = table(
        f"{fit.setup.replace('_', ' ')}: {len(solved.rows)} pairs of poses",
        "", "x [mm]", "y [mm]", "z [mm]", "roll [°]", "pitch [°]", "yaw [°]",
    )  # fmt: skip
    for label, T, std in zip(_names(fit), (fit.X, fit.Z), (fit.std[:6], fit.std[6:]), strict=True):
        turn: Array = np.degrees(np.array(xyz_rpy(T)[1]))
        shown.add_row(label, *(f"{1e3 * v:.3f}" for v in T[:3, 3]), *(f"{v:.4f}" for v in turn))
        turns: Array = np.degrees(std[:3])
        spread = [*(f"{1e3 * v:.2g}" for v in std[3:]), *(f"{v:.2g}" for v in turns)]
        shown.add_row("  ±, turns about x, y, z", *spread, end_section=True)
    console.print(shown)
    say(console, "status", [fit.status])
    sizes = f"{1e3 * _rms(fit, slice(3, 6)):.3g} mm and {np.degrees(_rms(fit, slice(3))):.3g}°"
    say(console, "residual", [f"{sizes}, root mean square without outliers"])
    if fit.scale_std > 0.0:
        say(console, "scale", [f"{fit.scale:.5g} ± {fit.scale_std:.2g}"])
    first = table("Rows to look at first", "row", "influence", "misfit", "", left=0)
    misfit = np.linalg.norm(fit.normalised, axis=1)
    doubtful = fit.influence + 1e3 * (fit.good < 0.5)
    for i in np.argsort(-doubtful, kind="stable")[:WORST].tolist():
        said = "an outlier, left out" if fit.good[i] < 0.5 else ""
        first.add_row(str(solved.rows[i]), f"{fit.influence[i]:.2g}", f"{misfit[i]:.1f}", said)
    console.print(first)
    console.print(
        "influence: by how many standard deviations the result moves without the row",
        style="dim", highlight=False, soft_wrap=True,
    )  # fmt: skip
    print_rejected(console, solved.rejected)
