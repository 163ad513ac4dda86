"""`handeye suggest` of a set-up: which measurement to take next, and at which joints."""

import csv
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from rich.markup import escape

from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.calibration.setups.knowledge import undetermined_of
from handeye.calibration.setups.storage import StoredSetup
from handeye.calibration.setups.suggesting import SuggestedRows, suggest_rows
from handeye.calibration.setups.words import SHOWN
from handeye.calibration.view import View
from handeye.cli.console import err, out, progress_bar, table, write_json
from handeye.cli.found import print_open, say
from handeye.cli.setup import Described, load_described
from handeye.io.columns import JOINT_SUFFIX, SIGHTING
from handeye.io.files import replace_file


def fitted_setup(setup: Described, *, skip_bad: bool) -> StoredSetup:
    """A set-up as described, fitted to all of its rows."""
    described = load_described(setup, skip_bad=skip_bad)
    with progress_bar("fitting", 1) as (progress, task):
        fit = fit_measurements(
            described.arm, described.measurements, described.sheet,
            lambda done, rounds: progress.update(task, completed=done, total=rounds),
        )  # fmt: skip
    return StoredSetup(fit, described.sizes)


def suggest_for_setup(
    setup: StoredSetup,
    n: int,
    *,
    view: View | None,
    wider: bool,
    target_file: Path | None,
    json_file: str | None,
) -> None:
    """Say and write which n measurements to take."""
    found = suggest_rows(setup.fit, n, view=view, wider=wider, sizes=setup.sizes)
    if target_file is not None:
        replace_file(target_file, _as_csv(found).encode())
        err().print(f"{n} measurements -> {escape(str(target_file))}", highlight=False)
    if json_file is not None:
        write_json(_as_data(found, setup.fit), json_file)
    if json_file != "-":
        _print(found, setup.fit)


def _joint_names(found: SuggestedRows) -> list[str]:
    """Of all rows, each once."""
    return list(dict.fromkeys(name for row in found.rows for name in row.joint_names))


def _as_csv(found: SuggestedRows) -> str:
    """A row for each; a joint that is not between the links of its measurement stays empty."""
    joints, pointing, text = _joint_names(found), SIGHTING[0], StringIO(newline="")
    heads = ["measurement", *(name + JOINT_SUFFIX for name in joints)]
    if any(row.pointing is not None for row in found.rows):
        heads.append(pointing)
    writer = csv.DictWriter(text, heads, lineterminator="\n")
    writer.writeheader()
    for row in found.rows:
        own = zip(row.joint_names, row.joints.tolist(), strict=True)
        cells: dict[str, Any] = {name + JOINT_SUFFIX: value for name, value in own}
        if row.pointing is not None:
            cells[pointing] = row.pointing
        writer.writerow({"measurement": row.measurement, **cells})
    return text.getvalue()


def _as_data(found: SuggestedRows, fit: MixedFit) -> dict[str, Any]:
    return {
        "suggestions": [
            {
                "measurement": row.measurement,
                "joint_names": list(row.joint_names),
                "joints": row.joints.tolist(),
                "pointing": row.pointing,
                "uncertainty_after": dict(row.after),
            }
            for row in found.rows
        ],
        "uncertainty_before": dict(found.before),
        "units": dict(found.units),
        "left_out": list(found.left),
        "undetermined": list(undetermined_of(fit)),
    }


def _print(found: SuggestedRows, fit: MixedFit) -> None:
    arms = [fit.problem.arm.between(one.link, one.base) for one in fit.given]
    sliding = {name for arm in arms for name in np.array(arm.joint_names)[arm.sliding].tolist()}
    slides = not sliding.isdisjoint(_joint_names(found))
    pans = any(row.pointing is not None for row in found.rows)
    heads = [
        f"joints from base\nto link [{'°, mm' if slides else '°'}]",
        *(["pan axis\n[°]"] * pans),
    ]
    heads += [f"{channel}\n[{SHOWN[unit][0]}]" for channel, unit in found.units.items()]
    shown = table(
        "Measurements to add, and how well all is predicted then",
        "", "", *map(escape, heads), left=3,
    )  # fmt: skip
    shown.add_row("", "now", *[""] * (1 + pans), *_spreads(found, found.before))
    for i, row in enumerate(found.rows):
        joints = " ".join(
            f"{SHOWN['m' if name in sliding else 'rad'][1] * value:.1f}"
            for name, value in zip(row.joint_names, row.joints.tolist(), strict=True)
        )
        pan = ["" if row.pointing is None else f"{np.degrees(row.pointing):.1f}"] * pans
        spreads = _spreads(found, row.after)
        shown.add_row(str(i + 1), escape(row.measurement), joints, *pan, *spreads)
    console = out()
    console.print(shown)
    say(console, "left out", found.left)
    print_open(console, undetermined_of(fit))


def _spreads(found: SuggestedRows, spread: Any) -> list[str]:
    return [f"{SHOWN[unit][1] * spread[channel]:#.3g}" for channel, unit in found.units.items()]
