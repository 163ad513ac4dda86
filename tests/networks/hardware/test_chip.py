"""A chip equals the network that it came from, to rounding or to the bound of its words."""

import numpy as np
import pytest
from tests.networks.hardware.made import SPACE, samples, trained
from tests.networks.samples import fewer

from handeye.errors import InvalidInput
from handeye.networks import (
    CMAC,
    Cosine,
    FixedPoint,
    FixedVirtualNeuron,
    GradientDescent,
    HardwareNetwork,
    LearningDiverged,
    NoAdaptation,
    Parabolic,
    ResourceAllocatingNetwork,
    VirtualNeuron,
)
from handeye.networks.hardware.bounds import prediction_bound

RULES = [VirtualNeuron(), CMAC(), FixedVirtualNeuron(0.4)]


@pytest.mark.parametrize("taught", RULES, ids=lambda taught: type(taught).__name__)
def test_in_double_precision_the_phases_are_the_network(taught):
    network = trained(adaptation=taught)
    chip = HardwareNetwork.of(network, None)
    x, targets = samples(1, fewer(200, 40))
    np.testing.assert_allclose(chip.predict_many(x), network.predict_many(x), atol=1e-13)
    mine, theirs = chip.learn_many(x, targets), network.learn_many(x, targets)
    np.testing.assert_allclose(mine.error, theirs.error, atol=1e-13)
    np.testing.assert_allclose(chip.weights, network.weights, atol=1e-12)
    assert not mine.allocated.any()


@pytest.mark.parametrize("curve", [Cosine(), Parabolic()], ids=lambda curve: type(curve).__name__)
def test_other_responses_too(curve):
    network = trained(response=curve)
    x, targets = samples(1, fewer(200, 40))
    exact = network.predict_many(x)
    np.testing.assert_allclose(HardwareNetwork.of(network, None).predict_many(x), exact, atol=1e-13)
    network.learn_many(x, targets)
    for word_length in (12, 20):
        chip = HardwareNetwork.of(network, FixedPoint(word_length))
        away = np.abs(chip.predict_many(x) - network.predict_many(x))
        assert np.all(away <= prediction_bound(chip))


@pytest.mark.parametrize("taught", RULES, ids=lambda taught: type(taught).__name__)
def test_the_error_shrinks_with_every_bit_and_stays_within_the_bound(taught):
    network = trained(adaptation=taught)
    x, targets = samples(1, fewer(200, 40))
    exact = network.predict_many(x)
    after = network.copy()
    after.learn_many(x, targets)
    bounds, away = [], []
    for word_length in (8, 12, 16, 20, 24):
        chip = HardwareNetwork.of(network, FixedPoint(word_length))
        bound = prediction_bound(chip)
        assert np.all(np.abs(chip.predict_many(x) - exact) <= bound)
        chip.learn_many(x, targets)
        away.append(np.abs(chip.predict_many(x) - after.predict_many(x)).max())
        bounds.append(bound.max())
    np.testing.assert_allclose(bounds[:-1] / np.array(bounds[1:]), 16.0, rtol=0.25)
    # After many lessons what was rounded away adds up, for CMAC most: it rounds once for all.
    assert np.all(np.array(away) <= 2.0 * np.array(bounds))
    assert away[-1] < 2e-5


def test_the_bound_is_not_idle():
    network = trained()
    chip = HardwareNetwork.of(network, FixedPoint(12))
    x, _ = samples(1, fewer(500, 100))
    worst = np.abs(chip.predict_many(x) - network.predict_many(x)).max()
    assert worst > 0.02 * prediction_bound(chip).max()
    with pytest.raises(InvalidInput, match="floating point"):
        prediction_bound(HardwareNetwork.of(network, None))


@pytest.mark.parametrize("taught", RULES, ids=lambda taught: type(taught).__name__)
@pytest.mark.parametrize("fixed", [None, FixedPoint(24)], ids=["double", "24 bits"])
def test_one_lesson_is_the_equation(taught, fixed):
    network = trained(adaptation=taught)
    chip = HardwareNetwork.of(network, fixed)
    before = chip.weights
    x, target = np.array([0.2, 0.4, -0.3]), np.array([0.7, -0.2])
    z = np.sum(((network.centers - x) / SPACE.scales) ** 2, axis=1)
    o = np.exp(-z / network.widths)
    active = o > taught.on_threshold
    match taught:
        case CMAC():
            v = np.ones_like(o)
        case VirtualNeuron():
            v = 2.0 ** (-z / (1.2**2 * z[active].min()))
        case _:
            v = 2.0 ** (-z / taught.half_distance**2)
    v = np.where(active, v, 0.0)
    error = target - network.predict(x)
    expected = taught.rate * np.outer(v, error) / (v @ o)
    assert 3 < active.sum() < len(o)
    np.testing.assert_allclose(
        chip.learn(x, target).error, error, atol=1e-13 if fixed is None else 1e-5
    )
    off = 1e-12
    if fixed is not None:  # half a step of a weight, and what the tables are off
        assert chip.design.ranges is not None
        off = 0.5 * chip.design.ranges.weights / 2**23 + 1e-4 * np.abs(expected).max()
    np.testing.assert_allclose(chip.weights - before, expected, rtol=0.0, atol=off)
    assert np.all((chip.weights - before)[~active] == 0.0)


