"""The order of a log's rows: that of their times, however they stand in the file."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.io.log_files import assert_same, point_log, stereo_log

from handeye.errors import LogError
from handeye.io.logs import read_log, write_log


def shuffled(log, order):
    return replace(log, observations=log.observations[order], rows=log.rows[order])


@given(seed=st.integers(0, 100), n=st.integers(1, 30), oriented=st.booleans())
def test_any_order_of_rows_sorts_to_the_same_log(seed, n, oriented):
    log = point_log(n, oriented=oriented, std=oriented)
    # Some rows share a time stamp; then what was observed decides.
    tied = replace(log, observations=replace(log.observations, time=np.arange(n) // 3 / 2.0))
    order = np.random.default_rng(seed).permutation(n)
    one, other = tied.in_time_order(), shuffled(tied, order).in_time_order()
    assert_same(one, other)
    np.testing.assert_array_equal(one.rows, other.rows)
    assert np.all(np.diff(one.observations.time) >= 0.0)
    assert_same(log.in_time_order(), log)


@pytest.mark.parametrize("make", [point_log, stereo_log])
@pytest.mark.parametrize("way", ["reversed", "shuffled"])
def test_a_file_whose_rows_do_not_follow_time_is_sorted(tmp_path, make, way):
    log = make(40)
    order = np.arange(40)[::-1] if way == "reversed" else np.random.default_rng(3).permutation(40)
    write_log(tmp_path / "other.csv", shuffled(log, order))
    read = read_log(tmp_path / "other.csv").log
    assert_same(read, log)
    # The header is row 1 of the file.
    np.testing.assert_array_equal(read.rows, np.argsort(order) + 2)


def test_a_repeated_time_is_found_in_any_order(tmp_path):
    log = point_log(40)
    order = np.random.default_rng(3).permutation(40)
    time = log.observations.time.copy()
    time[20] = time[19]
    repeated = replace(log, observations=replace(log.observations, time=time))
    write_log(tmp_path / "other.csv", shuffled(repeated, order))
    at = np.argsort(order)
    first, second = sorted([at[19], at[20]])
    with pytest.raises(LogError, match=f"row {second + 2}: .* repeats that of row {first + 2}"):
        read_log(tmp_path / "other.csv")
