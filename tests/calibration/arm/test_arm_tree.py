"""Several chains through one robot: every joint has one set of unknowns, passed either way."""

from functools import cache

import numpy as np
import pytest
from tests.robots.made import TORSO

from handeye.arrays import Array
from handeye.calibration.arm.measurements import PointSightings
from handeye.calibration.arm.problem import ArmProblem
from handeye.calibration.arm.sheet import ArmSheet, ChosenTerms, CurveTerms
from handeye.calibration.arm.tree import OWN_FRAMES, JointTree, Seen, TreeChain
from handeye.geometry import invert, make_pose
from handeye.robots.urdf import UrdfArm

SHEET = ArmSheet(curves=CurveTerms(2, 1))
LEFT, HEAD, BOTH = ("left_hand", "base"), ("camera", "base"), ("left_hand", "camera")


@cache
def torso() -> UrdfArm:
    return UrdfArm.from_text(TORSO, "left_hand", "torso")


def between(ends: tuple[str, str]) -> UrdfArm:
    return torso().between(*ends)


def tree(*ends: tuple[str, str], terms: CurveTerms | ChosenTerms = SHEET.curves) -> JointTree:
    rng = np.random.default_rng(1)
    arms = [between(one) for one in ends]
    seen = [Seen(arm, rng.uniform(-2.0, 2.0, (50, len(arm.joint_names)))) for arm in arms]
    return JointTree(seen, terms, compliant=True)


def errors(one: JointTree, seed: int = 0) -> Array:
    tolerance = SHEET.tolerances(one.kernel)[OWN_FRAMES:]
    return tolerance * np.random.default_rng(seed).standard_normal(len(tolerance))


def poses(one: JointTree, ends: tuple[str, str], x: Array, at: dict[str, float]) -> Array:
    """T_base_link (4, 4), read backwards or not, with joints at named angles."""
    chain = TreeChain(between(ends), one)
    q = np.array([[at[name] for name in chain.arm.joint_names]])
    return chain.poses(x, chain.rows(q))[0]


def somewhere(seed: int = 2) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    names = {
        name for ends in (HEAD, LEFT, ("right_hand", "base")) for name in between(ends).joint_names
    }
    return {name: float(rng.uniform(-1.5, 1.5)) for name in sorted(names)}


@pytest.mark.parametrize("ends", [LEFT, BOTH, ("base", "left_hand"), ("camera", "torso")])
def test_without_errors_poses_are_those_of_the_robot(ends: tuple[str, str]):
    one = tree(ends)
    chain = TreeChain(between(ends), one)
    q = np.random.default_rng(3).uniform(-1.5, 1.5, (4, len(chain.arm.joint_names)))
    still = np.zeros(len(errors(one)))
    np.testing.assert_allclose(chain.poses(still, chain.rows(q)), chain.arm.poses(q), atol=1e-12)


@pytest.mark.parametrize("ends", [LEFT, BOTH, ("left_hand", "right_hand"), ("left_c", "head")])
def test_a_chain_read_backwards_is_the_inverse_with_the_same_unknowns(ends: tuple[str, str]):
    one, at = tree(ends), somewhere()
    x = errors(one)
    there, back = poses(one, ends, x, at), poses(one, (ends[1], ends[0]), x, at)
    np.testing.assert_allclose(back, invert(there), atol=1e-12)
    assert np.abs(there - poses(one, ends, 0.0 * x, at)).max() > 1e-3


def test_what_two_chains_share_moves_both_alike():
    one, at = tree(LEFT, HEAD, BOTH), somewhere()
    x = errors(one)
    apart = invert(poses(one, HEAD, x, at)) @ poses(one, LEFT, x, at)
    np.testing.assert_allclose(poses(one, BOTH, x, at), apart, atol=1e-12)
    assert one.names == ("lift", "left_1", "left_2", "left_3", "left_4", "left_5", "pan", "tilt")
    assert len(x) == len(errors(tree(LEFT, HEAD)))


