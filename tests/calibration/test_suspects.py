"""Mistakes in a log that are named because mending them explains far more."""

from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.arm.arms import PLACEMENT, arm, errors_of, model, sightings
from tests.robots.made import FOUR

from handeye.calibration.suspects import suspects
from handeye.observations import PointObservation
from handeye.robots.urdf import UrdfArm

pytest.importorskip("pinocchio")
N = 50


@pytest.fixture(scope="module")
def seen():
    """A UR10 with ordinary errors."""
    placed = model()
    return sightings(placed, errors_of(placed, 1), N, 1)


def read(seen, change):
    """The same log with its readings changed in place."""
    joints = seen.joints.copy()
    change(joints)
    return replace(seen, joints=joints)


def reverse(j):
    def change(joints):
        joints[:, j] *= -1.0

    return change


def add(j, angle):
    def change(joints):
        joints[:, j] += angle

    return change


def exchange(joints):
    joints[:, [1, 2]] = joints[:, [2, 1]]


def both(joints):
    reverse(1)(joints)
    reverse(2)(joints)


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (reverse(2), ["joint elbow_joint seems to have the other sign"]),
        (add(1, np.pi / 2), ["joint shoulder_lift_joint seems to have another zero (-"]),
        (exchange, ["columns of joints shoulder_lift_joint and elbow_joint seem to be exchanged"]),
        (both, ["joints shoulder_lift_joint and elbow_joint seem to have the other sign"]),
        (lambda joints: np.degrees(joints, out=joints), None),
    ],
)
def test_a_mistake_is_named_with_its_joint(seen, change, named):
    found = suspects(arm(), read(seen, change), 0.1)
    if named is None:  # of all joints at once it is more than a slip
        assert all("degrees" in words for words in found)
        return
    assert len(found) == len(named)
    assert all(any(words in said for said in found) for words in named), found


def test_a_log_as_it_should_be_has_no_mistake(seen):
    assert suspects(arm(), seen, 1e-4) == ()
    large = sightings(model(), errors_of(model(), 2, size=8.0), N, 2)
    assert suspects(arm(), large, 1e-3) == ()


def test_mistakes_that_come_to_the_same_are_all_named():
    """A second joint reversed is a base and a third joint turned by half a turn."""
    panda = UrdfArm.shipped("panda", "panda_link8")
    rng = np.random.default_rng(2)
    joints = rng.uniform(panda.lower, panda.upper, (N, 7))
    position = PLACEMENT.predict(panda, joints) + rng.normal(scale=1e-3, size=(N, 3))
    other = joints * np.array([1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    (found,) = suspects(panda, PointObservation(np.arange(float(N)), other, position), 0.1)
    assert "joint panda_joint2 seems to have the other sign, or joint panda_joint3 seems" in found


def test_of_few_rows_nothing_is_said(seen):
    other = read(seen, reverse(2))
    assert suspects(arm(), other[:20], 0.1) != ()
    assert suspects(arm(), other[:19], 0.1) == ()


def test_nothing_is_named_that_the_fit_has_found_by_itself(seen):
    assert suspects(arm(), read(seen, add(3, np.radians(20.0))), 0.1) != ()
    assert suspects(arm(), read(seen, add(3, np.radians(20.0))), 1e-4) == ()


def test_another_link_and_another_side_are_named(seen):
    still = read(seen, lambda joints: joints[:, 4:].fill(0.0))
    position = PLACEMENT.predict(arm(), still.joints)
    found = suspects(arm(), replace(seen, position=position), 0.1)
    assert found == ("the marker seems to sit before joint wrist_2_joint: give its link as --tip",)
    back = np.linalg.inv(arm().poses(seen.joints))
    base, marker = PLACEMENT.T_sensor_base, PLACEMENT.T_flange_marker[:, 3]
    ridden = replace(seen, position=(base @ back @ marker)[:, :3])
    assert "ride on the hand" in suspects(arm(), ridden, 0.1)[0]


def test_a_slide_in_millimetres_is_named():
    slides = UrdfArm.from_text(FOUR, None, "four")
    joints = np.random.default_rng(3).uniform(
        slides.lower.clip(-1.5), slides.upper.clip(max=1.5), (N, 3)
    )
    position = PLACEMENT.predict(slides, joints)

    def named(factor):
        other = joints * np.array([factor, 1.0, 1.0])
        return suspects(slides, PointObservation(np.arange(float(N)), other, position), 0.1)

    assert named(1.0) == ()
    assert named(1000.0) == ("joint lift seems to be in millimetres",)
