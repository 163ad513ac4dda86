"""What is said of rows and columns of a log that cannot be right."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from tests.io.log_files import HEADER, ROWS, error_of

from handeye.io.logs import BadRow, read_log
from handeye.io.validation import increasing


@pytest.mark.parametrize(
    ("row", "problem"),
    [
        ("1,,0.3,1,2,3", "a_rad is empty"),
        ("1,0.2,0.3,1,oops,3", "y_m is 'oops', not a finite number"),
        ("1,0.2,0.3,nan,2,3", "x_m is 'nan', not a finite number"),
        ("1,0.2,0.3,1,2,-inf", "z_m is '-inf', not a finite number"),
        ("1,0.2,0.3,1,2", "has 5 cells where the header has 6"),
        ("1,0.2,0.3,1,2,3,4", "has 7 cells where the header has 6"),
        ("0,0.2,0.3,1,2,3", "time_s 0 repeats that of row 2"),
        ("-1,0.2,0.3,1,2,3", "time_s -1 goes back behind row 2"),
        ("1e9,0.2,0.3,1,2,3", "time_s 1e+09 is ahead of the rows that follow"),
    ],
)
def test_a_bad_row_is_named_and_can_be_left_out(table, row, problem):
    # Row 2 is first, so the spoilt row is row 3.
    path = table(ROWS[0], row, ROWS[2], ROWS[3])
    message = error_of(path)
    assert "1 of 4 rows cannot be used" in message
    assert f"row 3: {problem}" in message
    assert "--skip-bad" in message
    reading = read_log(path, skip_bad=True)
    np.testing.assert_array_equal(reading.log.rows, [2, 4, 5])
    (bad,) = reading.rejected
    assert (bad.file, bad.row) == (str(path), 3)
    assert problem in bad.problem
    assert bad.remedy
    assert str(bad).startswith(f"{path}, row 3: ")


@pytest.mark.parametrize(
    ("header", "row", "problem"),
    [
        ("qw,qx,qy,qz", "1.02,0,0,0", "has length 1.02, not 1"),
        ("qw,qx,qy,qz", "0,0,0,0", "has length 0, not 1"),
        ("std_x_m,std_y_m,std_z_m", "1e-3,0,1e-3", "std_y_m is 0, not positive"),
        ("std_x_m,std_y_m,std_z_m", "1e-3,1e-3,-1", "std_z_m is -1, not positive"),
    ],
)
def test_impossible_quaternions_and_deviations_are_named(table, header, row, problem):
    good = {"qw": "1,0,0,0", "st": "1e-3,1e-3,1e-3"}[header[:2]]
    path = table(
        f"{ROWS[0]},{good}", f"{ROWS[1]},{row}", f"{ROWS[2]},{good}", header=f"{HEADER},{header}"
    )
    assert problem in error_of(path)
    assert [bad.row for bad in read_log(path, skip_bad=True).rejected] == [3]


STEREO = "time_s,alpha_rad,beta_rad,pointing_rad,range_m,eccentricity_rad"


@pytest.mark.parametrize("distance", ["0", "-1.5"])
def test_ranges_must_be_positive(table, distance):
    path = table("0,1,1,0,2,0", f"1,1,1,0,{distance},0", "2,1,1,0,2,0", header=STEREO)
    assert f"row 3: range_m is {float(distance):g}, not positive" in error_of(path)
    assert len(read_log(path, skip_bad=True).log) == 2


def test_several_problems_are_listed_up_to_five_and_counted(table):
    path = table(*(f"{i},0,0,{'x' if i % 2 else 1},2,3" for i in range(20)))
    message = error_of(path)
    assert "10 of 20 rows cannot be used" in message
    assert "row 3: x_m is 'x'" in message
    assert "and 5 more" in message
    reading = read_log(path, skip_bad=True)
    assert [bad.row for bad in reading.rejected] == list(range(3, 23, 2))
    assert isinstance(reading.rejected[0], BadRow)


def test_nothing_left_is_an_error_even_when_bad_rows_are_skipped(table):
    assert "no usable row is left" in error_of(table("0,x,0,1,2,3", "1,0"), skip_bad=True)


@pytest.mark.parametrize(
    ("column", "factor", "said"),
    [
        ("a_rad", 57.3, "degrees; multiply the column by pi/180"),
        ("y_m", 1000.0, "millimetres; divide the column by 1000"),
    ],
)
def test_a_column_in_the_wrong_unit_is_never_skipped(table, column, factor, said):
    names = HEADER.split(",")
    rows = np.array([[float(cell) for cell in row.split(",")] for row in ROWS])
    rows[:, names.index("a_rad")] += 1.0
    rows[:, names.index(column)] *= factor
    path = table(*(",".join(map(str, row)) for row in rows))
    for skip in (False, True):
        message = error_of(path, skip_bad=skip)
        assert f"{column}: 4 of 4 values are beyond" in message
        assert "the first in row 2" in message
        assert said in message


def test_a_stereo_column_in_the_wrong_unit_is_never_skipped(table):
    path = table(*(f"{i},1,1,30,2000,0" for i in range(4)), header=STEREO)
    message = error_of(path, skip_bad=True)
    assert "pointing_rad: 4 of 4" in message
    assert "range_m: 4 of 4" in message


def test_up_to_a_twentieth_of_impossible_values_are_bad_rows_not_a_wrong_unit(table):
    def spoilt(angles, places):
        return table(
            *(
                f"{i},{99 if i < angles else 0.1},0,1,2,{60 if i > 99 - places else 3}"
                for i in range(100)
            )
        )

    path = spoilt(5, 1)
    assert "a_rad is 99, beyond 4 pi rad" in error_of(path)
    assert [bad.row for bad in read_log(path, skip_bad=True).rejected] == [2, 3, 4, 5, 6, 101]
    assert "a_rad: 6 of 100 values are beyond" in error_of(spoilt(6, 1), skip_bad=True)
    assert "z_m: 6 of 100 values are beyond" in error_of(spoilt(0, 6), skip_bad=True)


def test_a_clock_that_never_ran_is_not_skipped(table):
    path = table(*("5,0,0,1,2,3" for _ in range(10)))
    assert "time_s does not increase" in error_of(path, skip_bad=True)


@given(arrays(np.float64, st.integers(0, 9), elements=st.integers(0, 5).map(float)))
def test_increasing_keeps_as_many_as_possible(values):
    kept = increasing(values)
    assert np.all(np.diff(values[kept]) > 0.0)
    assert kept == sorted(set(kept))
    longest = [1] * len(values)
    for i in range(len(values)):
        longest[i] += max((longest[j] for j in range(i) if values[j] < values[i]), default=0)
    assert len(kept) == max(longest, default=0)


@pytest.mark.parametrize(
    ("values", "kept"),
    [
        ([1, 2, 3, 2.5, 4], [0, 1, 2, 4]),
        ([1, 2, 2, 3], [0, 1, 3]),
        ([1, 2, 1e9, 4, 5], [0, 1, 3, 4]),
        ([9, 1, 2, 3], [1, 2, 3]),
    ],
)
def test_increasing_believes_the_clock_until_it_goes_back(values, kept):
    assert increasing(np.array(values, dtype=float)) == kept
