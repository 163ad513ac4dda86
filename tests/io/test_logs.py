"""Logs on disk: what is written comes back, and files that are no log are refused."""

from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyarrow import parquet
from tests.io.log_files import HEADER, ROWS, assert_same, error_of, point_log, stereo_log

from handeye.errors import LogError, MissingExtra
from handeye.io.logs import read_log, write_log
from handeye.observations import PointObservation


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@given(n=st.integers(1, 20), oriented=st.booleans(), std=st.booleans(), seed=st.integers(0, 2**32))
def test_what_is_written_is_read_back_to_the_last_bit(
    tmp_path_factory, suffix, n, oriented, std, seed
):
    path = tmp_path_factory.mktemp("log") / f"run.{suffix}"
    for log in (point_log(n, oriented=oriented, std=std, seed=seed), stereo_log(n, seed)):
        write_log(path, log)
        reading = read_log(path)
        assert reading.rejected == ()
        assert_same(reading.log, log)
        np.testing.assert_array_equal(reading.log.rows, np.arange(2, n + 2))
        assert reading.log.kind == log.kind


def test_documented_header_in_any_order_with_columns_of_others(table):
    path = table(
        "21.5,3,2,1,0.5,0.2,0.1,home", header="temperature,z_m,y_m, x_m ,time_s,b_rad,a_rad,note"
    )
    log = read_log(path).log
    assert log.joint_names == ("b", "a")
    assert log.ignored == ("temperature", "note")
    assert log.kind == "point"
    assert isinstance(log.observations, PointObservation)
    np.testing.assert_array_equal(log.observations.joints, [[0.2, 0.1]])
    np.testing.assert_array_equal(log.observations.position, [[1.0, 2.0, 3.0]])


def test_byte_order_mark_crlf_and_blank_lines_are_accepted(tmp_path):
    path = tmp_path / "windows.csv"
    text = "\r\n".join([HEADER, ROWS[0], "", ROWS[1], ""])
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    np.testing.assert_array_equal(read_log(path).log.rows, [2, 4])


def test_rounded_quaternions_are_made_unit(table):
    path = table("0,0,1,2,3,0.7071,0,0,0.7071", header="time_s,a_rad,x_m,y_m,z_m,qw,qx,qy,qz")
    seen = read_log(path).log.observations
    assert isinstance(seen, PointObservation)
    assert seen.orientation is not None
    np.testing.assert_allclose(
        seen.orientation, [[np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]], rtol=1e-15
    )


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (
            "time,a_rad,x_mm,y_m,z_m",
            [
                "missing columns: time_s, x_m",
                "found: time, a_rad, x_mm, y_m, z_m",
                "x_mm: divide it by 1000 and rename it to x_m",
                "time: if it is in seconds, rename it to time_s",
            ],
        ),
        (
            "time_s,shoulder_pan_joint,elbow_deg,x_m,y_m,z_m",
            [
                "a joint column (<joint name>_rad)",
                "shoulder_pan_joint: if it is in radians, rename it to shoulder_pan_joint_rad",
                "elbow_deg: multiply it by pi/180 and rename it to elbow_rad",
            ],
        ),
        ("time_s,a_rad,x_m,y_m,z_m,qw,qx,qy", ["missing columns: qz"]),
        ("time_s,a_rad,x_m,y_m,z_m,std_x_m", ["missing columns: std_y_m, std_z_m"]),
        ("time_s,alpha_rad,pointing_rad,range_m", ["missing columns: beta_rad, eccentricity_rad"]),
        ("time_s,a_rad,X [m],y_m,z_m", ["X [m]: rename it to x_m"]),
        ("timestamp_ms,a_rad,x_m,y_m,z_m", ["missing columns: time_s"]),
        ("time_ms,a_rad,x_m,y_m,z_m", ["time_ms: divide it by 1000 and rename it to time_s"]),
        ("time_s;a_rad;x_m;y_m;z_m", ["separate them by commas", "handeye convert"]),
    ],
)
def test_missing_columns_are_named_with_what_was_found_and_near_names(table, header, expected):
    message = error_of(table(",".join("1" * len(header.split(","))), header=header), skip_bad=True)
    for part in expected:
        assert part in message


def test_a_column_given_twice_is_refused(table):
    path = table("0,1,1,1,2,3,4", header="time_s,a_rad,a_rad,x_m,y_m,z_m,x_m")
    assert "more than one column is called a_rad" in error_of(path)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "the file is empty"),
        (bytes(range(256)) * 20, "not a table of text"),
        (b"\0" * 100, "not a table of text"),
        (b"\n\n", "not a table of text"),
        (HEADER.encode() + b"\n", "has a header but no rows"),
        (HEADER.encode("utf-16"), "not a table of text"),
        (b"x" * 200_000, "not a table of text"),
        (b"PAR1 but not really", "not a readable Parquet file"),
    ],
    ids=["empty", "binary", "zeros", "blank", "header", "utf16", "one-cell", "parquet"],
)
def test_files_that_are_no_log_are_refused(tmp_path, content, said):
    path = tmp_path / "log"
    path.write_bytes(content)
    assert said in error_of(path, skip_bad=True)


def test_missing_files_and_folders_are_refused(tmp_path):
    assert "No such file" in error_of(tmp_path / "absent.csv")
    assert "directory" in error_of(tmp_path)
    assert "not a readable Parquet" in error_of(_touched(tmp_path / "text.parquet"))


def _touched(path):
    path.write_text(HEADER)
    return path


def test_parquet_cells_that_are_no_numbers_are_named(tmp_path):
    path = tmp_path / "run.parquet"
    columns: dict[str, list[float | None]] = {n: [1.0, 2.0, 3.0] for n in HEADER.split(",")}
    columns["x_m"][1] = None
    parquet.write_table(pa.table(columns), path)
    assert "row 3: x_m is empty" in error_of(path)
    assert len(read_log(path, skip_bad=True).log) == 2
    parquet.write_table(pa.table({name: [] for name in columns}), path)
    assert "no rows" in error_of(path)


def test_parquet_without_pyarrow_names_the_extra(tmp_path, monkeypatch):
    write_log(tmp_path / "run.parquet", point_log(3))

    def absent(name):
        raise ImportError(name)

    monkeypatch.setattr("handeye.io.tables.import_module", absent)
    with pytest.raises(MissingExtra, match=r"handeye\[parquet\]"):
        read_log(tmp_path / "run.parquet")
    with pytest.raises(MissingExtra):
        write_log(tmp_path / "new.parquet", point_log(3))
    assert not (tmp_path / "new.parquet").exists()


def test_a_failed_write_says_so_and_leaves_no_debris(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(LogError, match="cannot be written"):
        write_log(tmp_path / "folder.csv", point_log(3))
    assert [path.name for path in tmp_path.iterdir()] == ["folder.csv"]


def test_a_hundred_thousand_rows_are_read_and_judged(tmp_path):
    names = tuple(f"joint_{i}" for i in range(6))
    log = point_log(100_000, names, oriented=True, std=True)
    path = tmp_path / "long.csv"
    write_log(path, log)
    reading = read_log(path)
    assert_same(reading.log, log)
    spoilt = replace(
        log.observations, time=np.where(np.arange(100_000) % 3, log.observations.time, 0.0)
    )
    write_log(path, replace(log, observations=spoilt))
    # The first row's time is right, every third after it is not.
    assert len(read_log(path, skip_bad=True).rejected) == 33_333
