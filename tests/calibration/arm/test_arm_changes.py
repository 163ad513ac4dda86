"""Outliers and changes of an arm: told apart, attributed to a part, and learned at once."""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.arm.arms import errors_of, model, sightings, taught

from handeye.calibration.arm.kernels import joint_at
from handeye.geometry import matrix_from_wxyz

SLIP, MOVED = np.radians(0.2), 0.003 * np.array([0.48, -0.6, 0.64])


def seen_later(n, seed=0):
    placed = model()
    return sightings(placed, errors_of(placed, seed), n, 50)


def changes(combined):
    return [event for event in combined.events if event.kind in {"change", "lost"}]


def mean(errors):
    return float(np.linalg.norm(errors, axis=1).mean())


def test_every_part_that_may_change_is_told_from_the_others():
    """A slip of each encoder by 0.2 degrees, a sensor and a marker that are moved by 3 mm."""
    clean = seen_later(40)
    faulty = {}
    for j, name in enumerate(model().arm.joint_names):
        joints = clean.joints.copy()
        joints[:, j] -= SLIP
        faulty[f"encoder offset of joint {name}"] = replace(clean, joints=joints)
    faulty["base of the sensor"] = replace(clean, position=clean.position + MOVED)
    carried = matrix_from_wxyz(clean.orientation) @ MOVED
    faulty["marker on the flange"] = replace(clean, position=clean.position + carried)
    for part, seen in faulty.items():
        combined = deepcopy(taught())
        combined.observe_many(seen[:10])
        (change,) = changes(combined)
        assert change.part == part
        assert 120 <= change.observation <= 122
        if "offset" in part:
            assert abs(change.amount - SLIP) < 4.0 * change.std + 1e-5
            assert change.unit == "rad"
        assert mean(combined.errors(seen[10:])) < 2.5e-4
        assert part in combined.health()


def test_both_frames_together_are_one_change():
    """The arm is bolted down elsewhere and its marker is remounted."""
    clean = seen_later(40)
    carried = matrix_from_wxyz(clean.orientation) @ MOVED
    seen = replace(clean, position=clean.position + 2.0 * carried + 3.0 * MOVED)
    combined = deepcopy(taught())
    combined.observe_many(seen[:12])
    assert changes(combined)[-1].part == "base of the sensor and marker on the flange"
    assert mean(combined.errors(seen[12:])) < 3e-4


@pytest.mark.parametrize("share", [0.1, 0.2])
def test_wild_points_are_left_out_and_change_nothing(share):
    clean = seen_later(60)
    rng = np.random.default_rng(4)
    wild = rng.random(60) < share
    wild[0] = True
    position = clean.position.copy()
    position[wild] += rng.normal(scale=0.03, size=(int(wild.sum()), 3))
    combined, other = deepcopy(taught()), deepcopy(taught())
    combined.observe_many(replace(clean, position=position))
    other.observe_many(clean[~wild])
    left_out = [e.observation - 120 for e in combined.events if e.kind == "outlier"]
    assert set(np.flatnonzero(wild)) <= set(left_out)
    assert len(left_out) <= wild.sum() + 2
    assert not changes(combined)
    assert mean(combined.errors(clean)) < 1.1 * mean(other.errors(clean))


def test_wild_points_at_the_start_spoil_nothing():
    placed = model()
    clean = sightings(placed, errors_of(placed, 2), 60, 2)
    rng = np.random.default_rng(5)
    wild = rng.random(60) < 0.15
    position = clean.position.copy()
    position[wild] += rng.normal(scale=0.05, size=(int(wild.sum()), 3))
    combined = type(taught())(placed, taught().sheet)
    combined.observe_many(replace(clean, position=position))
    assert mean(combined.errors(clean)) < 4e-4
    believed = combined.engine.bank.weights[:60] > 0.0
    assert not believed[wild].any()


def test_an_arm_that_is_bumped_keeps_its_curves():
    combined = deepcopy(taught())
    chain, before = combined.engine.chain, combined.engine.x.copy()
    joints = seen_later(12).joints.copy()
    joints[:, 1] -= SLIP
    combined.observe_many(replace(seen_later(12), joints=joints))
    moved = combined.engine.x - before
    zero = joint_at(combined.robot.kernel, 1) + 5
    assert abs(moved[zero] - SLIP) < 2e-4
    others = np.abs(moved / chain.tolerance)[chain.curved]
    assert others.max() < 0.3
