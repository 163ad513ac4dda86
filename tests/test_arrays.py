"""What enters a public function is checked once, and refused with the reason."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from handeye import errors
from handeye.arrays import count, finite, scalar, shaped
from handeye.errors import InvalidInput


@given(hnp.arrays(np.float64, hnp.array_shapes(min_dims=0, max_dims=3, min_side=0)))
def test_finite_keeps_what_is_finite_and_names_the_first_that_is_not(values):
    bad = np.argwhere(~np.isfinite(values))
    if not len(bad):
        kept = finite(values, "values")
        assert kept.dtype == np.float64
        assert kept.shape == values.shape
        assert kept.flags.c_contiguous
        np.testing.assert_array_equal(kept, values)
        return
    where = f" at index {tuple(bad[0].tolist())}" if values.ndim else ""
    with pytest.raises(InvalidInput) as caught:
        finite(values, "values")
    assert str(caught.value) == f"values must be finite, got {values[tuple(bad[0])]}{where}"


@pytest.mark.parametrize("kind", [np.int8, np.uint16, np.float32, np.bool_])
def test_real_numbers_of_every_kind_become_doubles(kind):
    kept = finite(np.array([0, 1, 1], kind), "x")
    assert kept.dtype == np.float64
    np.testing.assert_array_equal(kept, [0.0, 1.0, 1.0])


def test_a_single_number_keeps_having_no_axes():
    assert finite(2, "x").shape == ()


@pytest.mark.parametrize("value", ["1.0", ["a"], [None, 1.0], 1j, {"a": 1}, [[1.0], None]])
def test_what_is_no_real_number_is_refused(value):
    with pytest.raises(InvalidInput, match=r"x (must be real numbers|is ragged)"):
        finite(value, "x")


def test_ragged_rows_are_named_as_such():
    with pytest.raises(InvalidInput, match="x is ragged: every row needs the same length"):
        finite([[1.0], [1.0, 2.0]], "x")


@pytest.mark.parametrize(
    ("value", "shape", "fits"),
    [
        (np.zeros((4, 3)), (None, 3), True),
        (np.zeros((0, 3)), (None, 3), True),
        (np.zeros((4, 2)), (None, 3), False),
        (np.zeros(3), (None, 3), False),
        (np.zeros((1, 4, 3)), (None, 3), False),
        (1.0, (), True),
        ([1.0], (), False),
    ],
)
def test_shape(value, shape, fits):
    if fits:
        assert shaped(value, shape, "x").shape == np.shape(value)
    else:
        wanted = ", ".join("N" if n is None else str(n) for n in shape)
        with pytest.raises(InvalidInput) as caught:
            shaped(value, shape, "x")
        assert str(caught.value) == f"x must have shape ({wanted}), got {np.shape(value)}"


def test_bounds_of_a_scalar_are_open_and_closed():
    assert scalar(1, "x", above=0.0, least=1.0) == 1.0
    assert isinstance(scalar(1, "x"), float)
    with pytest.raises(InvalidInput, match=r"x must be greater than 1\.0, got 1\.0"):
        scalar(1.0, "x", above=1.0)
    with pytest.raises(InvalidInput, match=r"x must be at least 1\.0, got 0\.5"):
        scalar(0.5, "x", least=1.0)
    with pytest.raises(InvalidInput, match="x must be finite"):
        scalar(np.nan, "x", least=1.0)


@pytest.mark.parametrize("value", [1.0, "3", True, None, 0, -2, np.float64(3)])
def test_counts_are_whole_numbers_from_their_least_on(value):
    with pytest.raises(InvalidInput, match="n must be a whole number of at least 1"):
        count(value, "n")


def test_counts_of_numpy_are_counts():
    assert count(np.int32(3), "n") == 3
    assert count(0, "n", least=0) == 0


@given(st.sampled_from([errors.InvalidInput, errors.LogError, errors.FileFormatError]))
def test_every_error_on_purpose_can_be_caught_as_one(kind):
    assert issubclass(kind, errors.HandeyeError)


def test_refused_input_is_a_value_error_and_a_missing_extra_an_import_error():
    assert issubclass(errors.InvalidInput, ValueError)
    missing = errors.MissingExtra("a Parquet file", "parquet")
    assert isinstance(missing, ImportError)
    assert isinstance(missing, errors.HandeyeError)
    assert str(missing).endswith("pip install 'handeye[parquet]'")
