"""Logs on disk: what comes back, and what is said of what cannot be used."""

import time
from dataclasses import fields, replace

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from pyarrow import parquet

from handeye.errors import LogError, MissingExtra
from handeye.io.logs import BadRow, Log, read_log, write_log
from handeye.io.validation import increasing
from handeye.observations import PointObservation, StereoObservation

HEADER = "time_s,a_rad,b_rad,x_m,y_m,z_m"
ROWS = ["0,0.1,0.2,1,2,3", "1,0.2,0.3,1.1,2.1,3.1", "2,0.3,0.4,1.2,2.2,3.2", "3,0.4,0.5,1,2,3"]


@pytest.fixture
def table(tmp_path):
    def write(*rows, header=HEADER, name="run.csv"):
        path = tmp_path / name
        path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
        return path

    return write


def error_of(path, **options):
    with pytest.raises(LogError) as caught:
        read_log(path, **options)
    assert str(path) in str(caught.value)
    return str(caught.value)


def point_log(n, joints=("a", "b"), *, oriented=False, std=False, seed=0):
    rng = np.random.default_rng(seed)
    wxyz = rng.normal(size=(n, 4))
    seen = PointObservation(
        np.cumsum(rng.uniform(0.01, 1.0, n)),
        rng.uniform(-3.0, 3.0, (n, len(joints))),
        rng.normal(size=(n, 3)),
        wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True) if oriented else None,
        rng.uniform(1e-5, 1e-3, (n, 3)) if std else None,
    )
    return Log("made", joints, seen, np.arange(2, n + 2))


def stereo_log(n, seed=0):
    rng = np.random.default_rng(seed)
    seen = StereoObservation(
        np.arange(float(n)),
        rng.uniform(-3.0, 3.0, (n, 2)),
        rng.uniform(-1.0, 1.0, n),
        rng.uniform(0.1, 5.0, n),
        rng.uniform(-1.0, 1.0, n),
    )
    return Log("made", ("alpha", "beta"), seen, np.arange(2, n + 2))


def assert_same(read, written):
    assert type(read.observations) is type(written.observations)
    assert read.joint_names == written.joint_names
    for field in fields(written.observations):
        want = getattr(written.observations, field.name)
        have = getattr(read.observations, field.name)
        if want is None:
            assert have is None
        else:
            np.testing.assert_array_equal(have, want)


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


def test_a_hundred_thousand_rows_take_seconds(tmp_path):
    names = tuple(f"joint_{i}" for i in range(6))
    log = point_log(100_000, names, oriented=True, std=True)
    path = tmp_path / "long.csv"
    write_log(path, log)
    start = time.perf_counter()
    reading = read_log(path)
    assert time.perf_counter() - start < 20.0
    assert_same(reading.log, log)
    spoilt = replace(
        log.observations, time=np.where(np.arange(100_000) % 3, log.observations.time, 0.0)
    )
    write_log(path, replace(log, observations=spoilt))
    start = time.perf_counter()
    # The first row's time is right, every third after it is not.
    assert len(read_log(path, skip_bad=True).rejected) == 33_333
    assert time.perf_counter() - start < 20.0
