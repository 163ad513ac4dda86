"""`handeye suggest` with what the sensor sees, and what `handeye calibrate` expects anywhere."""

import json

import pytest
from tests.cli.running import done, refused

from handeye.calibration.view import View
from handeye.cli.suggest import _view


def test_degrees_across_become_a_cone():
    assert _view(None, 0.0, None, None) is None
    view = _view(60.0, 0.2, 1.5, 90.0)
    assert view is not None
    assert view.half_angle == pytest.approx(0.5235987755982988)
    assert (view.near, view.far) == (0.2, 1.5)
    assert view.facing == pytest.approx(1.5707963267948966)
    assert _view(None, 0.3, None, None) == View(near=0.3)


def test_a_planar_robot_expects_misses_at_its_rows_and_has_no_view(tmp_path):
    log = tmp_path / "work.csv"
    done("simulate", log, "--rows", 150)
    out = done("calibrate", log, "--robot", "planar", "--out", tmp_path, "--json", "-").stdout
    data = json.loads(out)
    expected = data["expected_error"]
    assert set(expected) == {"rows", "held_out"}
    assert expected["rows"]["n"] == len(data["influence"]["expected"]) == 150
    held = expected["held_out"]
    assert 0.5 < held["found_rms"] / held["expected_rms"] < 2.0
    assert 0.7 < held["within"] <= 1.0
    model = tmp_path / "work.model.safetensors"
    assert "planar robot's eye turns" in refused("suggest", model, "--field-of-view", 60)
    assert "far must exceed near" in refused("suggest", model, "--near", 2, "--far", 1)
