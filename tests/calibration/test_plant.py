"""The planar robot as a whole: eq 3.1 to 3.12, and each source of error on its own switch."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.calibration.plant import PlanarPlant
from handeye.observations import StereoTarget
from handeye.robots.encoder import AxisEncoder
from handeye.robots.planar import TwoLinkArm
from handeye.sensors.stereo import StereoHead
from handeye.thesis.plants import LARGE, NOMINAL, NORMAL

seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)
PLANTS = pytest.mark.parametrize(
    "plant", [NOMINAL, NORMAL, LARGE], ids=["nominal", "normal", "large"]
)


def random_poses(rng, n=20):
    beta = rng.uniform(0.1 * np.pi, 0.8 * np.pi, n) * rng.choice([-1.0, 1.0], n)
    joints = np.stack([rng.uniform(-0.8 * np.pi, 0.8 * np.pi, n), beta], axis=-1)
    return joints, rng.uniform(-np.pi / 6, np.pi / 6, n), rng.standard_normal((n, 2))


def oracle_tips(plant, joints):
    """Eq 3.1, 3.2, 3.6, 3.7, 3.35, 3.36 as the thesis writes them."""
    xi, kappa = plant.alpha.amplitude, plant.beta.amplitude
    alpha = joints[:, 0] + plant.alpha.offset + xi * joints[:, 0] * np.sin(joints[:, 0] + 2.0)
    beta = joints[:, 1] + plant.beta.offset + kappa * joints[:, 1] * np.sin(joints[:, 1] - 1.0)
    t = plant.arm.a * np.exp(1j * alpha) + plant.arm.b * np.exp(1j * (alpha + beta))
    return np.stack([t.real, t.imag], axis=-1)


@PLANTS
@given(rng=seeds)
def test_the_hand_is_where_eq_3_1_to_3_7_say(plant, rng):
    joints, _, _ = random_poses(rng)
    np.testing.assert_allclose(plant.tips(joints), oracle_tips(plant, joints), atol=1e-14)


@PLANTS
@given(rng=seeds)
def test_a_sighting_equals_eq_3_3_to_3_5(plant, rng):
    joints, eccentricity, noise = random_poses(rng)
    tips = plant.tips(joints)
    pointing, r_measured, eccentricity_measured = plant.sight(tips, eccentricity, noise)
    r = tips - [plant.v_x, plant.v_y]  # eq 3.8, 3.9
    gamma = np.angle((r[:, 0] + 1j * r[:, 1]) * np.exp(-1j * eccentricity))  # eq 3.10
    bend = plant.gamma.amplitude * gamma * np.sin(3.0 * gamma + 0.7)
    np.testing.assert_allclose(pointing, gamma - plant.gamma.offset + bend, atol=1e-12)
    expected = plant.head.measure(np.hypot(r[:, 0], r[:, 1]), eccentricity, noise)
    np.testing.assert_allclose([r_measured, eccentricity_measured], expected, atol=1e-14)


@PLANTS
@given(rng=seeds)
def test_a_plant_without_perturbations_and_noise_inverts_itself(plant, rng):
    """Eq 3.11, 3.12 undo 3.8 to 3.10, and eq 3.13 to 3.17 undo 3.6, 3.7."""
    plain = plant.without_noise().without_perturbations().with_range_scale(0.9)
    joints, eccentricity, noise = random_poses(rng)
    tips = plain.tips(joints)
    pointing, r, measured = plain.sight(tips, eccentricity, noise)
    sighting = StereoTarget(pointing, r, measured, np.sign(joints[:, 1]))
    np.testing.assert_allclose(plain.locate(sighting), tips, atol=1e-13)
    np.testing.assert_allclose(plain.joints_for(sighting), joints, atol=1e-6)


def test_locating_equals_eq_3_11_and_3_12():
    target = StereoTarget(np.array(0.4), np.array(1.8), np.array(-0.1), np.array(1.0))
    theta = 0.4 + NORMAL.gamma.offset - 0.1
    expected = 1.8 / 0.9 * np.array([np.cos(theta), np.sin(theta)]) + [-1.01, -0.02]
    np.testing.assert_allclose(NORMAL.with_range_scale(0.9).locate(target), expected, atol=1e-15)


def perturbed_parts():
    """Every source of error alone: a plant, and the quantity it is allowed to change."""
    nominal = NOMINAL.without_noise()
    changes = {
        "a": {"arm": TwoLinkArm(1.005, 1.0)},
        "b": {"arm": TwoLinkArm(1.0, 1.003)},
        "v_x": {"v_x": -1.01},
        "v_y": {"v_y": -0.02},
        "alpha offset": {"alpha": AxisEncoder(0.01)},
        "beta offset": {"beta": AxisEncoder(0.018)},
        "gamma offset": {"gamma": AxisEncoder(0.035)},
        "delta alpha": {"alpha": NORMAL.alpha},
        "delta beta": {"beta": replace(NORMAL.beta, offset=0.0)},
        "delta gamma": {"gamma": replace(NORMAL.gamma, offset=0.0)},
        "delta eccentricity": {"head": StereoHead(0.0, eccentricity_warp=0.015)},
        "delta r": {"head": StereoHead(0.0, range_warp=0.005)},
        "range scale": {"head": StereoHead(0.0, range_scale=0.9)},
        "noise": {"head": StereoHead()},
    }
    return {name: replace(nominal, **change) for name, change in changes.items()}


HAND = {"a", "b", "alpha offset", "beta offset", "delta alpha", "delta beta"}
POINTING = {"v_x", "v_y", "gamma offset", "delta gamma"}
MEASURES = {
    "v_x": {"r"}, "v_y": {"r"}, "delta eccentricity": {"eccentricity"}, "delta r": {"r"},
    "range scale": {"r"}, "noise": {"r", "eccentricity"},
}  # fmt: skip


@pytest.mark.parametrize("name", perturbed_parts())
def test_each_error_source_acts_alone_and_each_switch_removes_it(name):
    plant, nominal = perturbed_parts()[name], NOMINAL.without_noise()
    joints, eccentricity, noise = random_poses(np.random.default_rng(1))
    moved = not np.array_equal(plant.tips(joints), nominal.tips(joints))
    assert moved == (name in HAND)
    # The same point seen by both, so that only the eye's own errors remain.
    point = nominal.tips(joints)
    seen = dict(
        zip(("pointing", "r", "eccentricity"), plant.sight(point, eccentricity, noise), strict=True)
    )
    right = nominal.sight(point, eccentricity, noise)
    changed = {
        key for key, value in zip(seen, right, strict=True) if not np.array_equal(seen[key], value)
    }
    assert changed == ({"pointing"} if name in POINTING else set()) | MEASURES.get(name, set())
    cleaned = plant
    if name == "noise":
        cleaned = plant.without_noise()
    elif name == "range scale":
        cleaned = plant.with_range_scale(1.0)
    elif name.startswith("delta"):
        cleaned = plant.without_perturbations()
    else:
        assert plant.without_noise().without_perturbations() == plant
        return
    assert cleaned == nominal


@PLANTS
def test_switches_leave_everything_else(plant):
    quiet = plant.without_noise()
    assert replace(quiet, head=plant.head) == plant
    assert replace(quiet.head, pixel_pitch=plant.head.pixel_pitch) == plant.head
    linear = plant.without_perturbations()
    assert (linear.arm, linear.v_x, linear.v_y) == (plant.arm, plant.v_x, plant.v_y)
    for axis in ("alpha", "beta", "gamma"):
        assert getattr(linear, axis) == AxisEncoder(getattr(plant, axis).offset)
    assert linear.head.pixel_pitch == plant.head.pixel_pitch
    assert plant.with_range_scale(0.5).with_range_scale(1.0) == plant


def test_parameters_may_differ_from_trial_to_trial():
    rng, n = np.random.default_rng(3), 7
    columns = {
        name: rng.uniform(low, high, n)
        for name, (low, high) in {
            "a": (0.9, 1.1), "b": (0.9, 1.1), "v_x": (-1.1, -0.9), "v_y": (-0.1, 0.1),
            "alpha": (-0.1, 0.1), "beta": (-0.1, 0.1), "gamma": (-0.1, 0.1), "scale": (0.9, 1.1),
        }.items()
    }  # fmt: skip

    def plant(a, b, v_x, v_y, alpha, beta, gamma, scale) -> PlanarPlant:
        return PlanarPlant(
            TwoLinkArm(a, b),
            v_x,
            v_y,
            replace(NORMAL.alpha, offset=alpha),
            replace(NORMAL.beta, offset=beta),
            replace(NORMAL.gamma, offset=gamma),
            replace(NORMAL.head, range_scale=scale),
        )

    many = plant(**columns)
    joints, eccentricity, noise = random_poses(rng, n)
    tips = many.tips(joints)
    sighting = StereoTarget(*many.sight(tips, eccentricity, noise), np.sign(joints[:, 1]))
    commands, places = many.joints_for(sighting), many.locate(sighting)
    for i in range(n):
        one = plant(**{name: float(column[i]) for name, column in columns.items()})
        np.testing.assert_array_equal(one.tips(joints[i]), tips[i])
        seen = StereoTarget(*one.sight(tips[i], eccentricity[i], noise[i]), sighting.elbow[i])
        for name in ("pointing", "range", "eccentricity"):
            np.testing.assert_array_equal(getattr(seen, name), getattr(sighting, name)[i])
        np.testing.assert_array_equal(one.locate(seen), places[i])
        np.testing.assert_array_equal(one.joints_for(seen), commands[i])
