import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from handeye.catching.environment import ID, LONGEST, CatchEnv, CatchTask
from handeye.catching.environment.task import SENSES, replaced
from handeye.catching.layout import Cup, Layout
from handeye.catching.play import play
from handeye.catching.throws import draw_throws
from handeye.catching.world import Sensed
from handeye.errors import InvalidInput


def to_crossing(arm_x, arm_v, crossing_x):
    """A voltage that brings the arm there."""
    return np.clip(1.5 * (crossing_x - arm_x) - 0.3 * arm_v, -1.0, 1.0)


class ToCrossing:
    """The same as a controller, at the precision of an observation."""

    def __init__(self, throws) -> None:
        self.crossing_x = throws.crossing_x

    def begin(self, n: int) -> None:
        assert n == len(self.crossing_x)

    def act(self, sensed: Sensed):
        x, v = (np.float32(each).astype(float) for each in (sensed.arm_x, sensed.arm_v))
        return np.float32(to_crossing(x, v, self.crossing_x)).astype(float)

    def traces(self):
        return {}


def run(env: CatchEnv, seed: int | None, act):
    """One episode: observations, rewards, terminated, the last info."""
    observation, info = env.reset(seed=seed)
    assert info == {"is_success": False}
    observations, rewards, terminated = [observation], [], False
    while not terminated and len(rewards) < 200:
        observation, reward, terminated, truncated, info = env.step(act(env, observation))
        assert not truncated
        observations.append(observation)
        rewards.append(reward)
    return np.array(observations), np.array(rewards), terminated, info


def well(env, observation):
    crossing_x = env.unwrapped.throws.crossing_x[0]
    return np.array([to_crossing(observation[4], observation[5], crossing_x)], np.float32)


def nothing(env, observation):  # noqa: ARG001
    return np.zeros(1, np.float32)


@pytest.mark.parametrize("name", [ID, f"handeye.catching.environment:{ID}"])
def test_gymnasium_makes_it_and_finds_nothing_to_complain_of(name: str) -> None:
    env = gymnasium.make(name, render_mode="rgb_array")
    assert env.spec is not None
    assert env.spec.max_episode_steps == LONGEST
    check_env(env.unwrapped)


def test_stable_baselines3_finds_nothing_to_complain_of() -> None:
    checker = pytest.importorskip(
        "stable_baselines3.common.env_checker", reason="Stable-Baselines3 is not installed"
    )
    checker.check_env(gymnasium.make(ID).unwrapped)
    checker.check_env(gymnasium.make(ID, shaping=1.0, observe_identities=True))


def test_it_is_known_by_name_without_an_import() -> None:
    code = f"import gymnasium; gymnasium.make('handeye.catching.environment:{ID}').reset()"
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True, timeout=120)


def test_spaces_are_finite_and_float32() -> None:
    for task, size in ((CatchTask(), 7), (CatchTask(observe_identities=True), 9)):
        for space in (task.observation_space, task.action_space):
            assert space.dtype == np.float32
            assert np.isfinite(space.low).all()
            assert np.isfinite(space.high).all()
        assert task.observation_space.shape == (size,)
        assert task.action_space.shape == (1,)
        assert task.action_space.low == -1.0


@pytest.mark.parametrize("identities", [False, True])
def test_observed_is_what_eye_and_arm_report(identities: bool) -> None:
    env = CatchEnv(observe_identities=identities)
    rng = np.random.default_rng(0)
    for seed in range(5):
        env.reset(seed=seed)
        for _ in range(20):
            observation = env.step(rng.uniform(-1.0, 1.0, 1).astype(np.float32))[0]
            sensed = env.task.world.sense(env.state)
            expected = [getattr(sensed, name)[0] for name in SENSES]
            if identities:
                expected += [env.throws.ball[0], env.throws.arm[0]]
            np.testing.assert_array_equal(observation, np.array(expected, np.float32))
            assert env.observation_space.contains(observation)


def test_episodes_end_as_the_same_throws_played_by_a_controller() -> None:
    env = CatchEnv(layout=Layout())
    ends, throws = [], []
    for seed in range(25):
        _, _, terminated, info = run(env, seed, well)
        assert terminated
        ends.append(info["is_success"])
        throws.append(env.throws)
        drawn = draw_throws(1, np.random.default_rng(seed))
        for name in ("ball", "arm", "arm_x", "vx", "vz", "crossing_x"):
            assert getattr(drawn, name) == getattr(env.throws, name)
    played = [play(env.task.world, each, ToCrossing(each)).caught[0] for each in throws]
    assert ends == played
    assert sum(ends) > 15


