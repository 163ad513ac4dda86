"""Parts of the calibration page that name things: parts of the robot, rows, open directions."""

from collections.abc import Sequence

from handeye.arrays import Array
from handeye.calibration.contributions import Contribution, contributions
from handeye.calibration.results import CalibrationResult, Influence, PartChange
from handeye.reports.page import Badge, Notes, Section, Table
from handeye.reports.style import significant

_PARTS, _ROWS = 12, 8


def contributions_table(result: CalibrationResult) -> list[Table]:
    """What each part of the model takes away of the errors, in mm and degrees."""
    parts = contributions(result)
    if len(parts) < 2:
        return []
    turned = all(part.orientation is not None for part in parts)
    rows = [
        [
            f"{part.part[0].upper()}{part.part[1:]}",
            *_with_gain(1e3 * part.error.mean, 1e3 * before.error.mean if before else None),
            *(_turns(part, before) if turned else []),
        ]
        for before, part in zip([None, *parts], parts, strict=False)
    ]
    heads = ["Mean error with it [mm]", "It takes away [mm]"]
    heads += ["Mean turn with it [°]", "It takes away [°]"] if turned else []
    return [
        Table(
            ("Part of the model", *heads),
            rows,
            caption="On held-out rows, each part with those before it. Placement is where sensor "
            "and marker are, geometry the lengths, directions, zeros and scales of the joints.",
        )
    ]


def _turns(part: Contribution, before: Contribution | None) -> list[str]:
    assert part.orientation is not None
    was = before.orientation.mean if before and before.orientation else None
    return _with_gain(part.orientation.mean, was)


def _with_gain(now: float, was: float | None) -> list[str]:
    gain = "" if was is None else significant(was - now, 2)
    return [significant(now, 3), gain.replace("-", "\N{MINUS SIGN}")]


def parts_section(result: CalibrationResult) -> list[Section]:
    """Which part of the robot was off, and by how much."""
    if not result.parts:
        return []
    return [Section("Which part was off", [parts_table(result.parts)])]


def parts_table(parts: Sequence[PartChange]) -> Table:
    """Parts of the robot, most important first, and how far each moves the hand."""
    rows = [
        [
            part.part,
            significant(1e3 * part.moves, 3),
            f"{100 * part.known:.0f} %",
            part.unknown,
            _change(part),
        ]
        for part in parts[:_PARTS]
    ]
    left = len(parts) - len(rows)
    more = f" {left} more parts move it less." if left else ""
    return Table(
        ("Part", "Moves the hand [mm]", "Known", "Its most changed number", "Change"),
        rows,
        caption="How far the change of each part moves the hand, root mean square over the rows, "
        "and how much of what was unknown of it the rows have told. Parts that rows can hardly "
        f"tell apart may move it far in opposite ways.{more}",
        words=frozenset({0, 3}),
    )


def _change(part: PartChange) -> str:
    """In thousandths of metres and radians, which parts of robots are off by."""
    if part.unit not in {"m", "rad"}:
        return f"{part.change:+.3g} ± {part.std:.2g} {part.unit}".rstrip()
    return f"{1e3 * part.change:+.3g} ± {1e3 * part.std:.2g} m{part.unit}".replace(
        "-", "\N{MINUS SIGN}"
    )


def open_section(result: CalibrationResult) -> list[Section]:
    """What the poses do not determine."""
    if not result.undetermined:
        return []
    n = len(result.undetermined)
    title = (
        "The poses of this log leave these open, so that ordinary tolerances decide. Ask "
        "handeye suggest for poses to add"
    )
    return [Section("What is not determined", [Notes(title, result.undetermined, folded=n > 8)])]


def rows_section(result: CalibrationResult) -> list[Section]:
    """The rows that fit the others least."""
    pulled = result.influence
    if pulled is None:
        return []
    surprise = surprises(pulled)
    rows: list[list[str | Badge]] = []
    for i in pulled.worst(_ROWS).tolist():
        said = Badge("not believed", "bad") if pulled.left_out[i] else Badge("used")
        expected = [] if surprise is None else [significant(float(surprise[i]), 2)]
        rows.append(
            [
                str(i if result.rows is None else result.rows[i]),
                "" if result.times is None else f"{result.times[i]:.6g}",
                significant(1e3 * float(pulled.residual[i]), 3),
                significant(float(pulled.times[i]), 2),
                *expected,
                said,
            ]
        )
    caption = (
        "The rows that fit least, each by the error that a calibrator makes there which has not "
        "seen it, where rows were held out. An ordinary row has 1; look at those far above."
    )
    if result.held_out is not None and result.held_out.moves is not None:
        moves = 1e3 * float(result.held_out.moves.max())
        caption += (
            f" Without any one of the parts held out, predictions move by {significant(moves, 2)} "
            "mm at most, in the mean over the rows."
        )
    heads = ["Row", "Time [s]", "Error [mm]", "Times the ordinary"]
    if surprise is not None:
        heads.append("Times the expected")
        caption += (
            " What was expected also counts how well the model knows the robot in that posture: "
            "one row in twenty should exceed 1.6 times that, and one in a hundred 1.9 times."
        )
    words = frozenset({len(heads)})
    return [Section("Rows to look at first", [Table([*heads, ""], rows, caption, words=words)])]


def surprises(pulled: Influence) -> Array | None:
    """Error of each row over what was expected, (N,); None where nobody knew what to expect."""
    return None if pulled.expected is None else pulled.residual / pulled.expected
