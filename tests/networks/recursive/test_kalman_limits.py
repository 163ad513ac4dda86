"""Room for new neurons in a KalmanNetwork, and what it refuses."""

import numpy as np
import pytest

from handeye.errors import InvalidInput
from handeye.networks import InputSpace
from handeye.networks.recursive import KalmanNetwork


def test_the_least_useful_neuron_makes_room():
    def learned(tolerance):
        network = KalmanNetwork(
            1, 1, inputs=InputSpace.scaled([1.0]), capacity=3, neighbours=1, overlap=0.3,
            prune_tolerance=tolerance,
        )  # fmt: skip
        network.learn_many([[0.0], [5.0], [10.0]], [[2.0], [0.05], [-2.0]])
        return network, network.learn([20.0], [1.0])

    for tolerance, allocated in ((0.0, False), (0.01, False), (0.1, True)):
        network, result = learned(tolerance)
        assert result.allocated == allocated
        assert network.n_neurons == 3
        assert (20.0 in network.centers) == allocated
        assert (5.0 in network.centers.round(3)) != allocated
    np.testing.assert_allclose(network.predict([20.0]), [1.0])


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("capacity", 0), ("neighbours", 0), ("overlap", 0.0), ("weight_deviation", -1.0),
        ("shape_deviation", -1.0), ("scale_deviation", np.nan), ("noise_deviation", 0.0),
        ("forgetting", 1.01), ("forgetting", 0.4), ("inputs", InputSpace.scaled([1.0])),
        ("prune_tolerance", -1.0),
    ],
)  # fmt: skip
def test_refuses_settings_out_of_range(name, value):
    with pytest.raises(InvalidInput, match=name):
        KalmanNetwork(2, 2, **{name: value})
