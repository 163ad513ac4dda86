"""Changes of an arm, found from all rows of a log at once."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from tests.calibration.arm.arms import errors_of, kernel_of, model, sightings

from handeye.calibration.arm.kernels import joint_at
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.changes import History, in_hindsight
from handeye.calibration.hindsight import look_back
from handeye.geometry import matrix_from_wxyz

pytest.importorskip("pinocchio")
N = 90
SLIP, MOVED = np.radians(0.4), np.array([2e-3, -1.5e-3, 2e-3])
STIFF = ArmSheet(curves=CurveTerms(1, 0))


@cache
def clean(seed=0, n=N):
    placed = model()
    return sightings(placed, errors_of(placed, seed, STIFF), n, seed, STIFF)


def slipped(seen, at, joint=1, by=SLIP):
    joints = seen.joints.copy()
    joints[at:, joint] -= by
    return replace(seen, joints=joints)


def moved(seen, at, by=MOVED):
    position = seen.position.copy()
    position[at:] += by
    return replace(seen, position=position)


def zero(joint):
    return (joint_at(kernel_of(model()), joint) + 5,)


def test_an_arm_that_stays_as_it_is_has_no_changes():
    for seed in range(3):
        assert look_back(model(), clean(seed)).jumps == ()


@pytest.mark.parametrize("at", [7, 20, 64, N - 8])
def test_a_slip_is_found_wherever_it_is(at):
    found = look_back(model(), slipped(clean(), at))
    (jump,) = found.jumps
    assert jump.places == zero(1)
    assert abs(jump.at - at) <= 1
    (event,) = found.events
    assert (event.kind, event.observation) == ("change", jump.at)
    assert event.part == "encoder offset of joint shoulder_lift_joint"
    assert event.unit == "rad"
    assert abs(event.amount - SLIP) < 5.0 * event.std < 1e-3


def test_two_changes_and_two_parts_at_once_are_told_apart():
    seen = moved(slipped(clean(1), 30, joint=2), 60)
    found = look_back(model(), seen)
    assert [(jump.at, jump.places) for jump in found.jumps] == [
        (30, zero(2)), (60, tuple(range(6))),
    ]  # fmt: skip
    carried = matrix_from_wxyz(clean(2).orientation) @ MOVED
    carried[:40] = 0.0
    both = slipped(replace(clean(2), position=clean(2).position + carried), 40, joint=2)
    found = look_back(model(), both)
    assert {(jump.at, jump.places) for jump in found.jumps} == {
        (40, zero(2)), (40, tuple(range(6, 12))),
    }  # fmt: skip


def test_what_moves_on_all_the_time_drifts():
    share = np.linspace(0.0, 1.0, N)[:, np.newaxis]
    seen = replace(clean(3), position=clean(3).position + 2.0 * share * MOVED)
    found = look_back(model(), seen)
    (event,) = [event for event in found.events if event.kind == "drift"]
    assert event.part == "base of the sensor"
    assert len(found.jumps) >= 3
    # Most of the way lies between the steps.
    assert 0.5 < np.abs(event.amount) / np.max(np.abs(2.0 * MOVED)) < 1.1


def test_wild_rows_are_no_change():
    seen, rng = clean(4), np.random.default_rng(0)
    position = seen.position.copy()
    wild = rng.random(N) < 0.2
    wild[-5:] = True
    position[wild] += rng.normal(scale=0.05, size=(int(wild.sum()), 3))
    assert look_back(model(), replace(seen, position=position)).jumps == ()


def test_so_few_rows_tell_of_no_change():
    for n in (1, 6, 9):
        assert look_back(model(), clean(5)[:n]).jumps == ()


def test_hindsight_comes_before_what_was_noticed_live():
    live, seen = History(70, 0), slipped(clean(), 20)
    found = in_hindsight(live, model(), seen)
    assert (found.since, found.first) == (20, 0)
    assert found.events == look_back(model(), seen).events
    assert in_hindsight(live, model(), clean()) is live
