import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.catching.comparator import Comparator
from handeye.errors import InvalidInput


@given(st.lists(st.one_of(st.floats(0.0, 9.0), st.just(np.nan)), min_size=10, max_size=10))
def test_surprise_is_the_root_mean_square_of_what_could_be_compared(discrepancies):
    comparator = Comparator((1.0,), fewest=3)
    found = comparator.surprise(np.array(discrepancies)[:, np.newaxis])[0]
    compared = [d for d in discrepancies if not np.isnan(d)]
    if len(compared) < 3:
        assert np.isnan(found)
    else:
        assert found == pytest.approx(np.sqrt(sum(d * d for d in compared) / len(compared)))


def test_discrepancy_weighs_channels_by_their_thresholds():
    comparator = Comparator((0.1, 2.0))
    predicted, observed = np.array([[1.0, 5.0]]), np.array([[1.3, 1.0]])
    expected = np.sqrt(((0.3 / 0.1) ** 2 + (4.0 / 2.0) ** 2) / 2.0)
    np.testing.assert_allclose(comparator.discrepancy(predicted, observed), [expected])


def test_missing_by_the_thresholds_is_a_surprise_of_one():
    comparator = Comparator((0.01, 0.2), window=4)
    missed = comparator.discrepancy(np.array([[0.01, -0.2]]), np.zeros((1, 2)))
    np.testing.assert_allclose(comparator.surprise(np.tile(missed, (4, 1))), [1.0])


def test_no_prediction_is_no_discrepancy():
    comparator = Comparator((1.0,))
    assert np.isnan(comparator.discrepancy(np.array([[np.nan]]), np.array([[1.0]])))


@pytest.mark.parametrize("bad", [{"thresholds": (0.0,)}, {"window": 2}, {"fewest": 0}])
def test_bad_comparators_are_refused(bad):
    with pytest.raises(InvalidInput):
        Comparator(**({"thresholds": (1.0,)} | bad))