def test_errors_below_the_threshold_and_silent_neurons_teach_nothing():
    network = trained(learning_threshold=0.05)
    for fixed in (None, FixedPoint(16)):
        chip = HardwareNetwork.of(network, fixed)
        x = np.array([0.2, 0.4, -0.3])
        before = chip.weights
        chip.learn(x, chip.predict(x) + 0.03)
        np.testing.assert_array_equal(chip.weights, before)
        chip.learn(x, chip.predict(x) + 0.04)
        assert not np.array_equal(chip.weights, before)
    silent = HardwareNetwork.of(trained(adaptation=VirtualNeuron(on_threshold=0.999)), None)
    before = silent.weights
    silent.learn(x, [0.5, 0.5])
    np.testing.assert_array_equal(silent.weights, before)


def test_words_saturate():
    chip = HardwareNetwork.of(trained(), FixedPoint(10, weight_range=1.0, output_range=0.25))
    edge = np.array([[1e6, -1e6, 0.0]])
    ranges = chip.design.ranges
    assert ranges is not None
    inside = np.clip(edge, *(SPACE.scales * (ranges.middle + s * ranges.half) for s in (-1, 1)))
    np.testing.assert_array_equal(chip.predict_many(edge), chip.predict_many(inside))
    x, _ = samples(3, fewer(400, 100))
    for _ in range(5):
        chip.learn_many(x, np.full((len(x), 2), 1e50))
    assert chip.predict_many(x).max() == 0.25 * 511 / 512
    assert chip.weights.max() <= 1.0 * 511 / 512


def test_random_rounding_learns_what_rounding_to_the_nearest_loses():
    x, targets = samples(4, fewer(3000, 800))
    ends = {}
    for rounding in ("nearest", "random"):
        network = trained(adaptation=CMAC())
        chip = HardwareNetwork.of(
            network, FixedPoint(8, weight_range=2.0, output_range=2.0, rounding=rounding)
        )
        chip.learn_many(x, targets + 0.2)
        ends[rounding] = np.abs(targets + 0.2 - chip.predict_many(x)).mean()
    assert ends["random"] < 0.6 * ends["nearest"]


def test_a_frozen_chip_only_predicts():
    network = trained(adaptation=GradientDescent())
    chip = HardwareNetwork.of(network, learns=False)
    assert isinstance(chip.design.adaptation, NoAdaptation)
    before = chip.weights
    chip.learn_many(*samples(5, 20))
    np.testing.assert_array_equal(chip.weights, before)


def test_what_a_chip_cannot_be_is_refused():
    with pytest.raises(InvalidInput, match=r"cannot learn by GradientDescent.*VirtualNeuron, CMAC"):
        HardwareNetwork.of(trained(adaptation=GradientDescent()))
    with pytest.raises(InvalidInput, match="has 0 and 3: let it learn first"):
        HardwareNetwork.of(ResourceAllocatingNetwork(3, 2))
    with pytest.raises(InvalidInput, match=r"more than 2\^7"):
        HardwareNetwork.of(trained(), FixedPoint(16, weight_range=100.0, output_range=0.1))


@pytest.mark.parametrize(
    "settings",
    [{"word_length": 7}, {"word_length": 25}, {"word_length": 16.0}, {"weight_range": 0.0},
     {"output_range": np.inf}, {"rounding": "down"}, {"table_bits": 0}, {"table_bits": 15},
     {"seed": 0}, {"seed": 2**32}],
)  # fmt: skip
def test_settings_out_of_range_are_refused(settings):
    with pytest.raises(InvalidInput, match=next(iter(settings))):
        FixedPoint(**settings)


def test_a_rule_that_diverges_leaves_the_weights_as_they_were():
    network = trained()
    network.adaptation = VirtualNeuron(rate=1e9)
    chip = HardwareNetwork.of(network, None)
    before = chip.weights
    x, targets = samples(6, 500)
    with pytest.raises(LearningDiverged, match="smaller rate"):
        chip.learn_many(x, targets)
    np.testing.assert_array_equal(chip.weights, before)
