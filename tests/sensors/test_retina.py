"""The eye that watches balls."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.sensors.retina import Retina

EYE = Retina(center_x=1.0, center_z=0.5, width=2.0)
numbers = st.floats(-5.0, 5.0).map(lambda value: round(value, 3))


@given(numbers, numbers, numbers, numbers)
def test_sees_exactly_what_is_in_the_square_field(x, z, vx, vz):
    state = [np.array([value]) for value in (x, z, vx, vz)]
    seen = EYE.sight(*state)
    if 0.0 <= x <= 2.0 and -0.5 <= z <= 1.5:
        np.testing.assert_array_equal(seen, state)
    else:
        assert np.isnan(seen).all()


def test_each_object_is_seen_or_not_by_itself():
    x = np.array([0.5, 2.5, 1.0])
    seen = EYE.sight(x, x * 0.0, x + 1.0, x + 2.0)
    for field in seen:
        np.testing.assert_array_equal(np.isnan(field), [False, True, False])
    np.testing.assert_array_equal(seen[2][[0, 2]], [1.5, 2.0])


@pytest.mark.parametrize("bad", [{"width": 0.0}, {"center_x": np.nan}, {"center_z": np.inf}])
def test_refuses_an_eye_that_cannot_be(bad):
    with pytest.raises(InvalidInput, match=next(iter(bad))):
        Retina(**{"center_x": 0.0, "center_z": 0.0, "width": 1.0, **bad})
