"""Recordings of every kind become logs."""

from dataclasses import replace

import numpy as np
import pytest
from tests.io.bags.recordings import FORMATS, Bag, Motion, ur10

from handeye.errors import InvalidInput, LogError
from handeye.io.bags import BagOptions, is_bag, read_bag
from handeye.io.logs import read_log, write_log
from handeye.observations import PointObservation

NO_DELAY = BagOptions(delay=0.0)
Q = (1.0, 0.0, 0.0, 0.0)


def seen(log) -> PointObservation:
    assert isinstance(log.observations, PointObservation)
    return log.observations


def error_of(path, **options):
    with pytest.raises(LogError) as caught:
        read_bag(path, **options)
    assert str(path) in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("form", "kind"),
    [*((form, "point") for form in FORMATS), ("mcap folder", "pose"), ("ros1", "tags"),
     ("sqlite3", "tf"), ("mcap", "tags"), ("json", "tf")],
)  # fmt: skip
def test_every_format_gives_the_joints_at_each_measurement_less_the_delay(tmp_path, form, kind):
    motion = Motion(seconds=15.0)
    path = motion.record(delay=0.037, kind=kind, rate=100.0).write(tmp_path, form)
    assert is_bag(path)
    reading = read_bag(path, arm=ur10())
    delay = reading.report.delay
    assert delay.std is not None
    assert abs(delay.seconds - 0.037) < 3.0 * delay.std < 5e-3
    found = seen(reading.log)
    assert reading.log.joint_names == tuple(ur10().joint_names)
    np.testing.assert_allclose(found.joints, motion.joints(found.time), atol=5e-4)
    np.testing.assert_allclose(found.position, motion.positions(found.time), atol=2e-3)
    assert (found.orientation is None) == (kind == "point")
    assert reading.report.oriented == (kind != "point")
    assert reading.report.unused == ()
    assert reading.rejected == ()
    np.testing.assert_array_equal(reading.log.rows, np.arange(1, len(found) + 1))


def test_messages_in_any_order_make_the_same_log(tmp_path):
    bag = Motion(seconds=4.0).record(kind="pose")
    read = read_bag(bag.write(tmp_path, "mcap", "a"), options=NO_DELAY).log
    np.random.default_rng(0).shuffle(bag.messages)
    # Receipt in another order than the stamps'.
    bag.messages = [(t, k, 10**18 + i, c) for i, (t, k, _, c) in enumerate(bag.messages)]
    shuffled = read_bag(bag.write(tmp_path, "mcap", "b"), options=NO_DELAY).log
    np.testing.assert_array_equal(seen(shuffled).time, seen(read).time)
    np.testing.assert_array_equal(seen(shuffled).joints, seen(read).joints)
    np.testing.assert_array_equal(seen(shuffled).position, seen(read).position)


def test_a_log_read_by_its_suffix_can_be_written_as_a_table(tmp_path):
    path = Motion(seconds=4.0).record(kind="pose").write(tmp_path, "ros1")
    log = read_log(path).log
    assert log.name == str(path)
    write_log(tmp_path / "log.csv", log)
    np.testing.assert_array_equal(seen(read_log(tmp_path / "log.csv").log).joints, seen(log).joints)
    assert not is_bag(tmp_path / "log.csv")
    assert not is_bag(tmp_path)


class Arm:
    """Joints in an order of its own, without kinematics."""

    joint_names = ("elbow", "shoulder")

    def poses(self, joints):
        raise NotImplementedError


def two_joints(names=("shoulder", "elbow"), seconds=1.0):
    bag = Bag()
    for i in range(round(seconds * 50) + 1):
        bag.joints(i / 50, names, [i / 50, 2 * i / 50][: len(names)])
    return bag


def test_joints_stand_in_the_order_of_the_arm_and_others_are_reported(tmp_path):
    bag = two_joints()
    for i in range(51):
        bag.joints(i / 50 + 0.003, ["gripper"], [0.5])
    bag.point(0.51, [1, 2, 3])
    path = bag.write(tmp_path, "mcap")
    reading = read_bag(path, arm=Arm(), options=NO_DELAY)
    assert reading.log.joint_names == ("elbow", "shoulder")
    np.testing.assert_allclose(seen(reading.log).joints, [[1.02, 0.51]], atol=1e-6)
    [unused] = reading.report.unused
    assert str(unused) == ("/joint_states: 51 messages not used: they are of other joints: gripper")
    everything = read_bag(path, options=NO_DELAY)
    assert everything.log.joint_names == ("shoulder", "elbow", "gripper")


def test_joints_that_the_recording_lacks_are_named_with_near_names(tmp_path):
    path = two_joints(("ur_shoulder", "elbo"))
    path.point(0.5, [1, 2, 3])
    message = error_of(path.write(tmp_path, "mcap"), arm=Arm(), options=NO_DELAY)
    assert "/joint_states lacks joints of the robot: elbow, shoulder" in message
    assert "it has: ur_shoulder, elbo" in message
    assert "ur_shoulder may be shoulder" in message
    assert "elbo may be elbow" in message


