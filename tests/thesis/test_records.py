import numpy as np
import pytest

from handeye.errors import InvalidInput
from handeye.thesis.experiment import Curve
from handeye.thesis.records import Record, Records, flatten


def curves() -> Records:
    at = np.array([0.0, 100.0, 200.0])
    rows = [
        row
        for replicate in range(2)
        for row in flatten(
            "e",
            "s",
            replicate,
            {"error": Curve(at, at / 100.0 + replicate), "total": 7 + replicate},
        )
    ]
    return Records(rows)


def test_numbers_and_points_of_curves_are_rows():
    assert curves().rows[1] == Record("e", "s", 0, "error", 100.0, 1.0)
    assert curves().rows[3] == Record("e", "s", 0, "total", None, 7.0)
    assert len(curves().rows) == 8


def test_values_are_numbers_ends_of_curves_or_points_of_them():
    np.testing.assert_array_equal(curves().values("e/s/total"), [7.0, 8.0])
    np.testing.assert_array_equal(curves().values("e/s/error"), [2.0, 3.0])
    np.testing.assert_array_equal(curves().values("e/s/error@100"), [1.0, 2.0])


def test_a_curve_has_one_row_for_each_replicate():
    at, values = curves().curve("e/s/error")
    np.testing.assert_array_equal(at, [0.0, 100.0, 200.0])
    np.testing.assert_array_equal(values, [[0.0, 1.0, 2.0], [1.0, 2.0, 3.0]])


def test_settings_are_in_order_of_appearance():
    rows = [Record("e", s, 0, "q", None, 0.0) for s in ("b", "a", "b")]
    assert Records(rows).settings("e") == ("b", "a")


def test_what_was_not_measured_is_an_error():
    with pytest.raises(InvalidInput, match="did you mean e/s/total"):
        curves().values("e/s/totale")
    with pytest.raises(InvalidInput, match="not measured after 150"):
        curves().values("e/s/error@150")
    with pytest.raises(InvalidInput, match="not one curve"):
        curves().curve("e/s/total")


def test_curves_measured_at_different_trials_are_not_one():
    rows = [Record("e", "s", i, "q", float(i), 0.0) for i in range(2)]
    with pytest.raises(InvalidInput, match="not one curve"):
        Records(rows).curve("e/s/q")
