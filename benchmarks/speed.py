"""Speed of calibrating an arm from a log of positions, side by side with what others offer.

    python benchmarks/speed.py [--repeats 3] [--json FILE]
        [--robotkinecal PYTHON] [--figaroh PYTHON]

Two cases: the UR10 measured by Landgraf et al. (2021), four fifths of its rows learned and the
middle one held out; and a simulated Panda, 1,000 noisy positions learned, and judged by 500 true
ones. Everyone is given the same joints, positions, nominal model and first placement of base and
marker, and fits base, marker and the geometry of every joint, as far as a tool knows these.

- handeye, geometry: our batch fit with analytic derivatives, compiled; noise and widths of the
  priors are found as well. handeye, with curves: the same as `--method estimator` has it, with
  error curves of every joint. handeye, row by row: `Combined` in the order of time, as a live
  session learns.
- scipy: `least_squares` with numerical differences on the unknowns, priors and residuals of the
  first, once with the chain as NumPy has it, once with our compiled one.
- robotkinecal and FIGAROH run in Pythons of their own, for the first wants numpy 1: install each
  with pip into a virtual environment and name its `python`.

The clock is processor time in one thread. In-process contestants take turns; medians are shown.
The script stops if the NumPy chain and the compiled one differ.
"""

import json
import os
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import typer
from rich.console import Console
from rich.table import Table
from speed_cases import Case, panda, ur10
from speed_chain import PlainChain

from handeye.arrays import Array
from handeye.calibration.arm.estimator import FINE
from handeye.calibration.arm.evidence import solve
from handeye.calibration.arm.kernels import pose_many
from handeye.calibration.arm.log_system import LogSystem
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.combined import Combined
from handeye.calibration.engine.robot import Acting

GEOMETRY = ArmSheet(curves=CurveTerms(0, 0), compliance=0.0)
BASE = "handeye, geometry"
HERE = Path(__file__).parent


class Fitted(NamedTuple):
    """Predicted positions (M, 3) of the judged joints, and how many numbers were fitted."""

    positions: Array
    unknowns: int


def ours(sheet: ArmSheet) -> Callable[[Case], Fitted]:
    """Our batch fit with a sheet."""

    def fit(case: Case) -> Fitted:
        robot = ArmRobot(case.model, sheet)
        rows = robot.seen_rows(case.learned)
        x = solve(LogSystem(robot.kernel, robot.chain.tolerance, rows)).x
        errors = robot.errors(Acting(x, None, np.inf), robot.seen_rows(case.judged))
        return Fitted(case.judged.position - errors, len(x))

    return fit


def row_by_row(case: Case) -> Fitted:
    """Our default, which sees one row at a time."""
    calibrator = Combined(case.model)
    calibrator.observe_many(case.learned)
    return Fitted(case.judged.position - calibrator.errors(case.judged), len(calibrator.engine.x))


def scipy_fit(*, compiled: bool) -> Callable[[Case], Fitted]:
    """`least_squares` with numerical differences."""
    from scipy.optimize import least_squares  # noqa: PLC0415

    def fit(case: Case) -> Fitted:
        robot = ArmRobot(case.model, GEOMETRY)
        tolerance, noise = robot.chain.tolerance, GEOMETRY.unexplained
        learned = chain_of(case, robot, case.learned.joints, compiled=compiled)

        def residuals(z: Array) -> Array:
            off = (case.learned.position - learned(tolerance * z)) / noise
            return np.concatenate([off.reshape(-1), z])

        found = least_squares(residuals, np.zeros(len(tolerance)), method="lm")
        judged = chain_of(case, robot, case.judged.joints, compiled=compiled)
        return Fitted(judged(tolerance * np.asarray(found.x)), len(tolerance))

    return fit


def chain_of(
    case: Case, robot: ArmRobot, joints: Array, *, compiled: bool
) -> Callable[[Array], Array]:
    """Positions (N, 3) of the marker at joints (N, n) as a function of the unknowns."""
    if not compiled:
        return PlainChain(case.arm.stages(), case.model.placement, joints)

    def positions(x: Array) -> Array:
        out = np.empty((len(joints), 3, 4))
        pose_many(robot.kernel, x, joints, out)
        return out[:, :, 3]

    return positions


CONTESTANTS: dict[str, Callable[[Case], Fitted]] = {
    BASE: ours(GEOMETRY),
    "handeye, with curves": ours(ArmSheet(curves=FINE)),
    "handeye, row by row": row_by_row,
    "scipy, differences, NumPy chain": scipy_fit(compiled=False),
    "scipy, differences, our chain": scipy_fit(compiled=True),
}


