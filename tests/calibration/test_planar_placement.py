"""Where the eye of a planar robot stands."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.calibration.cases import sightings

from handeye.calibration.planar_placement import eye_points, place_eye
from handeye.errors import InvalidInput
from handeye.robots.encoder import AxisEncoder
from handeye.thesis.plants import NOMINAL, NORMAL


def frame(plant) -> Any:
    return [plant.v_x, plant.v_y, plant.gamma.offset]


@given(
    v_x=st.floats(-3.0, 3.0), v_y=st.floats(-3.0, 3.0), offset=st.floats(-3.1, 3.1),
    n=st.integers(3, 40), scale=st.floats(0.5, 1.5), replicate=st.integers(0, 99),
)  # fmt: skip
def test_an_exact_arm_without_noise_gives_the_frame_exactly(v_x, v_y, offset, n, scale, replicate):
    known = NOMINAL.without_noise().with_range_scale(scale)
    true = replace(known, v_x=v_x, v_y=v_y, gamma=AxisEncoder(offset))
    placed = place_eye(known, sightings(true, n=n, replicate=replicate))
    np.testing.assert_allclose(frame(placed), frame(true), atol=1e-7)
    assert replace(placed, v_x=known.v_x, v_y=known.v_y, gamma=known.gamma) == known


def test_what_is_known_of_the_arm_is_kept():
    known = replace(NORMAL.without_noise().without_perturbations(), v_x=5.0, v_y=5.0)
    true = replace(known, v_x=-1.01, v_y=-0.02)
    placed = place_eye(known, sightings(true, n=30))
    np.testing.assert_allclose(frame(placed), [-1.01, -0.02, 0.035], atol=1e-9)
    assert placed.arm == known.arm
    assert placed.beta == known.beta
    kept = place_eye(NORMAL, sightings(NORMAL, n=30)).gamma
    assert replace(kept, offset=0.0) == replace(NORMAL.gamma, offset=0.0)


def test_the_order_of_sightings_is_of_no_account():
    seen = sightings(n=200)
    order = np.random.default_rng(0).permutation(200)
    np.testing.assert_allclose(
        frame(place_eye(NOMINAL, seen[order])), frame(place_eye(NOMINAL, seen)), atol=1e-6
    )


@pytest.mark.parametrize("baseline", [0.5, 50.0], ids=["bearings decide", "ranges decide"])
def test_range_and_bearing_count_by_their_standard_deviations(baseline):
    # No estimate without bias is better than the inverse of the information (Cramer, Rao).
    plant = replace(NOMINAL, head=replace(NOMINAL.head, baseline=baseline))
    whitened = []
    for replicate in range(40):
        seen = sightings(plant, n=50, replicate=replicate)
        x, y = (plant.tips(seen.joints) - [-1.0, 0.0]).T
        r, one, zero = np.hypot(x, y), np.ones(50), np.zeros(50)
        # Derivatives of range and bearing by v_x, v_y and the offset.
        along = np.transpose([-x / r, -y / r, zero])
        across = np.transpose([y / r**2, -x / r**2, -one])
        stds = [
            plant.head.range_std(r, seen.eccentricity),
            plant.head.eccentricity_std(seen.eccentricity),
        ]
        rows = np.concatenate([along / stds[0][:, None], across / stds[1][:, None]])
        error = np.subtract(frame(place_eye(plant, seen)), [-1.0, 0.0, 0.0])
        whitened.append(np.linalg.cholesky(rows.T @ rows).T @ error)
    np.testing.assert_allclose(np.sqrt(np.mean(np.square(whitened))), 1.0, atol=0.15)


def test_gross_errors_hardly_matter():
    seen = sightings(NOMINAL, n=200)
    wrong = np.arange(200) % 20 == 0
    spoilt = replace(seen, eccentricity=seen.eccentricity + 0.5 * wrong)
    placed = place_eye(NOMINAL, spoilt)
    np.testing.assert_allclose(frame(placed), [-1.0, 0.0, 0.0], atol=5e-3)


def test_placing_the_eye_never_makes_the_thesis_robot_worse():
    seen = sightings(NORMAL, n=300)

    def error(plant):
        hand = plant.locate(seen.target) - plant.tips(seen.joints)
        return np.median(np.linalg.norm(hand, axis=1))

    assert error(place_eye(NOMINAL, seen)) < 0.5 * error(NOMINAL)


def test_points_are_seen_from_the_zero_of_the_pointing_encoder():
    seen = sightings(n=5)
    along = seen.range * np.exp(1j * (seen.pointing + seen.eccentricity))
    np.testing.assert_allclose(eye_points(seen), np.transpose([along.real, along.imag]))


def test_too_few_sightings_or_hands_on_a_line_are_refused():
    with pytest.raises(InvalidInput, match="at least 3"):
        place_eye(NOMINAL, sightings(n=2))
    seen = sightings(n=10)
    still = replace(seen, joints=np.tile(seen.joints[:1], (10, 1)))
    with pytest.raises(InvalidInput, match="on one line"):
        place_eye(NOMINAL, still)
