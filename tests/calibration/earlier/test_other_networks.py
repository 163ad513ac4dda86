"""A correction by another network than the resource-allocating one."""

from typing import Any

import numpy as np
import pytest
from tests.calibration.earlier.worlds import sightings

from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.earlier import albus_correction
from handeye.calibration.models import PlanarModel
from handeye.calibration.storage import load_model, save_model
from handeye.errors import InvalidInput
from handeye.networks.layered import LayeredNetwork
from handeye.networks.recursive import RecursiveNetwork
from handeye.thesis.plants import NOMINAL

SEEN = sightings(60)
MODEL = PlanarModel(NOMINAL)


def by_layers():
    network = LayeredNetwork(5, 2, (6,), inputs=MODEL.space, output_scale=0.1)
    return NetworkCorrection(MODEL, network)


def by_albus():
    return albus_correction(MODEL, layers=8, slots=512)


def by_recursion():
    return NetworkCorrection(MODEL, RecursiveNetwork(5, 2, inputs=MODEL.space, capacity=20))


@pytest.mark.parametrize("make", [by_layers, by_albus, by_recursion])
def test_it_is_stored_and_goes_on_alike(make, tmp_path):
    calibrator = make()
    calibrator.observe_many(SEEN[:30])
    save_model(tmp_path / "model", calibrator, 30)
    again: Any = load_model(tmp_path / "model").calibrator
    assert repr(again) == repr(calibrator)
    np.testing.assert_array_equal(again.command(SEEN.target), calibrator.command(SEEN.target))
    for one, other in zip(
        again.observe_many(SEEN[30:]), calibrator.observe_many(SEEN[30:]), strict=True
    ):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(again.command(SEEN.target), calibrator.command(SEEN.target))


class Mine(LayeredNetwork):
    """A learner that nobody has registered."""


def test_a_learner_that_only_a_file_of_its_own_can_hold_says_so(tmp_path):
    calibrator = NetworkCorrection(MODEL, Mine(5, 2))
    with pytest.raises(InvalidInput, match=r"a Mine cannot .* its own .* save"):
        save_model(tmp_path / "model", calibrator, 0)
    assert not (tmp_path / "model").exists()