@pytest.mark.parametrize("ends", [LEFT, BOTH, BOTH[::-1], ("left_hand", "right_hand")])
def test_slopes_are_derivatives_in_axes_of_the_base(ends: tuple[str, str]):
    one = tree(("right_hand", "base"), BOTH)
    chain = TreeChain(between(ends), one)
    rows = chain.rows(np.random.default_rng(5).uniform(-1.5, 1.5, (2, len(chain.arm.joint_names))))
    x = errors(one)
    slopes = np.zeros((2, 6, len(x)))
    slopes[:, :, chain.places] = chain.slopes(x, rows)
    R = chain.poses(x, rows)[:, :3, :3]
    for i in range(len(x)):
        h = np.zeros(len(x))
        h[i] = 1e-6
        D = (chain.poses(x + h, rows) - chain.poses(x - h, rows)) / 2e-6
        spin = D[:, :3, :3] @ R.swapaxes(1, 2)
        turn = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
        np.testing.assert_allclose(slopes[:, :3, i], D[:, :3, 3], atol=1e-7)
        np.testing.assert_allclose(slopes[:, 3:, i], turn, atol=1e-7)


def test_joints_that_no_chain_passed_have_no_errors():
    one, at = tree(LEFT), somewhere()
    x = errors(one)
    chain = TreeChain(between(BOTH), one)
    assert len(chain.places) == len(set(chain.places.tolist())) < len(x)
    # From the torso the head is where the file has it.
    expected = invert(poses(one, ("camera", "torso"), x, at)) @ poses(
        one, ("left_hand", "torso"), x, at
    )
    np.testing.assert_allclose(poses(one, BOTH, x, at), expected, atol=1e-12)
    head = between(("camera", "torso"))
    nominal = head.poses([[at[name] for name in head.joint_names]])[0]
    np.testing.assert_allclose(poses(one, ("camera", "torso"), x, at), nominal, atol=1e-12)


def test_curves_keep_the_value_of_the_edge_beyond_what_was_seen():
    arm = between(("left_hand", "left_c"))  # left_4 and left_5, both turn
    turns = ChosenTerms.of(np.array([(1, 5, 1), (1, 5, 2)]))
    one = JointTree([Seen(arm, np.array([[0.1, -0.3], [0.4, 0.7]]))], turns, compliant=False)
    assert (one.kernel.low.tolist(), one.kernel.high.tolist()) == ([0.1, -0.3], [0.4, 0.7])
    x = np.concatenate([np.zeros(14), [2e-3, -1e-3, 5e-4, 3e-3]])
    chain = TreeChain(arm, one)

    def curve(q: float) -> float:
        return float(x[14:] @ [np.cos(q), np.sin(q), np.cos(2.0 * q), np.sin(2.0 * q)])

    for q, held in ((-2.0, -0.3), (0.2, 0.2), (1.9, 0.7)):
        there = arm.poses([[0.2, q + curve(held)]])
        np.testing.assert_allclose(chain.poses(x, np.array([[0.2, q]])), there, atol=1e-12)
    given = ChosenTerms.of(np.array([(1, 5, 1)]), np.array([[-1.0, -1.0], [1.0, 1.0]]))
    stated = JointTree([Seen(arm, np.zeros((1, 2)))], given, compliant=False)
    assert stated.kernel.high.tolist() == [1.0, 1.0]


def test_loads_bend_joints_above_and_below_the_fork():
    one, at = tree(BOTH), somewhere()
    x = 0.0 * errors(one)
    places = np.arange(len(one.names)) * 8 + 7
    x[places] = 1e-3
    chain = TreeChain(between(BOTH), one)
    q = np.array([[at[name] for name in chain.arm.joint_names]])
    bent = q + 1e-3 * chain.arm.loads(q)
    there = chain.poses(x, chain.rows(q))
    np.testing.assert_allclose(there, chain.arm.poses(bent), atol=1e-12)
    assert np.abs(there - chain.arm.poses(q)).max() > 1e-3
    np.testing.assert_array_equal(make_pose(there[0, :3, :3], there[0, :3, 3]), there[0])


def test_numbers_show_curves_of_the_joints_between_their_links_alone():
    """360 numbers of six joints show 10 harmonics of each, and 36 of five others only one."""
    rng = np.random.default_rng(6)
    some: list[PointSightings] = []
    for ends, n in ((LEFT, 120), (("right_hand", "torso"), 12)):
        arm = between(ends)
        q = rng.uniform(-1.0, 1.0, (n, len(arm.joint_names)))
        A = arm.poses(q)
        one = PointSightings.start(q, A, A[:, :3, 3], sensor=arm.base, target=arm.tip)
        some.append(one.along(arm))
    problem = ArmProblem(torso(), some, SHEET, CurveTerms(12, 0))
    joints = problem.tree.kernel.terms[:, 0]
    shown = problem.shown[: problem.n_arm][-2 * len(joints) :: 2]
    assert [int(shown[joints == j].sum()) for j in range(11)] == [10] * 6 + [1] * 5
