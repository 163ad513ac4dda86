"""Tables of targets in, tables of commands out."""

import csv

import numpy as np
import pytest

from handeye.errors import LogError
from handeye.io.targets import (
    commands_as_csv,
    read_point_targets,
    read_stereo_targets,
    write_commands,
)

STEREO = "pointing_rad,range_m,eccentricity_rad,elbow"
POINT = "x_m,y_m,z_m,pan_rad,tilt_rad"
JOINTS = ("pan", "tilt")


@pytest.fixture
def table(tmp_path):
    def write(header, *rows):
        path = tmp_path / "targets.csv"
        path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
        return path

    return write


def test_planar_targets(table):
    targets = read_stereo_targets(table(STEREO, "0.1,1.5,-0.2,1", "-0.3,2.5,0.25,-1.0"))
    np.testing.assert_array_equal(targets.pointing, [0.1, -0.3])
    np.testing.assert_array_equal(targets.range, [1.5, 2.5])
    np.testing.assert_array_equal(targets.eccentricity, [-0.2, 0.25])
    np.testing.assert_array_equal(targets.elbow, [1.0, -1.0])


def test_targets_in_space_take_columns_by_name_and_ignore_others(table):
    header = "note,tilt_rad,z_m,y_m,x_m,pan_rad"
    targets = read_point_targets(table(header, "cup,0.5,3,2,1,0.4", "jar,0.7,6,5,4,0.6"), JOINTS)
    np.testing.assert_array_equal(targets.position, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    np.testing.assert_array_equal(targets.posture, [[0.4, 0.5], [0.6, 0.7]])


@pytest.mark.parametrize("elbow", ["0", "2", "-0.5"])
def test_an_elbow_that_is_no_sign_is_refused_with_its_target(table, elbow):
    path = table(STEREO, "0.1,1.5,0,1", f"0.1,1.5,0,{elbow}")
    with pytest.raises(LogError) as caught:
        read_stereo_targets(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: elbow is {float(elbow):g} for target 2; give 1 where")


def test_missing_columns_are_all_named_with_what_they_may_be_called(table):
    path = table("x_mm,y_m,pan_deg,tilt_rad", "1,2,3,4")
    with pytest.raises(LogError) as caught:
        read_point_targets(path, JOINTS)
    message = str(caught.value)
    assert message.startswith(f"{path}: missing columns: x_m, z_m, pan_rad\n")
    assert "x_mm: divide it by 1000 and rename it to x_m" in message
    assert "pan_deg: multiply it by pi/180 and rename it to pan_rad" in message
    assert "found: x_mm, y_m, pan_deg, tilt_rad" in message


@pytest.mark.parametrize("cell", ["", "near", "nan", "inf", "1,2"])
def test_a_row_that_cannot_be_used_is_refused_with_its_number(table, cell):
    with pytest.raises(LogError, match=r"targets\.csv, row 3: ") as caught:
        read_stereo_targets(table(STEREO, "0.1,1.5,0,1", f"0.1,{cell},0,1"))
    assert "such rows" not in str(caught.value)


def test_more_such_rows_are_counted(table):
    with pytest.raises(LogError, match=r"row 2: .*\(2 such rows\)"):
        read_point_targets(table(POINT, *["1,2,x,4,5"] * 2), JOINTS)


def test_files_that_are_no_tables_are_refused(table, tmp_path):
    with pytest.raises(LogError, match=r"nothing\.csv: cannot be read"):
        read_stereo_targets(tmp_path / "nothing.csv")
    with pytest.raises(LogError, match="has a header but no rows"):
        read_stereo_targets(table(STEREO))
    (tmp_path / "empty.csv").write_bytes(b"")
    with pytest.raises(LogError, match="the file is empty"):
        read_stereo_targets(tmp_path / "empty.csv")
    (tmp_path / "binary.csv").write_bytes(bytes(range(256)))
    with pytest.raises(LogError, match="is not a table of text"):
        read_stereo_targets(tmp_path / "binary.csv")


def test_parquet_is_read_as_well(tmp_path):
    arrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "targets.parquet"
    columns = dict(zip(STEREO.split(","), [[0.1], [1.5], [0.0], [-1]], strict=True))
    parquet.write_table(arrow.table(columns), path)
    targets = read_stereo_targets(path)
    np.testing.assert_array_equal(targets.elbow, [-1.0])
    np.testing.assert_array_equal(targets.range, [1.5])


def test_commands_are_written_to_the_last_bit(tmp_path):
    commands = np.random.default_rng(0).normal(size=(20, 2)) / 3.0
    path = tmp_path / "new folder" / "commands.csv"
    write_commands(path, JOINTS, commands)
    assert path.read_text() == commands_as_csv(JOINTS, commands)
    header, *rows = csv.reader(path.read_text().splitlines())
    assert header == ["pan_rad", "tilt_rad"]
    np.testing.assert_array_equal(np.array(rows, float), commands)


def test_commands_that_cannot_be_written_are_reported(tmp_path):
    (tmp_path / "commands.csv").mkdir()
    with pytest.raises(LogError, match=r"commands\.csv: cannot be written"):
        write_commands(tmp_path / "commands.csv", JOINTS, np.zeros((1, 2)))
    assert [p.name for p in tmp_path.iterdir()] == ["commands.csv"]