def check_chains(case: Case) -> None:
    """Both chains of scipy must be the same robot."""
    robot, joints = ArmRobot(case.model, GEOMETRY), case.judged.joints
    x = np.random.default_rng(1).normal(size=len(robot.chain.names)) * robot.chain.tolerance
    both = [chain_of(case, robot, joints, compiled=how)(x) for how in (False, True)]
    np.testing.assert_allclose(both[0], both[1], atol=1e-12)


def elsewhere(python: Path, script: str, case: Case, repeats: int) -> dict[str, Any]:
    """A rival in a Python of its own: seconds (R,) and what it predicts."""
    placement, arm = case.model.placement, case.arm
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        chain = PlainChain(arm.stages(), placement, np.zeros((1, len(arm.joint_names))))
        about = {
            "tip": arm.tip, "joint_names": arm.joint_names, "repeats": repeats,
            "joints": case.learned.joints.tolist(), "positions": case.learned.position.tolist(),
            "judged": case.judged.joints.tolist(), "screws": chain.screws().tolist(),
            "rest": chain.rest().tolist(),
        }  # fmt: skip
        (folder / "arm.urdf").write_text(arm.urdf, encoding="utf-8")
        (folder / "case.json").write_text(json.dumps(about), encoding="utf-8")
        done = subprocess.run(
            [python, HERE / script, folder], capture_output=True, text=True, check=False,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": ""},
        )  # fmt: skip
        if done.returncode:
            raise SystemExit(f"{script} failed:\n{done.stderr[-2000:]}")
        return json.loads((folder / "done.json").read_text(encoding="utf-8"))


def measured(case: Case, repeats: int, rivals: dict[str, Path | None]) -> list[dict[str, Any]]:
    """One line for each contestant."""
    check_chains(case)
    rows: dict[str, dict[str, Any]] = {}
    for turn in range(1 + repeats):  # the first turn compiles
        for name, fit in CONTESTANTS.items():
            began = time.process_time()
            fitted = fit(case)
            took = time.process_time() - began
            row = rows.setdefault(name, {"seconds": []})
            row.update(unknowns=fitted.unknowns, predicted=fitted.positions)
            row["seconds"] += [took] * (turn > 0)
    for name, python in rivals.items():
        if python is not None:
            rows[name] = elsewhere(python, f"speed_{name.lower()}.py", case, repeats)
    nominal = case.model.placement.predict(case.arm, case.judged.joints)
    rows = {"nominal, frames placed": {"predicted": nominal, "seconds": [], "unknowns": 0}, **rows}
    return [
        {
            "case": case.name, "contestant": name, "unknowns": row["unknowns"],
            "seconds": row["seconds"],
            "error": float(
                np.linalg.norm(np.array(row["predicted"]) - case.judged.position, axis=1).mean()
            ),
        }
        for name, row in rows.items()
    ]  # fmt: skip


def main(
    repeats: Annotated[int, typer.Option(min=1)] = 3,
    robotkinecal: Annotated[Path | None, typer.Option(help="Python that has it.")] = None,
    figaroh: Annotated[Path | None, typer.Option(help="Python that has it.")] = None,
    file: Annotated[Path | None, typer.Option("--json", help="Where to write the numbers.")] = None,
) -> None:
    """Run everyone on both cases, and print a table for each."""
    rivals = {"robotkinecal": robotkinecal, "FIGAROH": figaroh}
    found: list[dict[str, Any]] = []
    for case in (ur10(), panda()):
        rows = measured(case, repeats, rivals)
        found += rows
        base = next(float(np.median(r["seconds"])) for r in rows if r["contestant"] == BASE)
        title = f"{case.name}: {len(case.learned)} rows learned, {len(case.judged)} judged"
        table = Table("", "unknowns", "s", "times ours", "mean error [mm]", title=title)
        for row in rows:
            took = float(np.median(row["seconds"])) if row["seconds"] else None
            cells = ("", "") if took is None else (f"{took:.2f}", f"{took / base:.1f}")
            unknowns, error = str(row["unknowns"]), f"{1e3 * row['error']:.3f}"
            table.add_row(row["contestant"], unknowns, *cells, error)
        Console().print(table)
    if file is not None:
        file.write_text(json.dumps(found, indent=1), encoding="utf-8")


if __name__ == "__main__":
    typer.run(main)
