"""Faults injected into a real log of an arm: noticed, attributed, re-learned, after how many rows?

    python benchmarks/arm_faults.py LOG [--robot ur10] [--at 600] [--rows 200] [--json FILE]

LOG is a log, or a file that `handeye convert` knows, such as the UR10 measurements of Landgraf et
al. (2021). The combined calibrator learns the rows up to `--at` once. Every fault is then put on
the rows that follow, and a copy of the calibrator learns them. For each fault: what was said to
have changed and by how much; after how many rows with the fault it was said; the mean error,
test-then-train, of the rows after that (or of all), and of the same rows without the fault; how
many rows it took until the mean of ten in a row was within 1.5 times that again; and how many rows
were left out as outliers, of those that were spoiled and of the others.
"""

import json
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import track
from rich.table import Table

from handeye.arrays import Array, Booleans
from handeye.calibration.combined import Combined, Event
from handeye.calibration.placed import calibrator_for, place
from handeye.errors import LogError
from handeye.geometry import matrix_from_wxyz
from handeye.io.convert import convert
from handeye.io.logs import read_log
from handeye.observations import PointObservation
from handeye.randomness import stream
from handeye.robots.urdf import load_arm

SLIP, MOVED = np.radians(0.2), 0.003 * np.array([0.48, -0.6, 0.64])
WRONG, WRONG_BY = 0.1, 0.03
AGAIN = 10
CHANGES = {"change", "lost"}


def observations_of(log: Path) -> Any:
    """Of a log, or of a foreign file."""
    try:
        return convert(log).observations
    except LogError:
        return read_log(log).log.observations


def slip(joint: int) -> Callable[[PointObservation], PointObservation]:
    """The encoder of a joint slips by 0.2 degrees."""

    def fault(seen: PointObservation) -> PointObservation:
        joints = seen.joints.copy()
        joints[:, joint] -= SLIP
        return replace(seen, joints=joints)

    return fault


def sensor_moved(seen: PointObservation) -> PointObservation:
    """The sensor stands 3 mm elsewhere."""
    return replace(seen, position=seen.position + MOVED)


def marker_remounted(seen: PointObservation) -> PointObservation:
    """The marker sits 3 mm elsewhere on the flange; needs measured orientations."""
    assert seen.orientation is not None
    return replace(seen, position=seen.position + matrix_from_wxyz(seen.orientation) @ MOVED)


def wrong_points(seen: PointObservation) -> PointObservation:
    """One point in ten is wrong by some centimetres."""
    rng = stream("benchmark: wrong points")
    position = seen.position.copy()
    hit = rng.random(len(seen)) < WRONG
    position[hit] += rng.normal(scale=WRONG_BY, size=(int(hit.sum()), 3))
    return replace(seen, position=position)


def learn(combined: Combined, seen: PointObservation) -> tuple[list[Event], Array, list[int]]:
    """What a copy noticed, its errors (N,) before each row, and the rows when changes were said."""
    copy = deepcopy(combined)
    errors, noticed, before = np.empty(len(seen)), list[int](), len(copy.events)
    for i, one in enumerate(seen):
        errors[i] = np.linalg.norm(copy.observe(one).error)
        changes = [event for event in list(copy.events)[before:] if event.kind in CHANGES]
        noticed += [i + 1] * (len(changes) - len(noticed))
    return list(copy.events)[before:], errors, noticed


def row_of(
    words: str, combined: Combined, seen: PointObservation, spoiled: Booleans, clean: Array
) -> dict[str, Any]:
    """What became of a fault; errors are those of rows that are not spoiled."""
    first = combined.n_observations
    events, errors, noticed = learn(combined, seen)
    since = noticed[0] if noticed else 0
    good = np.flatnonzero(~spoiled[since:]) + since
    mean = np.full(AGAIN, 1.0 / AGAIN)
    running = np.convolve(errors[good], mean, "valid")
    again = np.flatnonzero(running < 1.5 * np.convolve(clean[good], mean, "valid"))
    outliers = [event.observation - first for event in events if event.kind == "outlier"]
    return {
        "fault": words,
        "noticed": [
            f"{event.part or event.kind}: {event.amount * 1e3:+.2f} m{event.unit}"
            for event in events if event.kind in CHANGES
        ],
        "after": noticed,
        "error": float(errors[good].mean()),
        "clean": float(clean[good].mean()),
        "again": int(good[again[0]]) if len(again) else None,
        "spoiled": int(spoiled.sum()),
        "spoiled_left_out": int(spoiled[outliers].sum()),
        "others_left_out": len(outliers) - int(spoiled[outliers].sum()),
    }  # fmt: skip


def main(
    log: Annotated[Path, typer.Argument(help="A log, or a file that `handeye convert` knows.")],
    robot: Annotated[str, typer.Option(help="Name of a shipped robot, or a URDF file.")] = "ur10",
    at: Annotated[int, typer.Option(help="Rows learned before the fault.")] = 600,
    rows: Annotated[int, typer.Option(help="Rows learned with the fault.")] = 200,
    file: Annotated[Path | None, typer.Option("--json", help="Where to write the rows.")] = None,
) -> None:
    """Inject each fault, and print a table."""
    arm = load_arm(robot)
    seen: Any = observations_of(log)
    model, _ = place(arm, seen[:at])
    combined: Any = calibrator_for(model, "combined")
    combined.observe_many(seen[:at])
    later = seen[at : at + rows]
    faults: list[tuple[str, Callable[[PointObservation], PointObservation]]] = [
        ("none", lambda same: same),
        *((f"{name} slips by 0.2 deg", slip(j)) for j, name in enumerate(arm.joint_names)),
        ("sensor moved by 3 mm", sensor_moved),
        ("one point in ten wrong", wrong_points),
    ]
    if seen.orientation is not None:
        faults.append(("marker remounted by 3 mm", marker_remounted))
    _, clean, _ = learn(combined, later)
    found = list[dict[str, Any]]()
    table = Table("fault", "noticed", "after", "mm", "without", "usual after", "left out")
    for words, fault in track(faults, console=Console(stderr=True)):
        faulty = fault(later)
        spoiled = np.zeros(len(later), np.bool_)
        if fault is wrong_points:
            spoiled = np.any(faulty.position != later.position, axis=1)
        row = row_of(words, combined, faulty, spoiled, clean)
        found.append(row)
        table.add_row(
            words, "\n".join(row["noticed"]), ", ".join(map(str, row["after"])),
            f"{1e3 * row['error']:.3f}", f"{1e3 * row['clean']:.3f}", str(row["again"]),
            f"{row['spoiled_left_out']} of {row['spoiled']}, {row['others_left_out']}",
        )  # fmt: skip
    Console(width=120).print(table)
    if file is not None:
        file.write_text(json.dumps(found, indent=2))


if __name__ == "__main__":
    typer.run(main)
