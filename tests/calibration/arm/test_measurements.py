from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.calibration.arm.measured import KINDS, N, as_measured, distances, flanges, zeros

from handeye.arrays import Array
from handeye.calibration.arm import measurements
from handeye.calibration.arm.measurements import Frame, Instrument, Points, Sight, Touches
from handeye.errors import InvalidInput
from handeye.geometry import make_pose

STEP = 1e-6


def nudged(poses: Array, way: int, amount: float) -> Array:
    """Flanges shifted, or turned about their origins, along one axis of the base."""
    d = np.zeros(3)
    d[way % 3] = amount
    if way < 3:
        return poses + np.pad(d[:, np.newaxis], ((0, 1), (3, 0)))
    R = Rotation.from_rotvec(d).as_matrix()
    return make_pose(R @ poses[:, :3, :3], poses[:, :3, 3])


@pytest.fixture(params=KINDS)
def case(request: pytest.FixtureRequest) -> tuple[Instrument, Array]:
    rng = np.random.default_rng(list(KINDS).index(request.param))
    poses = flanges(rng)
    kind = as_measured(KINDS[request.param](rng), poses)
    return kind, np.array([nudged(pose[None], 4, 0.02)[0] for pose in poses])


def values(kind: Instrument) -> tuple[Array, ...]:
    """Changes of all blocks, some percent of their tolerances, away from the references."""
    rng = np.random.default_rng(5)
    return tuple(
        0.3 * block.tolerance * rng.standard_normal(len(block.names)) for block in kind.blocks
    )


def test_every_kind_is_registered():
    public = {
        one
        for one in vars(measurements).values()
        if isinstance(one, type) and issubclass(one, Instrument) and one is not Instrument
    }
    assert public == {type(make(np.random.default_rng(0))) for make in KINDS.values()}


def test_residuals_vanish_for_what_the_references_predict(case: tuple[Instrument, Array]):
    kind, _ = case
    poses = flanges(np.random.default_rng(100))
    exact = as_measured(kind, poses)
    np.testing.assert_allclose(exact.equations(poses, zeros(kind)).residuals, 0.0, atol=1e-9)
    assert np.abs(kind.equations(poses, zeros(kind)).residuals).max() > 1e-3


def test_derivatives_by_the_flange_equal_differences(case: tuple[Instrument, Array]):
    kind, poses = case
    own = values(kind)
    analytic = kind.equations(poses, own).by_flange
    for way in range(6):
        up, down = (
            kind.equations(nudged(poses, way, amount), own).residuals for amount in (STEP, -STEP)
        )
        scale = np.abs(analytic).max()
        np.testing.assert_allclose(analytic[..., way], (up - down) / (2 * STEP), atol=2e-7 * scale)


def test_derivatives_by_every_unknown_equal_differences(case: tuple[Instrument, Array]):
    kind, poses = case
    own = values(kind)
    by_blocks = kind.equations(poses, own).by_blocks
    assert [b.shape[2] for b in by_blocks] == [len(block.names) for block in kind.blocks]
    for i, (block, analytic) in enumerate(zip(kind.blocks, by_blocks, strict=True)):
        for j, name in enumerate(block.names):
            ends: list[Array] = []
            for amount in (STEP, -STEP):
                changed = [one.copy() for one in own]
                changed[i][j] += amount
                ends.append(kind.equations(poses, tuple(changed)).residuals)
            by = (ends[0] - ends[1]) / (2 * STEP)
            scale = max(1.0, float(np.abs(by).max()))
            np.testing.assert_allclose(analytic[..., j], by, atol=1e-6 * scale, err_msg=name)


def test_moved_references_stand_where_the_values_were(case: tuple[Instrument, Array]):
    kind, poses = case
    own = values(kind)
    changes = {block.name: x for block, x in zip(kind.blocks, own, strict=True)}
    there = kind.moved(changes)
    np.testing.assert_allclose(
        there.equations(poses, zeros(kind)).residuals, kind.equations(poses, own).residuals,
        rtol=1e-9, atol=1e-9,
    )  # fmt: skip
    assert [block.names for block in there.blocks] == [block.names for block in kind.blocks]


