"""Which measurement of a set-up to take next: laws of what a measurement is worth."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.setups.fits import END, PLAIN, described_few, fitted, of_case
from tests.calibration.setups.two_arms import NOISE, TwoArms, described_torso

from handeye.arrays import Array
from handeye.calibration.arm.measurements import (
    Instrument,
    PointSightings,
    PoseSightings,
    StereoSightings,
)
from handeye.calibration.setups.description import Description, load_description
from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.calibration.setups.free_poses import FreePoses, title
from handeye.calibration.setups.suggesting import (
    SuggestedRows,
    _Offer,
    _Slopes,
    _Spread,
    suggest_rows,
)
from handeye.calibration.view import View
from handeye.errors import InvalidInput


@pytest.fixture(scope="module")
def torso(tmp_path_factory: pytest.TempPathFactory) -> Description:
    return described_few(tmp_path_factory.mktemp("torso"))


@pytest.fixture(scope="module")
def fit(torso: Description) -> MixedFit:
    return fitted(torso)


@pytest.fixture(scope="module")
def found(torso: Description, fit: MixedFit) -> SuggestedRows:
    return suggest_rows(fit, 6, sizes=torso.sizes)


def measured(world: TwoArms, table: str, one: Instrument, joints: Array) -> Instrument:
    """More rows of an instrument, as the world has them."""
    assert isinstance(one, PointSightings)
    noise = np.random.default_rng(len(joints)).standard_normal((len(joints), 3))
    more = world.seen(table, joints) + NOISE * noise
    sight = replace(one.sight, which=np.zeros(len(one.joints) + len(more), np.int64))
    return replace(
        one, joints=np.concatenate([one.joints, joints]), sight=sight, std=np.zeros(3),
        measured=np.concatenate([one.measured, more]),
    )  # fmt: skip


def test_what_is_suggested_tells_more_than_what_is_not(tmp_path: Path):
    """By fits with as many rows more, which know what was expected of them before."""
    world, rows = TwoArms(0, PLAIN), {"left": 12, "right": 30}
    setup = load_description(described_torso(tmp_path, world, rows, END))
    fit = fitted(setup)
    found = suggest_rows(fit, 6)
    tables = dict(zip(map(title, fit.given), rows, strict=True))

    def known(chosen: list[tuple[str, Array]]) -> float:
        more = [
            measured(world, table, one, np.array([q for name, q in chosen if name == table]))
            if any(name == table for name, _ in chosen) else one
            for table, one in zip(rows, fit.given, strict=True)
        ]  # fmt: skip
        return suggest_rows(fit_measurements(setup.arm, more, setup.sheet), 1).before["position"]

    best = known([(tables[row.measurement], row.joints) for row in found.rows])
    assert best == pytest.approx(found.rows[-1].after["position"], rel=0.1)
    rng = np.random.default_rng(0)
    for _ in range(5):
        picked = [("left", "right")[i] for i in rng.integers(2, size=6)]
        random = [(table, world.joints(table, 1)[0]) for table in picked]
        assert best < 0.97 * known(random) < 0.97 * found.before["position"]


def test_each_row_adds_to_what_is_known(found: SuggestedRows):
    spreads = [found.before, *(row.after for row in found.rows)]
    assert found.units == {"position": "m", "pixels": "px"}
    sums = [sum((s[c] / found.before[c]) ** 2 for c in found.before) for s in spreads]
    gains = -np.diff(sums)
    assert np.all(gains > 0.0)
    assert np.all(np.diff(gains) < 1e-9)
    # The hand of which a few rows were measured, not the one of which many were.
    seen = [row.measurement for row in found.rows]
    assert sum(name.startswith("left marker") for name in seen) > sum(
        name.startswith("right") for name in seen
    )
    assert len({tuple(row.joints) for row in found.rows}) == len(found.rows)


def test_rows_count_by_what_is_stated_and_what_was_found(tmp_path: Path):
    """Noise of both kinds; a row of a t of v degrees says (v + d) / (v + d + 2) of a normal one."""
    _, fit = of_case("pixels of a board, eye in hand", tmp_path)
    one = replace(fit.given[0], std=np.array([0.2, 0.4]))
    points, joints = np.arange(20), one.joints[[0, 30]]
    slopes = _Slopes(fit)
    A = slopes.told(one, joints, points, None)
    # All that a picture tells through a known lens is where the board is.
    assert A.shape[:2] == (2, 6)
    variance = np.array([0.2, 0.4]) ** 2 + fit.noise["pixels"] ** 2
    for told, at in zip(A, joints, strict=True):
        B = slopes.of(one, np.tile(at, (20, 1)), points, None) / np.sqrt(variance)[:, np.newaxis]
        flat = B.reshape(-1, B.shape[-1])
        np.testing.assert_allclose(told.T @ told, 7.0 / 9.0 * flat.T @ flat, atol=1e-4)


def test_fewer_are_the_first_of_more(found: SuggestedRows, torso: Description, fit: MixedFit):
    fewer = suggest_rows(fit, 2, sizes=torso.sizes)
    for one, other in zip(fewer.rows, found.rows[:2], strict=True):
        assert one.measurement == other.measurement
        np.testing.assert_array_equal(one.joints, other.joints)


def test_what_is_worth_is_what_is_taken_off():
    rng = np.random.default_rng(1)
    B, A = rng.normal(size=(20, 3, 8)), rng.normal(size=(5, 2, 8))
    spread, flat = _Spread({"a": B}), B.reshape(-1, 8)
    spread.take(A[0])
    for one, worth in zip(A, spread.worth(A), strict=True):
        sums = [
            np.trace(flat @ np.linalg.solve(np.eye(8) + J.T @ J, flat.T)) / np.sum(flat**2)
            for J in (A[0], np.concatenate([A[0], one]))
        ]
        assert worth == pytest.approx(sums[0] - sums[1])
    size = np.sqrt(np.trace(flat @ np.linalg.solve(np.eye(8) + A[0].T @ A[0], flat.T)) / 20)
    assert spread.by_channel()["a"] == pytest.approx(size)


def test_the_same_is_not_taken_twice():
    rows = 1e-3 * np.array([[[1.0, 0.0]], [[0.5, 0.0]], [[0.0, 0.2]]])
    offer = _Offer("wire", ("a",), np.arange(3.0)[:, np.newaxis], None, rows)
    spread = _Spread({"distance": np.random.default_rng(3).normal(size=(50, 1, 2))})
    taken = [float(spread.take_best([offer]).joints[0]) for _ in range(3)]
    assert taken == [0.0, 1.0, 2.0]


def test_channels_count_by_what_is_known_of_them():
    """So that their units do not matter."""
    rng = np.random.default_rng(2)
    B, C, A = rng.normal(size=(9, 1, 6)), rng.normal(size=(9, 2, 6)), rng.normal(size=(4, 1, 6))
    worth = [_Spread({"m": B, "px": C * scale}).worth(A) for scale in (1.0, 1e4)]
    np.testing.assert_allclose(worth[0], worth[1])


@pytest.mark.parametrize(
    "case", ["poses, eye in hand", "the stereo head", "a draw-wire and a ball bar"]
)
def test_slopes_are_those_of_what_is_measured(case: str, tmp_path: Path):
    _, fit = of_case(case, tmp_path)
    one, x = fit.given[0], fit.posterior.x
    joints = one.joints[:4] + 0.1
    pan = one.pointing[:4] if isinstance(one, StereoSightings) else None
    which = np.zeros(4, np.int64)
    some = replace(
        one.only(np.arange(4)),
        joints=joints,
        sight=replace(one.sight, which=which),
        std=np.zeros(1),
    )

    def missed(x: Array) -> Array:
        flanges = fit.problem.flanges(x, joints, one.link, one.base)
        return some.equations(flanges, fit.problem.own(one, x)).residuals

    if isinstance(some, PoseSightings):
        flanges = fit.flanges(joints, one.link, one.base)
        some = replace(some, measured=some.poses(flanges, fit.problem.own(one, x)))
    steps = 1e-5 * np.diag(fit.problem.tolerance)
    J = np.stack([(missed(x + d) - missed(x - d)) / 2e-5 for d in steps], axis=-1)
    # Covariances of all that is measured, and how far that is from what a row says.
    B = _Slopes(fit).of(one, joints, which, pan).reshape(-1, len(x))
    scaled = fit.covariance / np.outer(fit.problem.tolerance, fit.problem.tolerance)
    flat = J.reshape(-1, len(x))
    spread = flat @ scaled @ flat.T
    assert np.abs(B @ B.T - spread).max() < 1e-4 * spread.max()


def test_poses_keep_limits_and_where_the_joints_were(found: SuggestedRows, fit: MixedFit):
    by_title = {title(one): one for one in fit.given}
    for row in found.rows:
        one = by_title[row.measurement]
        arm = fit.problem.arm.between(one.link, one.base)
        assert row.joint_names == arm.joint_names
        assert np.all((row.joints >= arm.lower) & (row.joints <= arm.upper))
        assert np.all(
            (row.joints >= one.joints.min(axis=0)) & (row.joints <= one.joints.max(axis=0))
        )


@pytest.mark.parametrize(
    "case",
    ["points touched again", "points at known distances", "a plane", "a gauge above a plane"],
)
def test_what_must_be_touched_leaves_no_poses_to_choose(case: str, tmp_path: Path):
    _, fit = of_case(case, tmp_path)
    with pytest.raises(InvalidInput, match=r"no poses to choose:\n  pin by (cones|table): what is"):
        suggest_rows(fit, 1)


def test_a_bar_is_left_out_and_named(tmp_path: Path):
    _, fit = of_case("a draw-wire and a ball bar", tmp_path)
    found = suggest_rows(fit, 3)
    assert {row.measurement for row in found.rows} == {"wire"}
    assert set(found.before) == {"distance of wire"}
    assert found.left == ("bar: its distance is always the same, and says where the arm must be",)


def test_what_cannot_be_is_refused(fit: MixedFit, torso: Description):
    with pytest.raises(InvalidInput, match="n must be"):
        suggest_rows(fit, 0)
    with pytest.raises(InvalidInput, match=r"nothing that is seen has a front: leave out facing"):
        suggest_rows(fit, 1, view=View(facing=1.0), sizes=torso.sizes)
    with pytest.raises(
        InvalidInput, match=r"left marker by tracker: none of 10000 poses .*--wider"
    ):
        suggest_rows(fit, 1, view=View(near=50.0))
    with pytest.raises(InvalidInput, match=r"look along their z axes$"):
        FreePoses(fit, fit.measurements[0], View(near=50.0), {}).draw(
            5, np.random.default_rng(0), wider=True
        )
