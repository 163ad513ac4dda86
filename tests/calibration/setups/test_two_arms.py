"""Two arms and a head that looks at them: chains of one robot, fitted together."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.setups.two_arms import (
    APART,
    CHAINS,
    SHEET,
    TOGETHER,
    TwoArms,
    chains,
    described_torso,
    torso,
)

from handeye.arrays import Array
from handeye.calibration.arm.sheet import ArmSheet, CurveTerms
from handeye.calibration.exporting import calibrated_joints_yaml, calibrated_urdf, hand_eyes
from handeye.calibration.setups.commands import SetupCommands
from handeye.calibration.setups.description import Description, load_description
from handeye.calibration.setups.fit import MixedFit, fit_measurements
from handeye.calibration.setups.knowledge import of_arm, parts_of, undetermined_of
from handeye.calibration.setups.run import calibrate_setup
from handeye.calibration.setups.storage import load_setup, save_setup
from handeye.cli.setup_results import as_data
from handeye.errors import InvalidInput
from handeye.geometry import invert, transform
from handeye.observations import PointTarget
from handeye.reports.setup import setup_page
from handeye.robots.urdf import UrdfArm

PLAIN = ArmSheet(compliance=0.0, curves=CurveTerms(0, 0))
END = "arm: {compliance: 0}\ncurves: {own: 0, others: 0}\n"
ROWS = dict.fromkeys(TOGETHER, 30)


@pytest.fixture(scope="module")
def world() -> TwoArms:
    return TwoArms(0, PLAIN)


@pytest.fixture(scope="module")
def described(world: TwoArms, tmp_path_factory: pytest.TempPathFactory) -> Description:
    folder = tmp_path_factory.mktemp("torso")
    return load_description(described_torso(folder, world, ROWS, END))


@pytest.fixture(scope="module")
def fit(described: Description) -> MixedFit:
    return fit_measurements(described.arm, described.measurements, described.sheet)


def missed(world: TwoArms, fit: MixedFit, table: str, n: int = 100) -> float:
    """Mean distance [m] at fresh postures of where a marker should be seen from where it is."""
    link, base = CHAINS[table]
    one = next(one for one in fit.measurements if (one.link, one.base) == (link, base))
    q = world.joints(table, n)
    there = transform(fit.flanges(q, link, base), one.sight.points.reference[0])
    seen = transform(invert(one.sight.sensor.reference), there)
    return float(np.linalg.norm(seen - world.seen(table, q), axis=1).mean())


def test_every_measurement_is_between_its_own_links(described: Description):
    for table, one in zip(TOGETHER, described.measurements, strict=True):
        assert (one.link, one.base) == CHAINS[table]
        assert one.joints.shape == (30, len(chains()[table].joint_names))
    assert described.arm.tip == "left_hand"


def test_all_chains_are_found_together(world: TwoArms, fit: MixedFit):
    for table in TOGETHER:
        assert missed(world, fit, table) < 1.5e-4, table
    names, *_ = fit.of_arm()
    assert fit.problem.tree.names[:2] == ("lift", "left_1")
    assert len(names) == len(set(names)) == 7 * 13
    # All of it as sure as is said: chi-square of so many degrees, along every direction.
    assert world.tree.names == fit.problem.tree.names
    off = fit.posterior.x[: len(world.x)] - world.x
    C = fit.covariance[: len(off), : len(off)]
    assert 0.6 * len(off) < off @ np.linalg.solve(C, off) < 1.5 * len(off)


def test_the_elbow_tells_of_the_arm_what_the_hand_does_not(world: TwoArms, described: Description):
    """A joint that two chains pass is better known than from either."""
    some = described.measurements
    left, both = (
        fit_measurements(described.arm, these, described.sheet) for these in (some[:1], some[:3:2])
    )
    zero = [list(one.of_arm()[0]).index("left_2 turn x") for one in (left, both)]
    stds = [np.sqrt(one.covariance[i, i]) for one, i in zip((left, both), zero, strict=True)]
    assert stds[1] < 0.8 * stds[0]
    assert both.problem.tree.names == left.problem.tree.names
    assert missed(world, left, "left") < 3e-4


def test_arms_that_share_nothing_are_fitted_beside_each_other(world: TwoArms, tmp_path: Path):
    setup = load_description(described_torso(tmp_path, world, dict.fromkeys(APART, 40), END))
    both = fit_measurements(setup.arm, setup.measurements, setup.sheet)
    assert len(both.problem.tree.names) == 10
    for table, one in zip(APART, setup.measurements, strict=True):
        alone = fit_measurements(setup.arm, [one], setup.sheet)
        assert set(alone.problem.tree.names) < set(both.problem.tree.names)
        assert missed(world, alone, table) < 4e-4
        assert missed(world, both, table) < 4e-4
    at = [list(both.of_arm()[0]).index(f"{side}_2 zero") for side in ("left", "right")]
    assert abs(both.covariance[at[0], at[1]]) < 1e-9 * both.covariance[at[0], at[0]]


def test_what_was_found_is_told_of_every_joint(fit: MixedFit):
    joints = {name for arm in chains().values() for name in arm.stage_names}
    assert {one.name.split()[0] for one in of_arm(fit)} == joints
    parts = {one.part: one for one in parts_of(fit)}
    assert {f"encoder offset of joint {name}" for name in joints - {"lift"}} <= set(parts)
    assert parts["encoder offset of joint right_2"].known > 0.5
    assert "left_5 zero" in undetermined_of(fit)


def test_parts_move_the_rows_that_depend_on_them(fit: MixedFit):
    names, *_ = fit.of_arm()
    place, part = names.index("right_2 zero"), "encoder offset of joint right_2"
    (found,) = [one for one in parts_of(fit) if one.part == part]
    x, without = fit.posterior.x, fit.posterior.x.copy()
    without[place] = 0.0
    moved: list[Array] = []
    for one in (fit.measurements[1], fit.measurements[4]):
        c = np.append(one.sight.points.reference[0], 1.0)
        a, b = (fit.problem.flanges(v, one.joints, one.link, one.base) for v in (x, without))
        moved.append(((a - b) @ c)[:, :3])
    size = np.sqrt(np.mean(np.sum(np.concatenate(moved) ** 2, axis=1)))
    assert found.moves == pytest.approx(size, rel=0.02)


def test_the_urdf_has_all_joints_as_found(fit: MixedFit, world: TwoArms):
    text = calibrated_urdf(fit)
    scales = dict(zip(fit.corrected.names, fit.corrected.scales, strict=True))
    for table in TOGETHER:
        ends = CHAINS[table]
        made = UrdfArm.from_text(text, ends[0], "found", ends[1])
        q = world.joints(table, 5)
        read = q * [scales[name] for name in made.joint_names]
        np.testing.assert_allclose(made.poses(read), fit.flanges(q, *ends), atol=1e-9)
    assert calibrated_joints_yaml(fit).count("roll:") == 13


def test_a_set_up_of_several_chains_is_kept(fit: MixedFit, world: TwoArms, tmp_path: Path):
    save_setup(tmp_path / "a", fit)
    back = load_setup(tmp_path / "a").fit
    for table in TOGETHER:
        ends, q = CHAINS[table], world.joints(table, 5)
        np.testing.assert_array_equal(back.flanges(q, *ends), fit.flanges(q, *ends))
    np.testing.assert_array_equal(back.covariance, fit.covariance)
    named = hand_eyes(back)
    assert set(named) == {"tracker", "frame of eye"}
    assert "robot_base_frame: camera" in named["frame of eye"]
    assert "robot_base_frame: base" in named["tracker"]


def test_hands_are_brought_to_where_the_head_looks(world: TwoArms, fit: MixedFit):
    q = world.joints("sees right", 8)
    seen = world.seen("sees right", q)
    commands = SetupCommands(fit, "frame of eye", "right marker")
    assert commands.joint_names == chains()["sees right"].joint_names
    posture = q + np.array([0.0, 0.0, 0.02, 0.02, 0.02, 0.02, 0.02])
    joints = commands.command(PointTarget(seen, posture))
    np.testing.assert_array_equal(joints[:, :2], q[:, :2])
    assert np.linalg.norm(world.seen("sees right", joints) - seen, axis=1).max() < 3e-4
    # What nobody measured: the elbow, before the head.
    elbow = SetupCommands(fit, "frame of eye", "elbow marker")
    assert elbow.joint_names == ("tilt", "pan", "left_1", "left_2", "left_3")
    assert (SetupCommands(fit).sensor, SetupCommands(fit).marker) == ("tracker", "left marker")
    with pytest.raises(InvalidInput, match=r"torso cannot bring the marker to target 1 \(by"):
        commands.command(PointTarget(seen[:1] + 5.0, posture[:1]))


def test_a_page_shows_each_chain(described: Description):
    some = {name: getattr(described, name)[1:3] for name in ("measurements", "placed", "sources")}
    result = calibrate_setup(replace(described, **some))
    assert result.errors["position"].medians()[1] < 3e-4
    page = setup_page(result, "setup.yaml").html()
    for words in (
        "right marker, on right_hand", "tracker, on base", "tracker saw elbow marker",
        "Of right_hand from base: a slope", "Of left_c from base: a slope",
    ):  # fmt: skip
        assert words in page, words
    seats = {"tracker": "base", "right marker": "right_hand", "elbow marker": "left_c"}
    assert result.carried_by == as_data(result, "setup.yaml")["carried_by"] == seats


SLIPS = {
    "link: right_hand": (
        "link: right_hnd",
        r"4, measurements 2: link: torso has no link 'right_hnd': choose one of right_hand",
    ),
    "link: left_c, base: base": (
        "link: left_c, base: left_c",
        "5, measurements 3: link: torso: no joint moves the link 'left_c' against 'left_c'",
    ),
    "target: right marker": (
        "target: left marker",
        "left marker is fixed to left_hand in one measurement and to right_hand in another",
    ),
    "link: left_c": ("link: head", "lacks the columns pan_rad, tilt_rad"),
    "link: left_c, ": ("link: base, ", "no joint moves the link 'base' against 'base'"),
}


@pytest.mark.parametrize("before", SLIPS)
def test_slips_are_named(described: Description, world: TwoArms, tmp_path: Path, before: str):
    after, message = SLIPS[before]
    del described
    path = described_torso(tmp_path, world, ROWS, END)
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after), encoding="utf-8")
    with pytest.raises(InvalidInput, match=message):
        load_description(path)


def test_a_robot_needs_a_tip_unless_every_measurement_names_its_link(
    world: TwoArms, tmp_path: Path
):
    path = described_torso(tmp_path, world, {"elbow": 10, "left": 10}, END)
    text = path.read_text(encoding="utf-8")
    assert load_description(path).arm.tip == "left_c"
    path.write_text(text.replace("link: left_hand, ", ""), encoding="utf-8")
    with pytest.raises(InvalidInput, match="line 1, robot: torso: 2 chains of 6 moving joints"):
        load_description(path)
    path.write_text(text.replace("link: left_hand, ", "") + "tip: left_hand\n", encoding="utf-8")
    assert [one.link for one in load_description(path).measurements] == ["left_c", "left_hand"]


def test_joints_that_are_not_those_between_the_links_are_refused(described: Description):
    one = described.measurements[0]
    wrong = one.along(torso().between("right_hand", "camera"))
    with pytest.raises(InvalidInput, match="torso has 7 joints from camera to right_hand"):
        fit_measurements(torso(), [wrong], SHEET)
    with pytest.raises(InvalidInput, match="tracker is fixed to camera in one"):
        fit_measurements(torso(), [wrong, one], SHEET)
