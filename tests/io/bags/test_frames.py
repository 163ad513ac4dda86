"""Which frame and marker are meant, and transforms put together."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.io.bags.recordings import Bag
from tests.io.bags.test_reading import Q, error_of, seen

from handeye.geometry import invert, make_pose
from handeye.io.bags import BagOptions, read_bag


def options(**given):
    return BagOptions(delay=0.0, **given)


def moving(bag=None):
    bag = Bag() if bag is None else bag
    for i in range(51):
        bag.joints(i / 50, ["a"], [i / 50])
    return bag


def random_pose(rng):
    return make_pose(Rotation.random(rng=rng).as_matrix(), rng.normal(size=3))


def step(parent, child, T):
    return parent, child, T[:3, 3], Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)


def test_fixed_transforms_are_composed_around_the_measured_one(tmp_path):
    rng = np.random.default_rng(0)
    # world -> stand -> camera ~~> tag -> marker, and from the marker's side: flange -> marker
    stand, mount, tip = (random_pose(rng) for _ in range(3))
    tags = [random_pose(rng) for _ in range(5)]
    bag = moving()
    bag.transforms(0.0, step("world", "stand", stand), topic="/tf_static")
    bag.transforms(0.0, step("/flange", "/tag", tip), topic="/tf_static")
    for i, T in enumerate(tags):
        bag.transforms(0.1 + i / 10, step("stand", "camera", mount), step("camera", "tag", T))
        bag.transforms(0.1 + i / 10, step("base", "link", random_pose(rng)))
    path = bag.write(tmp_path, "ros1")
    reading = read_bag(path, options=options(frame="world", marker="flange"))
    found = seen(reading.log)
    want = np.array([stand @ mount @ T @ invert(tip) for T in tags])
    np.testing.assert_allclose(found.position, want[:, :3, 3], atol=1e-12)
    assert found.orientation is not None
    turned = Rotation.from_quat(found.orientation, scalar_first=True).as_matrix()
    np.testing.assert_allclose(turned, want[:, :3, :3], atol=1e-12)
    assert reading.report.measured == "marker flange in frame world"
    assert reading.report.points_topic == "/tf"

    back = seen(read_bag(path, options=options(frame="tag", marker="camera")).log)
    np.testing.assert_allclose(back.position, [invert(T)[:3, 3] for T in tags], atol=1e-12)


def test_of_several_moving_transforms_the_user_chooses(tmp_path):
    rng = np.random.default_rng(1)
    bag = moving()
    for i in range(5):
        t = 0.1 + i / 10
        bag.transforms(t, step("camera", "tag36h11:0", random_pose(rng)))
        bag.transforms(t, step("base", "link", random_pose(rng)), step("link", "hand", np.eye(4)))
        bag.transforms(t, step("link", "camera", random_pose(rng)))
    path = bag.write(tmp_path, "mcap")
    message = error_of(path, options=options())
    assert "/tf has 3 moving transforms" in message
    assert "--frame camera --marker tag36h11:0  (5 times)" in message
    assert len(read_bag(path, options=options(frame="camera")).log) == 5
    assert len(read_bag(path, options=options(marker="tag36h11:0")).log) == 5
    two = error_of(path, options=options(frame="hand", marker="tag36h11:0"))
    assert "there move: link to camera, camera to tag36h11:0" in two
    apart = error_of(path, options=options(frame="camera", marker="moon"))
    assert "no transforms of /tf lead from camera to moon" in apart
    assert "0 moving transforms of marker moon" in error_of(path, options=options(marker="moon"))


def test_points_in_two_frames_and_tags_of_two_numbers_are_told_apart(tmp_path):
    bag = moving()
    for i in range(4):
        bag.point(0.1 + i / 10, [i, 2, 3], frame="left")
    bag.point(0.6, [9, 2, 3], frame="/right")
    path = bag.write(tmp_path, "mcap", "points")
    message = error_of(path, options=options())
    assert "say which with --frame FRAME" in message
    assert message.index("--frame left  (4 times)") < message.index("--frame right  (1 times)")
    reading = read_bag(path, options=options(frame="right"))
    np.testing.assert_array_equal(seen(reading.log).position, [[9, 2, 3]])
    [unused] = reading.report.unused
    assert (unused.count, unused.reason) == (4, "they are of a point in frame left")
    assert "has nothing in frame up" in error_of(path, options=options(frame="up"))

    tags = moving()
    tags.tags(0.2, (3, [1, 2, 3], Q), (4, [4, 5, 6], Q))
    tags.tags(0.3)
    path = tags.write(tmp_path, "mcap", "tags")
    assert "--marker 4" in error_of(path, options=options())
    reading = read_bag(path, options=options(marker="4"))
    np.testing.assert_array_equal(seen(reading.log).position, [[4, 5, 6]])
    assert {u.reason for u in reading.report.unused} == {
        "nothing was seen in them",
        "they are of marker 3 in frame camera",
    }


def test_transforms_without_a_rotation_are_left_out(tmp_path):
    bag = moving()
    bag.transforms(0.0, ("camera", "lens", [0, 0, 0], (0, 0, 0, 0)), topic="/tf_static")
    bag.transforms(0.2, ("camera", "tag", [1, 2, 3], (0, 0, 0, 0)))
    bag.transforms(0.3, ("camera", "tag", [1, 2, 3], (0, 0, 0, 2.0)))
    reading = read_bag(bag.write(tmp_path, "mcap"), options=options())
    orientation = seen(reading.log).orientation
    assert orientation is not None
    np.testing.assert_allclose(orientation, [[0, 0, 0, 1]])
    [unused] = reading.report.unused
    assert unused.count == 2


@pytest.mark.parametrize("marker", [None, "tag"])
def test_a_transform_that_is_always_the_same_counts_as_measured_if_it_is_alone(tmp_path, marker):
    bag = moving()
    for i in range(3):
        bag.transforms(0.2 + i / 10, step("camera", "tag", np.eye(4)))
    given = options(frame="camera", marker=marker)
    assert len(read_bag(bag.write(tmp_path, "mcap"), options=given).log) == 3
