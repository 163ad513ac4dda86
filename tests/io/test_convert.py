"""Foreign files become logs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from handeye.errors import LogError
from handeye.io.convert import CONVERTERS, Converter, convert, register
from handeye.io.logs import read_log, write_log
from handeye.observations import PointObservation

JOINTS = (
    "shoulder_pan_joint;shoulder_lift_joint;elbow_joint;wrist_1_joint;wrist_2_joint;wrist_3_joint"
)
MEASURED = ";".join(
    f"measurement_{axis};measurement_std_{axis}" for axis in ("x", "y", "z", "rx", "ry", "rz")
)
HEADER = f"Timestamp;{JOINTS};{MEASURED}"
ROW = "2,02E+13;0,1;-0,2;0,3;-2,78E-05;0,5;0,6;100,5;0,01;-200;0,02;300;0,03;90;0,1;0;0,1;45;0,1"


@pytest.fixture
def foreign(tmp_path):
    def write(*rows, header=HEADER):
        path = tmp_path / "measured.csv"
        path.write_bytes("\r\n".join([header, *rows, ""]).encode())
        return path

    return write


@pytest.mark.parametrize("kind", [None, "ur10-joint-configurations"])
def test_units_decimal_commas_and_angles_of_the_ur10_file(foreign, kind):
    log = convert(foreign(ROW, ROW), kind)
    assert log.joint_names == tuple(JOINTS.split(";"))
    seen = log.observations
    assert isinstance(seen, PointObservation)
    assert seen.orientation is not None
    assert seen.position_std is not None
    np.testing.assert_array_equal(seen.time, [0.0, 1.0])
    np.testing.assert_array_equal(seen.joints[0], [0.1, -0.2, 0.3, -2.78e-05, 0.5, 0.6])
    np.testing.assert_allclose(seen.position[0], [0.1005, -0.2, 0.3], rtol=1e-15)
    np.testing.assert_allclose(seen.position_std[0], [1e-5, 2e-5, 3e-5], rtol=1e-15)
    # Intrinsic: 90 degrees about x, then 45 about the z that came with it.
    turn = Rotation.from_rotvec([np.pi / 2, 0, 0]) * Rotation.from_rotvec([0, 0, np.pi / 4])
    np.testing.assert_allclose(
        Rotation.from_quat(seen.orientation[0], scalar_first=True).as_matrix(),
        turn.as_matrix(),
        atol=1e-15,
    )


def test_bad_cells_are_named_as_they_stand_in_the_file(foreign):
    path = foreign(ROW, ROW.replace("300;", ";"))
    with pytest.raises(LogError, match="row 3: measurement_z is empty"):
        convert(path)
    with pytest.raises(LogError, match=r"row 3: measurement_rz is 'north'"):
        convert(foreign(ROW, ROW.replace("45;", "north;")))


def test_files_of_no_known_kind_are_refused_with_the_known_kinds(foreign, tmp_path):
    junk = tmp_path / "junk"
    junk.write_bytes(bytes(range(256)))
    for path in (foreign("1,2", header="a,b"), junk):
        with pytest.raises(LogError, match="known kinds:\n  ur10-joint-configurations: UR10"):
            convert(path)
    with pytest.raises(LogError, match="no converter is called 'ur11'"):
        convert(foreign(ROW), "ur11")
    with pytest.raises(LogError, match="is not that of kind 'ur10-joint-configurations'"):
        convert(foreign("1,2", header="a,b"), "ur10-joint-configurations")
    with pytest.raises(LogError, match="No such file"):
        convert(tmp_path / "absent.csv")


def test_a_new_kind_can_be_registered(foreign):
    made = convert(foreign(ROW))
    kind = Converter("mine", "two columns", ",", lambda names: names == ("a", "b"), lambda _: made)
    register(kind)
    try:
        assert convert(foreign("1,2", header="a,b")) is made
        register(replace(kind, description="other words"))
        assert CONVERTERS["mine"].description == "other words"
    finally:
        del CONVERTERS["mine"]


def test_the_whole_ur10_file_becomes_a_log_that_reads_back(shared_data, tmp_path):
    folder = shared_data / "ur10_joint_configurations"
    log = convert(folder / "measurements_joint_configurations.csv")
    assert len(log) == 1495
    write_log(tmp_path / "ur10.csv", log)
    read = read_log(tmp_path / "ur10.csv").log
    assert read.joint_names == log.joint_names
    assert isinstance(read.observations, PointObservation)
    assert isinstance(log.observations, PointObservation)
    np.testing.assert_array_equal(read.observations.position, log.observations.position)
    np.testing.assert_array_equal(read.observations.orientation, log.observations.orientation)
    assert log.observations.position_std is not None
    assert np.median(log.observations.position_std) == pytest.approx(1e-5, rel=0.5)
    with pytest.raises(LogError, match="known kinds"):
        convert(folder / "calibration_handeye.csv")
