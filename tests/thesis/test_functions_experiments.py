import numpy as np
import pytest

from handeye.networks.layered import LayeredNetwork, Sigmoid
from handeye.thesis.experiment import FULL, Curve, Effort
from handeye.thesis.experiments.functions_back_propagation import BACK_PROPAGATION, Layered
from handeye.thesis.experiments.functions_influence import HERE, INFLUENCE
from handeye.thesis.experiments.functions_pairs import PAIRED_SERIES, PAIRED_SIGMOIDS
from handeye.thesis.experiments.functions_structured import (
    FOURIER_STRUCTURED,
    FUNCTIONS,
    NEURONS,
    STARTS,
    Shaped,
    function_error,
)
from handeye.thesis.learning import Learning, learning_curve
from handeye.thesis.plants import NORMAL


def curve(measured: object) -> Curve:
    assert isinstance(measured, Curve)
    return measured


def test_what_a_pair_is_off_by_in_closed_form():
    smooth = PAIRED_SIGMOIDS.measure(PAIRED_SIGMOIDS.settings["smooth"], 0, FULL)
    assert smooth["inside"] == pytest.approx(1.0 - np.tanh(0.5 * np.pi), rel=1e-6)
    edge = np.tanh(1.5 * np.pi) - np.tanh(0.5 * np.pi)
    assert smooth["outside"] == pytest.approx(0.5 * edge, rel=1e-9)
    left = 1.0 - (np.tanh(-np.pi) - np.tanh(-2.0 * np.pi))  # 1 + sin(-pi) is one
    assert smooth["as_printed"] == pytest.approx(0.5 * left, rel=1e-9)
    total = curve(smooth["sum"])
    np.testing.assert_allclose(
        total.value, curve(smooth["rising"]).value + curve(smooth["falling"]).value, atol=1e-15
    )


def test_a_steep_pair_is_a_pulse():
    steep = PAIRED_SIGMOIDS.measure(PAIRED_SIGMOIDS.settings["steep"], 0, FULL)
    assert 0.0 < float(np.max(np.asarray(steep["pulse"]))) <= 0.005
    total = curve(steep["sum"])
    assert total.value[np.abs(total.at) < 1.4].min() > 1.999
    assert total.value[np.abs(total.at) > 1.8].max() < 1e-3


def test_the_series_is_that_of_a_triangle_and_pairs_follow_it():
    shown = PAIRED_SERIES.measure(4, 0, FULL)
    function, series, network = (curve(shown[n]) for n in ("function", "series", "network"))
    x = function.at
    by_hand = 4.0 / np.pi**2 * (np.cos(np.pi * x) + np.cos(3.0 * np.pi * x) / 9.0)
    np.testing.assert_allclose(series.value, by_hand, atol=1e-12)
    assert np.abs(network.value - series.value).max() < 0.17 * 4.0 / np.pi**2 * (1.0 + 1.0 / 9.0)
    parts = [curve(shown[f"harmonic-{n}"]).value for n in range(1, 5)]
    np.testing.assert_allclose(np.sum(parts, axis=0), network.value, atol=1e-12)
    np.testing.assert_allclose(parts[1], 0.0, atol=1e-12)


@pytest.mark.parametrize("kind", FUNCTIONS)
def test_functions_go_from_zero_to_one_and_differ(kind: str):
    x = np.linspace(-1.0, 1.0, 4001)
    values = [FUNCTIONS[kind](np.random.default_rng(seed))(x) for seed in range(20)]
    for value in values:
        assert value.min() >= -1e-3
        assert value.min() < 0.02
        assert 0.98 < value.max() < 1.001
    assert len({value.tobytes() for value in values}) == 20


def test_beginnings_have_the_same_neurons_and_only_one_is_random():
    sizes = {}
    for name, start in STARTS.items():
        one, other = (start(np.random.default_rng(seed)) for seed in (0, 1))
        x = np.array([[0.3]])
        assert (one.predict_many(x) != other.predict_many(x)).any() == (name == "random")
        sizes[name] = one.hidden[0] if isinstance(one, LayeredNetwork) else 2 * (one.capacity or 0)
    assert set(sizes.values()) == {NEURONS}


def test_beginnings_meet_the_same_function_and_the_error_is_the_rms_over_it():
    marks = [
        curve(
            function_error(FOURIER_STRUCTURED.settings[f"pulse-{start}"], 3, Effort(0.02))["error"]
        )
        for start in STARTS
    ]
    for one in marks[1:]:
        np.testing.assert_array_equal(one.at, marks[0].at)
    assert marks[0].at[-1] == 400.0
    constant = Shaped(lambda _: lambda x: np.full_like(x, 2.0), STARTS["gaussians"])
    error = curve(function_error(constant, 0, Effort(0.05))["error"])
    assert error.value[0] < 2.0
    assert error.value[-1] < 0.2
    silent = Shaped(lambda _: np.zeros_like, STARTS["gaussians"])
    np.testing.assert_array_equal(curve(function_error(silent, 0, Effort(0.02))["error"]).value, 0)


def test_a_layered_network_meets_the_world_of_the_preferred_one():
    setting = Layered((3,), rate=0.01, trials=20, every=10, tests=5)
    measured = BACK_PROPAGATION.measure(setting, 2, FULL)
    other = learning_curve(Learning(NORMAL, trials=20, every=10, tests=5), 2, FULL)
    np.testing.assert_array_equal(
        curve(measured["uncorrected"]).value, curve(other["uncorrected"]).value
    )
    assert set(measured) == {"error", "spread", "uncorrected"}


def test_settings_reach_the_network_and_first_weights_differ_between_replicates():
    setting = BACK_PROPAGATION.settings["plain"]
    first, again, other = (setting.calibrator(replicate).network for replicate in (0, 0, 1))
    assert isinstance(first, LayeredNetwork)
    assert first.hidden == (50, 50)
    assert first.rate == 0.1
    assert isinstance(first.kinds.hidden, Sigmoid)
    np.testing.assert_array_equal(first.output_scale, 1.0)
    assert isinstance(again, LayeredNetwork)
    assert isinstance(other, LayeredNetwork)
    np.testing.assert_array_equal(first.weights[0], again.weights[0])
    assert (first.weights[0] != other.weights[0]).all()


def changes(name: str) -> Curve:
    return curve(INFLUENCE.measure(INFLUENCE.settings[name], 0, FULL)["change"])


def test_the_change_at_the_sample_itself_is_one():
    for name in INFLUENCE.settings:
        change = changes(name)
        assert np.interp(HERE, change.at, change.value) == pytest.approx(1.0, abs=0.02), name


def test_albus_shares_out_by_the_cells_in_common():
    change = changes("albus")
    np.testing.assert_allclose(8.0 * change.value, np.round(8.0 * change.value), atol=1e-9)
    assert np.abs(change.value[np.abs(change.at - HERE) > 0.5]).max() == 0.0


def test_sigma_pi_changes_along_its_products():
    change = changes("sigma-pi")
    expected = sum(HERE**k * change.at**k for k in range(6)) / sum(
        HERE ** (2 * k) for k in range(6)
    )
    np.testing.assert_allclose(change.value, expected, rtol=1e-9)


def test_layers_change_everywhere_and_gaussians_nearby():
    assert np.abs(changes("layered").value).min() > 0.3
    far = np.abs(changes("virtual").at - HERE) > 0.75
    assert np.abs(changes("virtual").value[far]).max() < 1e-3
    assert np.trapezoid(changes("virtual").value) < np.trapezoid(changes("cmac-rule").value)