def test_the_reward_is_one_for_a_catch_and_shaping_adds_up_to_the_way_made_good() -> None:
    for act, lucky in ((well, True), (nothing, False)):
        wins = []
        for seed in range(12):
            _, rewards, _, info = run(CatchEnv(), seed, act)
            caught = info["is_success"]
            assert rewards.tolist() == [0.0] * (len(rewards) - 1) + [float(caught)]
            env = CatchEnv(shaping=0.7)
            observations, shaped, _, _ = run(env, seed, act)
            crossing_x = env.throws.crossing_x[0]
            first, last = np.abs(observations[[0, -1], 4] - crossing_x)
            assert shaped.sum() == pytest.approx(caught + 0.7 * (first - last), abs=1e-5)
            wins.append(caught)
        assert any(wins) if lucky else not all(wins)


def test_a_catch_is_paid_once() -> None:
    env = CatchEnv()
    for seed in range(20):
        info = run(env, seed, well)[3]
        if info["is_success"]:
            assert env.step(np.zeros(1, np.float32))[1:3] == (0.0, True)
            return
    pytest.fail("nothing was caught")


def test_a_seed_fixes_everything_and_resets_go_on_from_it() -> None:
    def throws(env):
        first = run(env, 7, nothing)[0]
        return first, run(env, None, nothing)[0]

    a, b = throws(CatchEnv()), throws(CatchEnv())
    for left, right in zip(a, b, strict=True):
        np.testing.assert_array_equal(left, right)
    assert not np.array_equal(a[0][0], a[1][0])


def test_identities_can_be_chosen() -> None:
    env = CatchEnv(balls=(1,), arms=[0], observe_identities=True)
    for seed in range(5):
        assert env.reset(seed=seed)[0][-2:].tolist() == [1.0, 0.0]


def test_gymnasium_truncates_what_takes_too_long() -> None:
    env = gymnasium.make(ID, max_episode_steps=10)
    env.reset(seed=0)
    ends = [env.step(np.zeros(1, np.float32))[2:4] for _ in range(10)]
    assert ends == [(False, False)] * 9 + [(False, True)]


def test_actions_are_cut_off_at_the_bounds_and_bad_ones_change_nothing() -> None:
    one, other = CatchEnv(), CatchEnv()
    one.reset(seed=1)
    other.reset(seed=1)
    np.testing.assert_array_equal(
        one.step(np.array([5.0], np.float32))[0], other.step(np.array([1.0], np.float32))[0]
    )
    before = one.state
    for bad in ([np.nan], [0.1, 0.2], [], ["left"]):
        with pytest.raises(InvalidInput, match="action"):
            one.step(np.array(bad))
        assert one.state is before


def test_what_the_eye_does_not_see_reads_zero_and_the_rest_is_cut_off() -> None:
    task = CatchTask()
    throws = task.draw(2, np.random.default_rng(0))
    values = {name: np.array([1e9, -1e9]) for name in SENSES}
    values["ball_x"] = np.array([np.nan, 0.25])
    seen = task.observe(Sensed(**values, time=np.zeros(2), active=np.ones(2, bool)), throws)
    space = task.observation_space
    np.testing.assert_array_equal(seen[0], [0.0, *space.high[1:]])
    np.testing.assert_array_equal(seen[1], [0.25, *space.low[1:]])


def test_replaced_throws() -> None:
    old, fresh = (draw_throws(n, np.random.default_rng(n)) for n in (4, 2))
    which = np.array([False, True, False, True])
    mixed = replaced(old, which, fresh)
    np.testing.assert_array_equal(mixed.vx[which], fresh.vx)
    np.testing.assert_array_equal(mixed.vx[~which], old.vx[~which])
    assert not np.array_equal(mixed.vx, old.vx)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"render_mode": "human"}, "render_mode"),
        ({"balls": ()}, "balls"),
        ({"arms": (2,)}, "arms"),
        ({"shaping": -1.0}, "shaping"),
        ({"layout": Layout(cup=Cup(width=0.3))}, "cup"),
    ],
)
def test_bad_settings_are_refused_when_it_is_made(options, message) -> None:
    with pytest.raises(InvalidInput, match=message):
        CatchEnv(**options)


def test_step_needs_a_reset() -> None:
    with pytest.raises(InvalidInput, match="reset"):
        CatchEnv().step(np.zeros(1, np.float32))
