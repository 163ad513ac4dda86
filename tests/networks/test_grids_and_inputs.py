"""Grids of section 3.5.2, and the input space that gives distances their unit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.networks import InputSpace, ResourceAllocatingNetwork, fixed_grid, variable_grid

SPACE = InputSpace(*np.array([[-1.0, 0.0, 2.0], [1.0, 10.0, 2.5], [1.0, 5.0, 0.25]]))


def box(d):
    return InputSpace(np.arange(d) - 0.5, 2.0 * np.arange(d) + 1.0, np.ones(d))


@given(st.integers(1, 4), st.integers(1, 5))
def test_fixed_grid_has_one_point_in_the_middle_of_every_cell(d, n):
    space = box(d)
    grid = fixed_grid(space, n)
    assert grid.shape == (n**d, d)
    cells = (grid - space.low) / (space.high - space.low) * n
    np.testing.assert_allclose(cells - np.floor(cells), 0.5, atol=1e-9)
    assert len(np.unique(np.floor(cells), axis=0)) == n**d
    assert (np.floor(cells) >= 0).all()
    assert (np.floor(cells) < n).all()


def test_the_last_input_of_a_grid_varies_fastest():
    grid = fixed_grid(InputSpace.box([0, 0], [4, 40]), 2)
    np.testing.assert_array_equal(grid, [[1, 10], [1, 30], [3, 10], [3, 30]])


@given(st.integers(1, 3), st.integers(1, 4))
def test_variable_grid_doubles_the_points_per_axis_from_coarse_to_fine(d, levels):
    space = box(d)
    grid = variable_grid(space, levels)
    start = 0
    for level in range(levels):
        count = 2 ** (level * d)
        part = grid[start : start + count]
        np.testing.assert_array_equal(part, fixed_grid(space, 2**level))
        for i in range(d):
            assert len(np.unique(part[:, i])) == 2**level
        start += count
    assert start == len(grid)
    assert (grid > space.low).all()
    assert (grid < space.high).all()


@pytest.mark.parametrize("bad", [0, -1, 2.0, True, "3"])
@pytest.mark.parametrize("grid", [fixed_grid, variable_grid])
def test_grids_refuse_what_is_no_count(grid, bad):
    with pytest.raises(InvalidInput):
        grid(SPACE, bad)


def test_a_network_on_a_grid_is_exact_where_it_was_placed_last():
    grid = variable_grid(SPACE, 2)
    network = ResourceAllocatingNetwork(3, 1, inputs=SPACE, capacity=len(grid))
    targets = grid[:, :1] * grid[:, 1:2]
    network.place(grid, targets)
    assert network.n_neurons == len(grid) == 9
    np.testing.assert_allclose(network.centers, grid, rtol=1e-12)
    np.testing.assert_allclose(network.predict(grid[-1]), targets[-1], rtol=1e-12)


def test_distances_are_in_scales():
    network = ResourceAllocatingNetwork(3, 1, inputs=SPACE)
    network.place([[0.0, 5.0, 2.0]])
    assert network.nearest([1.0, 5.0, 2.0]) == 1.0
    assert network.nearest([0.0, 10.0, 2.0]) == 1.0
    assert network.nearest([0.0, 5.0, 2.25]) == 1.0
    assert SPACE.diameter == pytest.approx(np.sqrt(2.0**2 + 2.0**2 + 2.0**2))
    assert SPACE.n_inputs == 3


def test_a_change_of_units_changes_nothing():
    rng = np.random.default_rng(0)
    x, y = rng.random((80, 2)), rng.normal(size=(80, 1))
    factor = np.array([1024.0, 1 / 64])  # powers of two: nothing is rounded
    space = np.array([[0, 0], [1, 1], [1, 0.5]])
    metres = ResourceAllocatingNetwork(2, 1, inputs=InputSpace(*space))
    others = ResourceAllocatingNetwork(2, 1, inputs=InputSpace(*(space * factor)))
    np.testing.assert_array_equal(
        metres.learn_many(x, y).error, others.learn_many(x * factor, y).error
    )
    np.testing.assert_array_equal(metres.widths, others.widths)


def test_ways_to_make_a_space():
    raw = InputSpace.box([-1, 0], [1, 5])
    np.testing.assert_array_equal(raw.scales, [1.0, 1.0])
    assert raw.diameter == pytest.approx(np.hypot(2, 5))
    unit = InputSpace.box([-1, 0], [1, 5], unit=True)
    np.testing.assert_array_equal(unit.scales, [2.0, 5.0])
    assert unit.diameter == pytest.approx(np.sqrt(2))
    scaled = InputSpace.scaled([2.0, 3.0])
    assert scaled.diameter == pytest.approx(np.sqrt(2))
    assert ResourceAllocatingNetwork(4, 1).inputs.diameter == pytest.approx(2.0)
    assert repr(unit) == "InputSpace(low=[-1.,  0.], high=[1., 5.], scales=[2., 5.])"


def test_a_space_keeps_its_own_arrays():
    low = np.zeros(2)
    space = InputSpace(low, np.ones(2), np.ones(2))
    low[:] = 7.0
    np.testing.assert_array_equal(space.low, [0.0, 0.0])
    with pytest.raises(ValueError, match="read-only"):
        space.scales[0] = 5.0


@pytest.mark.parametrize(
    "arguments",
    [
        ([0, 0], [1, 0], [1, 1]),
        ([0, 0], [1, -1], [1, 1]),
        ([0, 0], [1, 1], [1, 0]),
        ([0, 0], [1, 1], [1, -1]),
        ([0, 0], [1, 1], [1]),
        ([0, 0], [1], [1, 1]),
        ([0, np.nan], [1, 1], [1, 1]),
        ([0, 0], [np.inf, 1], [1, 1]),
        ([[0, 0]], [1, 1], [1, 1]),
        ([], [], []),
        ([[0], [0, 1]], [1, 1], [1, 1]),
        ("ab", [1, 1], [1, 1]),
        ([0], [1e-101], [1]),
        ([0], [1], [1e-101]),
        ([-1e308], [1e308], [1]),
    ],
)
def test_a_space_without_extent_is_refused(arguments):
    with pytest.raises(InvalidInput):
        InputSpace(*arguments)


@pytest.mark.parametrize(
    ("low", "high"), [([0, 0], [1, 1, 1]), ([0, 0], [1]), ([0], [[1]]), ([1], [0])]
)
def test_boxes_that_do_not_fit_are_refused(low, high):
    with pytest.raises(InvalidInput):
        InputSpace.box(low, high, unit=True)
