"""What the planar models hand to a network, as figure 3.5 and section 3.5.9 say."""

from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.cases import sightings

from handeye.calibration.models import PlanarMap, PlanarModel
from handeye.thesis.plants import NOMINAL, NORMAL


@pytest.fixture
def seen():
    return sightings()


def nominal_angles(seen):
    """Eq 3.11 to 3.17 with the nominal parameters, tip and angles as complex numbers."""
    tip = seen.range * np.exp(1j * (seen.pointing + seen.eccentricity)) - 1.0
    elbow = np.where(seen.joints[:, 1] >= 0.0, 1.0, -1.0)
    half = np.arccos(np.clip(np.abs(tip) / 2.0, -1.0, 1.0))  # a = b = 1: an isosceles triangle
    return np.angle(tip * np.exp(-1j * elbow * half)), elbow * 2.0 * half


def test_inputs_are_nominal_angles_and_what_the_eye_measured(seen):
    alpha, beta = nominal_angles(seen)
    measured = [alpha, beta, seen.pointing, seen.range, seen.eccentricity]
    model = PlanarModel(NOMINAL)
    np.testing.assert_allclose(model.features(seen), np.transpose(measured), atol=1e-9)
    without = replace(model, foveate=True).features(seen)
    np.testing.assert_allclose(without, np.transpose(measured[:4]), atol=1e-9)


def test_the_correction_is_measured_minus_nominal_on_the_circle(seen):
    difference = np.exp(1j * (seen.joints - np.transpose(nominal_angles(seen))))
    needed = PlanarModel(NOMINAL).needed(seen)
    np.testing.assert_allclose(needed, np.angle(difference), atol=1e-9)
    # Note E2: a joint that reads 3.1 where -3.1 was expected is off by 0.08, not by 6.2.
    assert np.abs(needed).max() < 1.0
    turned = replace(seen, joints=seen.joints + np.array([2.0 * np.pi, 0.0]))
    np.testing.assert_allclose(PlanarModel(NOMINAL).needed(turned), needed, atol=1e-12)


def test_errors_are_displacements_of_the_nominal_hand(seen):
    errors = np.random.default_rng(0).normal(scale=0.05, size=(len(seen), 2))
    (alpha, beta), (e_alpha, e_beta) = seen.joints.T, errors.T

    def tip(first, second):
        return np.exp(1j * first) + np.exp(1j * (first + second))

    moved = tip(alpha, beta) - tip(alpha - e_alpha, beta - e_beta)
    for model in (PlanarModel(NOMINAL), PlanarMap(NOMINAL)):
        found = model.displacement(seen, errors)
        np.testing.assert_allclose(found, np.transpose([moved.real, moved.imag]), atol=1e-14)


def test_the_whole_map_is_learned_from_the_sighting_and_the_elbow(seen):
    model = PlanarMap(NOMINAL)
    elbow = np.sign(seen.joints[:, 1])
    expected = np.transpose([seen.range, seen.pointing, seen.eccentricity, elbow])
    np.testing.assert_array_equal(model.features(seen), expected)
    np.testing.assert_array_equal(model.needed(seen), seen.joints)
    np.testing.assert_array_equal(
        model.command(seen.target, lambda x: 2.0 * x[:, :2]), 2.0 * expected[:, :2]
    )


def test_inputs_keep_to_the_box():
    # Joints within their travel, pointing on the circle, range as far as arm and eye allow.
    for model in (PlanarModel(NOMINAL), PlanarModel(NOMINAL, foveate=True), PlanarMap(NOMINAL)):
        space = model.space
        np.testing.assert_array_equal(space.scales, 1.0)
        room = 0.1 * (space.high - space.low)
        inputs = model.features(sightings(NORMAL, n=500))
        assert np.all(inputs > space.low - room)
        assert np.all(inputs < space.high + room)
    np.testing.assert_allclose(
        PlanarModel(NOMINAL).space.high, [0.8 * np.pi, 0.8 * np.pi, np.pi, 3.0, np.pi / 6]
    )
    np.testing.assert_allclose(
        PlanarModel(NOMINAL).space.low, [-0.8 * np.pi, -0.8 * np.pi, -np.pi, 0.0, -np.pi / 6]
    )
    np.testing.assert_allclose(PlanarMap(NOMINAL).space.high, [3.0, np.pi, np.pi / 6, 1.0])
    np.testing.assert_allclose(PlanarMap(NOMINAL).space.low, [0.0, -np.pi, -np.pi / 6, -1.0])
