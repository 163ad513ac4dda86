"""Albus's CMAC: eq A.19, overlapping fields, hashing and memory."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from safetensors.numpy import load_file, save_file

from handeye.errors import FileFormatError, InvalidInput
from handeye.networks import InputSpace
from handeye.networks.memories import AlbusCMAC

points = st.tuples(*[st.floats(-3.0, 3.0)] * 2)


def cells_by_hand(cmac, x):
    """The cells that an input activates, as tuples (layer, tile, ...), from the boxes themselves.

    Layer l is a grid of boxes of side `field` whose corner lies l displacement_i quanta below 0.
    """
    quantum = cmac.field / cmac.layers
    found = []
    for layer in range(cmac.layers):
        corner = [-((layer * step) % cmac.layers) * quantum for step in cmac.displacements]
        tiles = np.floor((np.asarray(x) / cmac.inputs.scales - corner) / cmac.field + 1e-9)
        found.append((layer, *tiles.astype(int).tolist()))
    return found


class AlbusByHand:
    """Eq A.19 with a dictionary for a table: no hashing, no collisions."""

    def __init__(self, cmac):
        self.cmac, self.table = cmac, {}

    def predict(self, x):
        none = np.zeros(self.cmac.n_outputs)
        return sum((self.table.get(c, none) for c in cells_by_hand(self.cmac, x)), none)

    def learn(self, x, target):
        error = target - self.predict(x)
        for cell in cells_by_hand(self.cmac, x):
            old = self.table.get(cell, np.zeros(self.cmac.n_outputs))
            self.table[cell] = old + self.cmac.rate * error / self.cmac.layers
        return error


@pytest.mark.parametrize("displacements", [None, (1, 3), (0, 2), (9, 5)])
def test_learning_equals_eq_a_19_with_a_dictionary_for_a_table(displacements):
    space = InputSpace(*np.array([[-1.0, -1.0], [1.0, 1.0], [1.0, 2.0]]))
    cmac = AlbusCMAC(
        2, 3, inputs=space, field=0.7, layers=8, slots=8 * 100_003, rate=0.3,
        displacements=displacements,
    )  # fmt: skip
    by_hand, rng = AlbusByHand(cmac), np.random.default_rng(0)
    # Off the edges of quanta, where rounding would decide.
    x = (rng.integers(-20, 20, (300, 2)) + rng.uniform(0.1, 0.9, (300, 2))) * 0.7 / 8 * [1.0, 2.0]
    targets = rng.normal(size=(300, 3))
    errors = cmac.learn_many(x, targets).error
    expected = [by_hand.learn(x_i, target) for x_i, target in zip(x, targets, strict=True)]
    np.testing.assert_allclose(errors, expected, rtol=1e-12, atol=1e-14)
    elsewhere = x + 0.7 / 8 * 3.0 * np.array([1.0, -2.0])
    np.testing.assert_allclose(
        cmac.predict_many(elsewhere), [by_hand.predict(x_i) for x_i in elsewhere], atol=1e-13
    )
    assert cmac.collisions == 0
    assert cmac.n_cells == len(by_hand.table)


@given(x=points, rate=st.floats(0.01, 1.0), layers=st.integers(1, 9))
def test_one_sample_moves_the_output_by_the_rate_times_the_error(x, rate, layers):
    cmac = AlbusCMAC(2, 1, layers=layers, slots=layers, rate=rate)
    cmac.learn([0.1, 0.2], [5.0])
    error = cmac.learn(x, [-2.0]).error
    np.testing.assert_allclose(cmac.predict(x), -2.0 - (1.0 - rate) * error, atol=1e-12)


@given(x=points, steps=st.tuples(st.integers(-12, 12), st.integers(-12, 12)))
def test_what_is_learned_is_shared_by_the_cells_in_common_and_reaches_no_farther(x, steps):
    cmac = AlbusCMAC(2, 1, field=1.0, layers=8, slots=8 * 100_003, rate=1.0)
    quantum = cmac.field / cmac.layers
    here = (np.floor(np.asarray(x) / quantum) + 0.5) * quantum
    there = here + quantum * np.array(steps)
    cmac.learn(here, [8.0])
    common = len(set(cells_by_hand(cmac, here)) & set(cells_by_hand(cmac, there)))
    np.testing.assert_allclose(cmac.predict(there), [common], atol=1e-12)
    if max(map(abs, steps)) >= cmac.layers:
        assert common == 0
    if steps[1] == 0:  # along one input every quantum costs one cell
        assert common == max(0, 8 - abs(steps[0]))


def test_the_output_is_constant_within_a_quantum_and_not_beyond():
    cmac = AlbusCMAC(1, 1, field=0.8, layers=4, rate=1.0)
    cmac.learn([0.3], [4.0])
    across = cmac.predict_many(np.linspace(0.201, 0.399, 9)[:, np.newaxis])
    np.testing.assert_allclose(across, 4.0)
    np.testing.assert_allclose(cmac.predict_many([[0.199], [0.401]]), 3.0)


def test_a_displacement_by_whole_fields_more_is_the_same_however_far():
    x = np.random.default_rng(3).uniform(-3.0, 3.0, (40, 2))
    near, far = (
        AlbusCMAC(2, 1, layers=5, slots=500, displacements=(1, 3 + 5 * fields))
        for fields in (0, 10**18)
    )
    for cmac in (near, far):
        cmac.learn_many(x, x[:, :1])
    np.testing.assert_array_equal(far.weights, near.weights)


def test_collisions_are_counted_and_only_they_are():
    roomy, tight = (AlbusCMAC(2, 1, layers=4, slots=slots) for slots in (4 * 100_003, 8))
    x = np.random.default_rng(1).uniform(-5.0, 5.0, (200, 2))
    for cmac in (roomy, tight):
        cmac.learn_many(x, np.ones((200, 1)))
    assert roomy.collisions == 0
    assert roomy.n_cells == len({c for x_i in x for c in cells_by_hand(roomy, x_i)})
    assert tight.n_cells == 8
    # Each slot belongs to its first cell; every other activation is a collision.
    owners, expected, known = {}, 0, AlbusCMAC(2, 1, layers=4, slots=8)
    for x_i in x:
        before = known.weights[:, 0].copy()
        known.learn(x_i, known.predict(x_i) + 1.0)
        slots = np.flatnonzero(known.weights[:, 0] != before)
        for slot, cell in zip(slots, cells_by_hand(known, x_i), strict=True):
            expected += owners.setdefault(slot, cell) != cell
    assert tight.collisions == known.collisions == expected > 500


def test_hashing_spreads_cells_evenly_over_the_table():
    cmac = AlbusCMAC(3, 1, field=1.0, layers=2, slots=2 * 4096, displacements=(1, 1, 1))
    grid = np.stack(np.meshgrid(*[np.arange(16.0) + 0.25] * 3), axis=-1).reshape(-1, 3)
    cmac.learn_many(grid, np.ones((4096, 1)))
    # As many cells as slots in each layer: random places would leave a share of exp(-1) empty.
    assert cmac.n_cells / cmac.slots > 1.0 - np.exp(-1.0) - 0.02


def test_memory_is_bounded_however_many_inputs_come():
    cmac = AlbusCMAC(5, 2, layers=8, slots=800)
    before = cmac.n_bytes
    rng = np.random.default_rng(2)
    cmac.learn_many(rng.uniform(-1e3, 1e3, (5000, 5)), rng.normal(size=(5000, 2)))
    assert cmac.n_bytes == before == 800 * (2 + 1) * 8
    assert cmac.n_cells == 800
    assert np.abs(cmac.weights).max() < 10.0


def test_a_cell_is_allocated_once():
    cmac = AlbusCMAC(1, 1, field=1.0, layers=2, slots=2 * 1009)
    learned = cmac.learn_many([[0.1], [0.2], [0.6], [9.0]], np.ones((4, 1)))
    # 0.6 lies in the first layer's known cell, but not in the second's.
    assert learned.allocated.tolist() == [True, False, True, True]
    assert cmac.n_cells == 5


def test_a_smooth_mapping_is_learned_to_the_size_of_a_quantum():
    cmac = AlbusCMAC(1, 1, field=0.4, layers=32, slots=32 * 101, rate=0.5)
    rng = np.random.default_rng(3)
    x = rng.uniform(-1.0, 1.0, (5000, 1))
    cmac.learn_many(x, np.sin(3.0 * x))
    fresh = rng.uniform(-1.0, 1.0, (500, 1))
    assert np.abs(cmac.predict_many(fresh) - np.sin(3.0 * fresh)).max() < 0.4 / 32 * 3.0


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"rate": 0.0}, "rate"),
        ({"rate": 1.01}, "rate must be at most 1"),
        ({"layers": 0}, "layers"),
        ({"slots": 100}, "multiple of the 16 layers"),
        ({"field": 0.0}, "field"),
        ({"field": np.nan}, "field"),
        ({"displacements": (1,)}, "2 numbers"),
        ({"displacements": (1, -1)}, "a displacement"),
        ({"inputs": InputSpace.scaled(np.ones(3))}, "3 inputs"),
    ],
)
def test_settings_out_of_range_are_refused(settings, says):
    with pytest.raises(InvalidInput, match=says):
        AlbusCMAC(2, 1, **settings)


def test_inputs_beyond_all_quanta_are_refused():
    with pytest.raises(InvalidInput, match="too many fields away"):
        AlbusCMAC(2, 1).predict([1e20, 0.0])


def test_a_file_whose_parts_do_not_fit_is_refused(tmp_path):
    path = tmp_path / "cmac"
    AlbusCMAC(2, 1, layers=2, slots=8).save(path)
    parts = load_file(path)
    assert parts["weights"].shape == (8, 1)
    save_file(parts | {"weights": parts["weights"][:4]}, path)
    with pytest.raises(FileFormatError):
        AlbusCMAC.load(path)
