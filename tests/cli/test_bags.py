"""`handeye convert` and `handeye calibrate` with recordings."""

import json
import sys
from pathlib import Path

import pytest
from tests.cli.running import done, refused
from tests.io.bags.recordings import Motion

from handeye.io.logs import read_log


@pytest.fixture(scope="module")
def recording(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("recorded")
    bag = Motion(seconds=15.0).record(delay=0.05, kind="pose", rate=100.0)
    bag.point(1.0, [1, 2, 3], topic="/clicked_point")
    return bag.write(folder, "mcap")


CHOSEN = ("--points-topic", "/tag_pose")


def test_a_recording_is_calibrated_like_a_log(
    recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    # No page: drawing it is tested elsewhere and takes longer than all of this.
    for module in [name for name in sys.modules if name.startswith("handeye.reports")]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    nominal = ("--robot", "ur10", "--method", "nominal", "--out", tmp_path)
    result = done("calibrate", recording, *nominal, *CHOSEN, "--json", "-")
    data = json.loads(result.stdout)
    assert data["n_observations"] == 138
    assert data["errors"]["held_out_after"]["mean"] < 1e-3
    made = data["recording"]
    assert made["points_topic"] == "/tag_pose"
    assert abs(made["delay_s"] - 0.05) < 3.0 * made["delay_std_s"] < 3e-3
    assert made["unused"] == [
        {
            "topic": "/clicked_point",
            "count": 1,
            "reason": "geometry_msgs/msg/PointStamped is not needed",
        }
    ]
    assert "delay of the sensor: " in result.stderr
    assert "1 other topics (1 messages) not read" in result.stderr
    assert (tmp_path / "run.model.safetensors").exists()


def test_a_recording_becomes_a_table(recording: Path, tmp_path: Path):
    table = tmp_path / "log.csv"
    options = (*CHOSEN, "--delay", "0.05", "--tolerance", "0.05")
    result = done("convert", recording, table, "--robot", "ur10", *options)
    assert "50 ms, as stated" in result.stderr
    assert "138 observations of 6 joints" in result.stderr
    log = read_log(table).log
    assert log.joint_names[0] == "shoulder_pan_joint"
    assert len(log) == 138
    done("convert", recording, tmp_path / "bare.csv", *CHOSEN)
    assert len(read_log(tmp_path / "bare.csv").log) == 138


def test_what_is_not_clear_is_asked(recording: Path, tmp_path: Path):
    table = tmp_path / "log.csv"
    message = refused("convert", recording, table)
    assert "say which with --points-topic TOPIC" in message
    assert "/clicked_point" in message
    assert "leave out --kind" in refused("convert", recording, table, "--kind", "x")
    assert "lacks joints of the robot" in refused(
        "calibrate", recording, "--robot", "panda", "--tip", "panda_link8", *CHOSEN
    )
    assert "greater than 0" in refused("convert", recording, table, "--tolerance", "0")
    assert not table.exists()


def test_options_of_recordings_are_refused_with_a_table(tmp_path: Path):
    table = tmp_path / "log.csv"
    done("simulate", table, "--rows", 20)
    message = refused("calibrate", table, "--robot", "planar", "--frame", "camera")
    assert "--frame only for recordings" in message
