import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from handeye.catching.environment import ID, LONGEST, CatchEnv, CatchVectorEnv
from handeye.catching.throws import draw_throws
from handeye.errors import InvalidInput

MODES = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP]


def equal(left, right) -> None:
    """Nested infos, arrays and objects are the same."""
    if isinstance(left, dict):
        assert left.keys() == right.keys()
        for key, value in left.items():
            equal(value, right[key])
    elif isinstance(left, np.ndarray) and left.dtype == object:
        for one, other in zip(left, right, strict=True):
            equal(one, other)
    else:
        np.testing.assert_array_equal(left, right)


@pytest.mark.parametrize("mode", MODES)
def test_one_of_it_is_what_gymnasium_makes_of_a_single_one(mode: AutoresetMode) -> None:
    def single():
        return gymnasium.wrappers.TimeLimit(CatchEnv(shaping=0.5, observe_identities=True), 44)

    sync = SyncVectorEnv([single], autoreset_mode=mode)
    ours = CatchVectorEnv(
        1, shaping=0.5, observe_identities=True, max_episode_steps=44, autoreset_mode=mode
    )
    assert ours.metadata["autoreset_mode"] is mode
    assert ours.observation_space == sync.observation_space
    assert ours.action_space == sync.action_space
    got = ours.reset(seed=5)
    for left, right in zip(got, sync.reset(seed=5), strict=True):
        equal(left, right)
    rng = np.random.default_rng(0)
    ends, caught = set(), 0
    for _ in range(700):
        # Towards the crossing, not always well.
        away = ours._throws.crossing_x - got[0][:, 4]
        push = 1.5 * away - 0.3 * got[0][:, 5] + rng.normal(0.0, 0.1)
        actions = np.clip(push, -1.0, 1.0).astype(np.float32)[:, np.newaxis]
        got, expected = ours.step(actions), sync.step(actions)
        for left, right in zip(got, expected, strict=True):
            equal(left, right)
            assert getattr(left, "dtype", None) == getattr(right, "dtype", None)
        ends.add((bool(got[2][0]), bool(got[3][0])))
        caught += bool(got[4].get("final_info", got[4])["is_success"][0])
    assert ends == {(False, False), (True, False), (False, True), (True, True)}
    assert caught


def test_each_of_many_is_what_a_single_one_would_be() -> None:
    n = 8
    many = CatchVectorEnv(n, shaping=1.0)
    seen, _ = many.reset(seed=3)
    throws = draw_throws(n, np.random.default_rng(3))
    singles = []
    for i in range(n):
        env = CatchEnv(shaping=1.0)
        env.reset(seed=0)
        env._begun = throws[i : i + 1], env.task.world.start(throws[i : i + 1])
        singles.append(env)
    np.testing.assert_array_equal(seen, [env._observed() for env in singles])
    rng = np.random.default_rng(1)
    going = np.ones(n, bool)
    while going.any():
        actions = rng.uniform(-1.0, 1.0, (n, 1)).astype(np.float32)
        seen, rewards, terminated, truncated, infos = many.step(actions)
        assert not truncated.any()
        for i in np.flatnonzero(going):
            one = singles[i].step(actions[i])
            np.testing.assert_array_equal(seen[i], one[0])
            assert rewards[i] == one[1]
            assert terminated[i] == one[2]
            assert infos["is_success"][i] == one[4]["is_success"]
        going &= ~terminated


def test_first_throws_are_those_of_one_environment_after_the_other() -> None:
    many, single = CatchVectorEnv(6), CatchEnv()
    starts = many.reset(seed=11)[0]
    np.testing.assert_array_equal(starts[0], single.reset(seed=11)[0])
    for start in starts[1:]:
        np.testing.assert_array_equal(start, single.reset()[0])


def test_next_step_ignores_the_action_pays_nothing_and_starts_anew() -> None:
    env = CatchVectorEnv(2, shaping=1.0, max_episode_steps=3)
    env.reset(seed=0)
    actions = np.ones((2, 1), np.float32)
    for _ in range(3):
        last = env.step(actions)
    assert last[3].all()
    seen, rewards, terminated, truncated, infos = env.step(actions)
    assert not rewards.any()
    assert not np.any([terminated, truncated])
    assert infos["_is_success"].all()
    assert (seen[:, 5] == 0.0).all()  # the arm is at rest
    assert not np.array_equal(seen, last[0])


def test_disabled_waits_for_a_mask() -> None:
    env = CatchVectorEnv(3, max_episode_steps=2, autoreset_mode="Disabled")
    mask = np.array([True, False, True])
    with pytest.raises(InvalidInput, match="first reset"):
        env.reset(options={"reset_mask": mask})
    env.reset(seed=0)
    actions = np.ones((3, 1), np.float32)
    env.step(actions)
    ended = env.step(actions)
    assert ended[3].all()
    with pytest.raises(InvalidInput, match="reset_mask"):
        env.step(actions)
    seen, infos = env.reset(options={"reset_mask": mask})
    np.testing.assert_array_equal(seen[1], ended[0][1])
    assert (seen[mask, 5] == 0.0).all()
    np.testing.assert_array_equal(infos["_is_success"], mask)
    env.reset(options={"reset_mask": ~mask})
    assert not env.step(actions)[3].any()


@pytest.mark.parametrize(
    "mask", [np.zeros(2, bool), np.ones(3, bool), np.array([1, 0])], ids=["none", "long", "int"]
)
def test_bad_masks_are_refused(mask) -> None:
    env = CatchVectorEnv(2)
    env.reset(seed=0)
    before = env._state
    with pytest.raises(InvalidInput, match="reset_mask"):
        env.reset(options={"reset_mask": mask})
    assert env._state is before


def test_gymnasium_makes_it_as_a_vector() -> None:
    env = gymnasium.make_vec(ID, num_envs=4, shaping=1.0).unwrapped
    assert isinstance(env, CatchVectorEnv)
    assert env.num_envs == 4
    assert env._longest == LONGEST
    seen, _ = env.reset(seed=0)
    assert seen.shape == (4, 7)
    assert seen.dtype == np.float32
    assert env.observation_space.contains(seen)
    env.close()


def test_results_are_not_reused() -> None:
    env = CatchVectorEnv(2)
    first, _ = env.reset(seed=0)
    kept = first.copy()
    results = env.step(np.ones((2, 1), np.float32))
    copies = [np.copy(each) for each in results[:4]]
    env.step(-np.ones((2, 1), np.float32))
    np.testing.assert_array_equal(first, kept)
    for result, copy in zip(results[:4], copies, strict=True):
        np.testing.assert_array_equal(result, copy)


def test_misuse_is_refused() -> None:
    with pytest.raises(InvalidInput, match="num_envs"):
        CatchVectorEnv(0)
    with pytest.raises(InvalidInput, match="max_episode_steps"):
        CatchVectorEnv(1, max_episode_steps=0)
    env = CatchVectorEnv(2)
    with pytest.raises(InvalidInput, match="reset"):
        env.step(np.zeros((2, 1), np.float32))
    env.reset(seed=0)
    for bad in (np.zeros(2), np.zeros((3, 1)), np.full((2, 1), np.inf)):
        with pytest.raises(InvalidInput, match="action"):
            env.step(bad.astype(np.float32))