def test_everything_that_is_not_used_is_reported_with_its_reason(tmp_path):
    bag = two_joints()
    bag.joints(None, ["shoulder", "elbow"], [0, 0], received=1)
    bag.joints(0.02, ["shoulder", "elbow"], [9, 9])
    bag.joints(0.5, ["shoulder", "elbow"], [float("nan"), 0])
    bag.joints(0.5, ["shoulder", "elbow"], [0.0])
    bag.joints(1.5, ["shoulder", "elbow"], [1.5, 3.0])
    for stamp in (-0.5, 0.3, 0.3, 1.2, 7.0):
        bag.point(stamp, [1, 2, 3])
    bag.point(0.4, [float("nan"), 2, 3])
    bag.point(None, [1, 2, 3], received=5)
    bag.pose(0.5, [1, 2, 3], Q, topic="/goal")
    options = replace(NO_DELAY, points_topic="/marker")
    report = read_bag(bag.write(tmp_path, "ros1"), options=options).report
    said = {(u.topic, u.count, u.reason.split(" (")[0]) for u in report.unused}
    gap = "the joint states around them are up to 0.5 s apart, more than the tolerance of 0.1 s"
    assert said == {
        ("/joint_states", 1, "they have no time stamp"),
        ("/joint_states", 1, "they repeat the time stamp of another"),
        ("/joint_states", 1, "they have values that are not finite, or a quaternion of zeros"),
        ("/joint_states", 1, "they cannot be decoded"),
        ("/marker", 1, "they have no time stamp"),
        ("/marker", 1, "they repeat the time stamp of another"),
        ("/marker", 1, "they have values that are not finite, or a quaternion of zeros"),
        ("/marker", 2, "no joint state comes before, or none after them"),
        ("/marker", 1, gap),
    }
    [other] = report.others
    assert (other.topic, other.count) == ("/goal", 1)
    data = report.as_data()
    assert len(data["unused"]) == 10
    assert data["delay_s"] == 0.0
    assert any("1 other topics (1 messages) not read" in line for line in report.lines())


def test_orientation_is_left_out_unless_every_row_has_one(tmp_path):
    bag = two_joints()
    bag.pose(0.3, [1, 2, 3], Q)
    bag.pose(0.4, [1, 2, 3], (0, 0, 0, 0))
    reading = read_bag(bag.write(tmp_path, "mcap"), options=NO_DELAY)
    assert seen(reading.log).orientation is None
    assert len(reading.log) == 2
    assert "without orientation" in reading.report.lines()[0]


def test_values_that_cannot_be_right_are_refused_as_in_a_table(tmp_path):
    bag = two_joints()
    for i in range(10):
        bag.pose(0.3 + i / 100, [1, 2, 3], Q)
    bag.pose(0.5, [1, 2, 3], (0.5, 0, 0, 0))
    path = bag.write(tmp_path, "mcap")
    message = error_of(path, options=NO_DELAY)
    assert "/tag_pose: 1 of 11 rows cannot be used" in message
    assert "row 11: the quaternion qw, qx, qy, qz has length 0.5, not 1" in message
    assert len(read_bag(path, options=NO_DELAY, skip_bad=True).log) == 10
    far = two_joints()
    far.point(0.5, [1000, 2000, 3000])
    assert "millimetres" in error_of(far.write(tmp_path, "mcap", "far"), options=NO_DELAY)


def test_clocks_that_differ_are_told_with_the_delay_that_receipt_shows(tmp_path):
    bag = two_joints()
    for stamp in (0.2, 0.4):
        received = 1_700_000_000_000_000_000 + int(stamp * 1e9)
        bag.point(stamp - 3600.0, [1, 2, 3], received=received)
    path = bag.write(tmp_path, "mcap")
    message = error_of(path)
    assert "their clocks differ" in message
    assert "--delay -3600.000" in message
    assert len(read_bag(path, options=BagOptions(delay=-3600.0)).log) == 2


def test_times_of_receipt_are_used_on_request_only(tmp_path):
    bag = Bag()
    for i in range(51):
        bag.joints(None, ["a", "b"], [i / 10, i / 5], received=i * 20_000_000)
    bag.point(None, [1, 2, 3], received=510_000_000)
    path = bag.write(tmp_path, "mcap")
    message = error_of(path)
    assert "no joint state of /joint_states can be used" in message
    assert "header.stamp is 0" in message
    assert "--receipt-times" in message
    log = read_bag(path, options=replace(NO_DELAY, receipt_times=True)).log
    np.testing.assert_allclose(seen(log).joints, [[2.55, 5.1]])


def test_a_slow_joint_topic_needs_another_tolerance(tmp_path):
    bag = Bag()
    for i in range(10):
        bag.joints(float(i), ["a"], [i / 10])
    bag.point(4.5, [1, 2, 3])
    path = bag.write(tmp_path, "mcap")
    assert "these come every 1 s, and the tolerance is 0.1 s" in error_of(path)
    log = read_bag(path, options=replace(NO_DELAY, tolerance=1.0)).log
    np.testing.assert_allclose(seen(log).joints, [[0.45]])


@pytest.mark.parametrize("wrong", [{"tolerance": 0.0}, {"tolerance": -1.0}, {"delay": np.inf}])
def test_options_are_checked(wrong):
    with pytest.raises(InvalidInput):
        BagOptions(**wrong)


def test_progress_counts_every_message_that_is_read(tmp_path):
    bag = two_joints(seconds=20.0)
    bag.point(0.5, [1, 2, 3])
    told: list[tuple[int, int]] = []
    path = bag.write(tmp_path, "mcap")
    read_bag(path, options=NO_DELAY, progress=lambda done, total: told.append((done, total)))
    assert told[0] == (0, 1002)
    assert told[-1] == (1002, 1002)
    assert [done for done, _ in told] == sorted(done for done, _ in told)
