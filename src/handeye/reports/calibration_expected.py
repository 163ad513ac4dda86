"""Part of the calibration page that says how far to trust the result anywhere."""

from handeye.calibration.expected import expected_summary
from handeye.calibration.results import CalibrationResult
from handeye.reports.figures import expected_map
from handeye.reports.page import FigureBlock, Prose, Section, Table
from handeye.reports.style import length, significant

_WHERE = {
    "rows": "At the rows of the log",
    "working_range": "In the range in which the joints worked",
    "elsewhere": "In other postures within the limits",
}
# Where so many fewer errors than nineteen in twenty stay below their bound, it is too low.
_TOO_FEW = 0.88


def expected_section(result: CalibrationResult) -> list[Section]:
    """Expected misses, whether held-out rows bear them out, and where they are large."""
    numbers = expected_summary(result)
    rows = [
        [
            words,
            f"{of['n']:,}",
            *(significant(1e3 * of[key], 3) for key in ("median", "p95", "max")),
        ]
        for name, words in _WHERE.items()
        if (of := numbers.get(name)) is not None
    ]
    if not rows:
        return []
    blocks: list[Prose | Table | FigureBlock] = [
        Table(
            ("Expected miss", "Poses", "Median [mm]", "95 % [mm]", "Max [mm]"),
            rows,
            caption="Root mean square distance by which the hand is expected to miss, from what "
            "the rows have not told of the robot and what the model leaves unexplained. It cannot "
            "count what is not in the model.",
        )
    ]
    if "held_out" in numbers:
        blocks.insert(0, Prose(_borne_out(numbers["held_out"])))
    space = result.workspace
    if space is not None:
        blocks.append(
            FigureBlock(
                expected_map(space.positions, space.expected, space.worked, space.seen),
                "Each cell has the colour of the median over poses that bring the marker there; "
                "dots are rows of the log. Where it is large, add poses (handeye suggest) before "
                "you rely on the hand.",
                "Maps of the expected miss over the workspace, from the side and from the top, for "
                "postures like those of the log and for others.",
            )
        )
    return [Section("How far to trust it anywhere", blocks)]


def _borne_out(held: dict[str, float]) -> str:
    found, expected = held["found_rms"], held["expected_rms"]
    text = (
        f"Held-out rows were expected to miss by {length(expected, beside=found)}, root mean "
        f"square, before they were looked at, and missed by {length(found, beside=expected)}. Of "
        f"their errors {100 * held['within']:.0f} % are below the size that 95 % should stay below"
    )
    if held["within"] < _TOO_FEW:
        return f"{text}: what is expected here is too low; count on more."
    return f"{text}."
