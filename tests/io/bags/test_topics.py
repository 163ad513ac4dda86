"""Which topics are read, and what is said when that is not clear."""

import pytest
from tests.io.bags.recordings import BARE_TAGS, Bag, header
from tests.io.bags.test_reading import NO_DELAY, Arm, Q, error_of, two_joints

from handeye.io.bags import BagOptions, read_bag


def options(**given):
    return BagOptions(delay=0.0, **given)


def test_the_joint_topic_that_has_the_arm_s_joints_is_taken(tmp_path):
    bag = two_joints()
    for i in range(51):
        bag.joints(i / 50, ["finger"], [0.1], topic="/gripper/joint_states")
    bag.point(0.5, [1, 2, 3])
    path = bag.write(tmp_path, "mcap")
    assert read_bag(path, arm=Arm(), options=NO_DELAY).report.joints_topic == "/joint_states"
    message = error_of(path, options=NO_DELAY)
    assert "say which with --joints-topic TOPIC" in message
    assert "/gripper/joint_states  sensor_msgs/msg/JointState  (51 messages): finger" in message
    assert "/joint_states  sensor_msgs/msg/JointState  (51 messages): shoulder, elbow" in message
    fingers = read_bag(path, options=options(joints_topic="gripper/joint_states"))
    assert fingers.log.joint_names == ("finger",)
    [other] = fingers.report.others
    assert other.topic == "/joint_states"


def test_points_come_before_transforms_and_the_user_chooses_among_several(tmp_path):
    bag = two_joints()
    bag.point(0.5, [1, 2, 3])
    for i in range(3):
        bag.transforms(0.2 + i / 10, ("camera", "tag", [i, 0, 0], Q))
    path = bag.write(tmp_path, "ros1", "one")
    assert read_bag(path, options=NO_DELAY).report.points_topic == "/marker"
    # A frame named as the marker means transforms; so does their topic.
    assert read_bag(path, options=options(marker="tag")).report.points_topic == "/tf"
    assert read_bag(path, options=options(points_topic="/tf")).report.points_topic == "/tf"
    bag.tags(0.5, (3, [1, 2, 3], Q))
    path = bag.write(tmp_path, "ros1", "two")
    message = error_of(path, options=NO_DELAY)
    assert "say which with --points-topic TOPIC" in message
    assert "/detections" in message
    assert "/marker" in message
    assert "/tf" not in message
    assert read_bag(path, options=options(marker="3")).report.points_topic == "/detections"


def test_topics_that_are_not_there_or_of_another_kind_are_refused(tmp_path):
    bag = two_joints()
    bag.point(0.5, [1, 2, 3])
    path = bag.write(tmp_path, "mcap")
    near = error_of(path, options=options(points_topic="/marked"))
    assert "has no topic /marked; did you mean /marker?" in near
    assert "for --points-topic choose from\n  /marker" in near
    kind = error_of(path, options=options(joints_topic="/marker"))
    assert "/marker holds geometry_msgs/msg/PointStamped, not sensor_msgs/msg/JointState" in kind
    assert "for --joints-topic choose from\n  /joint_states" in kind


def test_a_recording_without_joints_or_measurements_says_what_it_has(tmp_path):
    bag = Bag()
    bag.point(0.5, [1, 2, 3])
    message = error_of(bag.write(tmp_path, "mcap", "a"))
    assert "has no joint states (sensor_msgs/msg/JointState)" in message
    assert "/marker  geometry_msgs/msg/PointStamped  (1 messages)" in message
    message = error_of(two_joints().write(tmp_path, "mcap", "b"))
    assert "has no measurements (geometry_msgs/PointStamped" in message
    assert "/joint_states" in message
    message = error_of(two_joints().write(tmp_path, "mcap", "b2"), options=options(marker="7"))
    assert "that name a marker (7)" in message


def test_tags_without_poses_point_to_the_transforms(tmp_path):
    bag = two_joints()
    content = {"header": header(0.5), "detections": [{"family": "36h11", "id": 3}]}
    bag.add("/detections", BARE_TAGS, 0.5, content)
    message = error_of(bag.write(tmp_path, "ros1"))
    assert "/detections has 1 messages, but no pose in any" in message
    assert "--points-topic /tf --frame CAMERA --marker TAG_FRAME" in message


@pytest.mark.parametrize("form", ["ros1", "mcap"])
def test_a_topic_that_nobody_needs_may_be_of_any_type(tmp_path, form):
    bag = two_joints()
    bag.point(0.5, [1, 2, 3])
    bag.add("/odd", BARE_TAGS, 0.5, {"header": header(0.5), "detections": []})
    reading = read_bag(bag.write(tmp_path, form), options=options(points_topic="/marker"))
    assert [other.topic for other in reading.report.others] == ["/odd"]
