"""Stored estimators: the same one again, or an error that names the file."""

import json
from typing import Any

import numpy as np
import pytest
from tests.calibration.cases import sightings as world_sightings
from tests.calibration.estimation.estimators import (
    CLEAN,
    EVERY_METHOD,
    MODEL,
    arrays,
    assert_same,
    learned,
)

from handeye.calibration.estimation import (
    ParameterEstimator,
    Recursive,
    Refit,
)
from handeye.calibration.storage import load_model, save_model
from handeye.calibration.world import PlanarWorld
from handeye.errors import FileFormatError
from handeye.io.tensors import read_tensors, write_tensors
from handeye.thesis.plants import NORMAL


@EVERY_METHOD
def test_a_loaded_estimator_commands_and_learns_on_alike(method, tmp_path):
    seen = world_sightings(NORMAL, 40)
    estimator = ParameterEstimator(MODEL, method)
    estimator.observe_many(seen[:25])
    save_model(tmp_path / "model", estimator, 25)
    stored = load_model(tmp_path / "model")
    loaded: Any = stored.calibrator
    assert stored.observed == 25
    assert type(loaded) is ParameterEstimator
    assert loaded.method == method
    assert loaded.model == MODEL
    assert_same(loaded.observe_many(seen[25:]), estimator.observe_many(seen[25:]))
    assert_same(arrays(loaded), arrays(estimator))
    np.testing.assert_array_equal(loaded.parameters, estimator.parameters)


DAMAGE = {
    "no array": lambda a, h: (a.pop("estimator.R"), h),
    "singular": lambda a, h: (a.update({"estimator.R": np.zeros((8, 8))}), h),
    "not triangular": lambda a, h: (a.update({"estimator.R": np.ones((8, 8))}), h),
    "short": lambda a, h: (a.update({"estimator.z": np.zeros(6)}), h),
    "not finite": lambda a, h: (a.update({"estimator.z": np.full(8, np.nan)}), h),
    "other kind": lambda a, h: (a, h["estimator"].update(kind="Oracle")),
    "bad setting": lambda a, h: (a, h["estimator"].update(drift=2.0)),
    "no assumptions": lambda a, h: (a, h["estimator"].pop("assumptions")),
    "other free": lambda a, h: (a, h["estimator"]["assumptions"].update(free=["a", "q"])),
    "no settings": lambda a, h: (a, h.pop("estimator")),
    "other model": lambda a, h: (a, h.update(model="PlanarMap")),
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE.keys())
def test_a_damaged_file_is_refused_by_name(damage, tmp_path):
    path = tmp_path / "estimator.model"
    save_model(path, learned(Recursive(), PlanarWorld(NORMAL), 5), 5)
    parts, header = read_tensors(path, "handeye.model", 1, "a model")
    damage(parts, header)
    write_tensors(path, "handeye.model", 1, parts, json.loads(json.dumps(header)))
    with pytest.raises(FileFormatError, match=r"estimator\.model"):
        load_model(path)


@pytest.mark.parametrize(
    "shapes", [{"rows": np.zeros((3, 5))}, {"parameters": np.zeros(7)}], ids=["rows", "parameters"]
)
def test_a_damaged_window_is_refused(shapes, tmp_path):
    save_model(tmp_path / "model", learned(Refit("forward"), PlanarWorld(CLEAN), 9), 9)
    parts, header = read_tensors(tmp_path / "model", "handeye.model", 1, "a model")
    parts |= {f"estimator.{name}": array for name, array in shapes.items()}
    write_tensors(tmp_path / "model", "handeye.model", 1, parts, header)
    with pytest.raises(FileFormatError):
        load_model(tmp_path / "model")
