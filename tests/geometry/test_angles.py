"""Angles on the circle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.geometry.angles import wrap


@given(st.floats(-1e3, 1e3))
def test_wrapped_is_the_same_direction_in_the_half_open_circle(angle):
    wrapped = float(wrap(np.array(angle)))
    assert -np.pi < wrapped <= np.pi
    np.testing.assert_allclose(np.exp(1j * wrapped), np.exp(1j * angle), atol=1e-12)


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [(0.0, 0.0), (np.pi, np.pi), (-np.pi, np.pi), (3 * np.pi, np.pi), (1.5 * np.pi, -0.5 * np.pi)],
)
def test_the_half_turn_is_positive(angle, wrapped):
    np.testing.assert_allclose(wrap(np.array([angle])), [wrapped], atol=1e-15)
