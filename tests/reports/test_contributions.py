"""What each part of a model takes away of the errors, on the page of a calibration."""

from dataclasses import replace
from typing import Any

from tests.reports.made_up import ur_run

from handeye.calibration.results import ErrorSummary
from handeye.reports.calibration import calibration_page
from handeye.reports.calibration_parts import contributions_table
from handeye.reports.style import significant


def parts_run() -> Any:
    """Geometry takes half away, curves the rest; turns fall at once."""
    result: Any = ur_run(n=60)
    held = result.held_out
    rigid = replace(held, rigid=0.5 * held.before, turns_rigid=held.turns_after)
    return replace(result, held_out=rigid, method="combined")


def test_each_part_is_told_in_mm_and_degrees():
    result = parts_run()
    (table,) = contributions_table(result)
    assert table.columns[1:] == (
        "Mean error with it [mm]", "It takes away [mm]",
        "Mean turn with it [°]", "It takes away [°]",
    )  # fmt: skip
    assert [row[0] for row in table.rows] == ["Placement", "Geometry", "Error curves"]
    was = 1e3 * ErrorSummary.of(result.held_out.before).mean
    assert table.rows[1][1:3] == [significant(0.5 * was, 3), significant(0.5 * was, 2)]
    assert table.rows[0][2] == table.rows[0][4] == ""
    assert table.rows[2][4] == "0"
    assert "It takes away [mm]" in calibration_page(result).html()


def test_where_no_orientation_was_measured_there_are_no_degrees():
    result = parts_run()
    plain = replace(result.held_out, turns_before=None, turns_after=None, turns_rigid=None)
    (table,) = contributions_table(replace(result, held_out=plain))
    assert len(table.columns) == len(table.rows[0]) == 3


def test_nothing_is_told_of_what_was_not_held_out_or_not_learned():
    assert contributions_table(replace(parts_run(), held_out=None)) == []
    assert contributions_table(replace(parts_run(), method="nominal")) == []