def test_shapes_channels_and_names_fit(case: tuple[Instrument, Array]):
    kind, poses = case
    parts = kind.equations(poses, zeros(kind))
    k = len(kind.channels)
    assert parts.residuals.shape == kind.std.shape == (N, k)
    assert parts.by_flange.shape == (N, k, 6)
    names = [name for block in kind.blocks for name in block.names]
    assert len(set(names)) == len(names)
    assert all(kind.name in channel for channel in kind.channels)


def test_what_is_known_is_no_unknown():
    rng = np.random.default_rng(2)
    kind, poses = distances(rng), flanges(rng)
    assert isinstance(kind, measurements.Distances)
    loose = kind.equations(poses, zeros(kind))
    sensor = kind.sight.sensor
    anchor = replace(sensor, tolerance=sensor.tolerance * [1, 1, 1, 0, 0, 0])
    target = Frame.known("t", kind.sight.target.reference)
    known = replace(kind, sight=replace(kind.sight, sensor=anchor, target=target))
    assert [block.name for block in known.blocks] == ["sensor", "points", "zero"]
    assert known.blocks[0].names == ("sensor x", "sensor y", "sensor z")
    parts = known.equations(poses, zeros(known))
    np.testing.assert_array_equal(parts.residuals, loose.residuals)
    np.testing.assert_array_equal(parts.by_blocks[0], loose.by_blocks[0][..., :3])
    np.testing.assert_array_equal(parts.by_blocks[1], loose.by_blocks[2])


def test_stereo_eccentricities_are_compared_the_short_way_round():
    rng = np.random.default_rng(8)
    poses = flanges(rng)
    kind = as_measured(KINDS["stereo head"](rng), poses)
    assert isinstance(kind, measurements.StereoSightings)
    around = replace(kind, measured=kind.measured + np.array([0.0, 2.0 * np.pi]))
    np.testing.assert_allclose(around.equations(poses, zeros(kind)).residuals, 0.0, atol=1e-9)


def sight(**changes: object) -> Sight:
    plain = {
        "setup": "eye_to_hand", "sensor": Frame.near("a", np.eye(4)), "target": Frame.known(),
        "points": Points.near("b"), "which": np.zeros(3, np.int64),
    }  # fmt: skip
    return Sight(**{**plain, **changes})  # pyright: ignore[reportArgumentType]


def test_what_does_not_fit_is_refused():
    with pytest.raises(InvalidInput, match="'eye_in_hand' or 'eye_to_hand'"):
        sight(setup="eye")
    with pytest.raises(InvalidInput, match="points 0 to 0 of b, got 0 to 1"):
        sight(which=np.array([0, 1, 0]))
    with pytest.raises(InvalidInput, match="whole numbers"):
        sight(which=np.zeros(3))
    with pytest.raises(InvalidInput, match="tolerance must be at least 0"):
        Frame.near("a", np.eye(4), shift=-1.0)
    with pytest.raises(InvalidInput, match="no rotation"):
        Frame.near("a", 2.0 * np.eye(4))
    three = partial(measurements.PointSightings, joints=np.zeros((3, 6)), measured=np.zeros((3, 3)))
    with pytest.raises(InvalidInput, match="different names, got a, a"):
        three(sight=sight(points=Points.near("a")))
    with pytest.raises(InvalidInput, match=r"tip: 3 rows of joints .* 2 points"):
        three(sight=sight(which=np.zeros(2, np.int64)), name="tip")
    with pytest.raises(InvalidInput, match=r"std of tip must have shape \(3, 3\)"):
        three(sight=sight(), std=np.ones(2), name="tip")
    with pytest.raises(InvalidInput, match="at least 0"):
        three(sight=sight(), std=np.array(-1.0))
    joints, places = np.zeros((3, 6)), flanges(np.random.default_rng(0), 3)
    with pytest.raises(InvalidInput, match="every one of 3 places"):
        Touches.start(joints, places, [0, 1, 1], geometry=np.eye(3))
