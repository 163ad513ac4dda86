"""The Hopfield memory: its energy, its fixed points, its capacity."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from safetensors.numpy import save_file

from handeye.errors import FileFormatError, InvalidInput
from handeye.networks.memories import HopfieldMemory
from handeye.networks.memories import hopfield as module


def signs(rng, *shape):
    return rng.choice([-1.0, 1.0], shape)


def filled(seed, n, p):
    rng = np.random.default_rng(seed)
    memory, patterns = HopfieldMemory(n), signs(rng, p, n)
    memory.store(patterns)
    return memory, patterns, rng


def test_weights_are_the_sum_of_outer_products_without_a_diagonal():
    memory, patterns, _ = filled(0, 7, 3)
    memory.store(patterns[0])
    expected = np.sum([np.outer(p, p) for p in [*patterns, patterns[0]]], axis=0) / 7
    np.fill_diagonal(expected, 0.0)
    np.testing.assert_allclose(memory.weights, expected, rtol=1e-15)
    np.testing.assert_array_equal(memory.weights, memory.weights.T)
    assert memory.stored == 4


@given(seed=st.integers(0, 10**6), n=st.integers(1, 12), p=st.integers(0, 6))
def test_energy_never_rises_and_falls_by_twice_the_net_input_of_what_flips(seed, n, p):
    memory, _, rng = filled(seed, n, p)
    s = signs(rng, n)
    sums = memory.weights * n
    for i in rng.integers(0, n, 30):
        before, net = memory.energy(s), memory.weights[i] @ s
        old = s[i]
        flipped = module.update(np.round(sums), s, np.array([i]))
        assert s[i] == (old if abs(net) < 1e-12 else np.sign(net))
        assert memory.energy(s) == pytest.approx(before - 2.0 * abs(net) * flipped, abs=1e-12)
        assert memory.energy(s) <= before


def test_energy_is_its_formula():
    memory, _, rng = filled(1, 9, 4)
    s = signs(rng, 9)
    by_hand = -0.5 * sum(memory.weights[i, j] * s[i] * s[j] for i in range(9) for j in range(9))
    assert memory.energy(s) == pytest.approx(by_hand, rel=1e-13)


def test_stored_patterns_are_fixed_points_below_capacity():
    memory, patterns, rng = filled(2, 400, 12)
    for pattern in patterns:
        recalled = memory.recall(pattern, rng)
        np.testing.assert_array_equal(recalled.state, pattern)
        assert recalled.settled
        assert recalled.sweeps == 1


def test_complete_items_are_recalled_from_damaged_ones():
    memory, patterns, rng = filled(3, 400, 12)
    for pattern in patterns:
        damaged = np.where(rng.random(400) < 0.25, -pattern, pattern)
        np.testing.assert_array_equal(memory.recall(damaged, rng).state, pattern)


def test_a_pattern_and_its_negative_have_the_same_energy_and_both_rest():
    memory, (pattern,), rng = filled(4, 30, 1)
    assert memory.energy(pattern) == memory.energy(-pattern) == pytest.approx(-14.5)
    np.testing.assert_array_equal(memory.recall(-pattern, rng).state, -pattern)


def overlap(seed, n, load):
    """Mean overlap of stored patterns with where they come to rest."""
    memory, patterns, rng = filled(seed, n, round(load * n))
    rests = [memory.recall(p, rng, most_sweeps=500) for p in patterns[:8]]
    assert all(rest.settled for rest in rests)
    return np.mean([rest.state @ p / n for rest, p in zip(rests, patterns, strict=False)])


def test_capacity_is_about_0_14_patterns_per_neuron():
    # Amit, Gutfreund and Sompolinsky: an overlap of 0.97 at 0.138 n, and then a collapse.
    below, above = (np.mean([overlap(s, 1000, load) for s in (5, 6)]) for load in (0.125, 0.17))
    assert below > 0.96
    assert above < 0.75
    assert overlap(7, 1000, 0.25) < 0.5


def test_rest_is_a_fixed_point_and_unsettled_is_said():
    memory, _, rng = filled(8, 200, 60)
    start = signs(rng, 200)
    cut = memory.recall(start, rng, most_sweeps=1)
    assert not cut.settled
    assert cut.sweeps == 1
    rest = memory.recall(start, rng)
    assert rest.settled
    net = memory.weights @ rest.state
    assert np.all(net * rest.state > -1e-12)


def test_all_at_once_would_alternate_where_one_by_one_comes_to_rest():
    memory, start = HopfieldMemory(2), np.array([1.0, -1.0])
    memory.store([1.0, 1.0])
    synchronous = np.sign(memory.weights @ start)
    np.testing.assert_array_equal(synchronous, -start)
    np.testing.assert_array_equal(np.sign(memory.weights @ synchronous), start)
    rest = memory.recall(start, np.random.default_rng(0))
    assert rest.settled
    assert abs(rest.state.sum()) == 2.0


def test_an_empty_memory_leaves_every_state_alone():
    memory, rng = HopfieldMemory(5), np.random.default_rng(0)
    state = signs(rng, 5)
    np.testing.assert_array_equal(memory.recall(state, rng).state, state)
    assert memory.energy(state) == 0.0


def test_the_generator_decides_and_the_argument_stays():
    memory, _, rng = filled(9, 100, 30)
    state = signs(rng, 100)
    kept = state.copy()
    one, same = (memory.recall(state, np.random.default_rng(1)) for _ in range(2))
    np.testing.assert_array_equal(one.state, same.state)
    np.testing.assert_array_equal(state, kept)


@pytest.mark.parametrize(
    "bad", [[1.0, 0.0, 1.0], [1.0, -1.0], [1.0, np.nan, 1.0], [1.0, 2.0, 1.0], "101", [True] * 2]
)
def test_what_is_no_pattern_is_refused_and_nothing_is_lost(bad):
    memory = HopfieldMemory(3)
    memory.store([[1, -1, 1]])
    before = memory.weights
    for call in (
        memory.store, memory.energy, lambda s: memory.recall(s, np.random.default_rng(0)),
        lambda s: memory.store([[1, 1, 1], s]),
    ):  # fmt: skip
        with pytest.raises(InvalidInput):
            call(bad)
    np.testing.assert_array_equal(memory.weights, before)
    assert memory.stored == 1


def test_it_is_stored_and_copied(tmp_path):
    memory, patterns, _ = filled(10, 20, 2)
    memory.save(tmp_path / "memory")
    again, copy = HopfieldMemory.load(tmp_path / "memory"), memory.copy()
    memory.store(patterns[0])
    for other in (again, copy):
        assert repr(other) == "HopfieldMemory(20 neurons, 2 patterns)"
        np.testing.assert_array_equal(other.weights, filled(10, 20, 2)[0].weights)
    save_file({"sums": np.zeros((2, 3))}, tmp_path / "other")
    with pytest.raises(FileFormatError, match="not a stored"):
        HopfieldMemory.load(tmp_path / "other")
    with pytest.raises(FileFormatError, match="no such file"):
        HopfieldMemory.load(tmp_path / "nowhere")
