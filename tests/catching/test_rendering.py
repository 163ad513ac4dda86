import gymnasium
import numpy as np
import pytest

from handeye.catching.environment import ID, CatchEnv, CatchVectorEnv
from handeye.catching.environment.rendering import WIDTH, Picture
from handeye.catching.layout import Layout
from handeye.catching.state import CAUGHT, FLYING
from handeye.catching.throws import draw_throws
from handeye.catching.world import World

HEAVY_COLOUR, CUP_COLOUR = (180, 80, 14), (18, 99, 163)


def place_of(frame, colour):
    """Mean row and column of the pixels of a colour."""
    near = np.abs(frame.astype(int) - colour).max(axis=-1) <= 6
    assert near.any()
    return np.argwhere(near).mean(axis=0)


def state_with(**fields):
    state = World().start(draw_throws(1, np.random.default_rng(0), balls=(1,)))
    return state._replace(**{name: np.array([value]) for name, value in fields.items()})


def test_ball_and_cup_are_drawn_where_they_are() -> None:
    picture = Picture()
    layout = Layout()
    scale = WIDTH / (layout.arm_travel[1] + 0.3 - (layout.launch_x[0] - 0.3))
    first = picture.draw(state_with(x=0.8, z=0.9, arm_x=1.9), 0)
    moved = picture.draw(state_with(x=1.1, z=1.1, arm_x=1.7), 0)
    assert first.shape == moved.shape
    assert first.shape[1:] == (WIDTH, 3)
    assert first.dtype == np.uint8
    ball = place_of(moved, HEAVY_COLOUR) - place_of(first, HEAVY_COLOUR)
    np.testing.assert_allclose(ball, [-0.2 * scale, 0.3 * scale], atol=1.0)
    cup = place_of(moved, CUP_COLOUR) - place_of(first, CUP_COLOUR)
    np.testing.assert_allclose(cup, [0.0, -0.2 * scale], atol=1.0)


def test_the_picture_says_what_became_of_the_ball() -> None:
    picture = Picture()
    flying = picture.draw(state_with(outcome=FLYING), 0)
    caught = picture.draw(state_with(outcome=CAUGHT), 0)
    rows, columns = np.nonzero((flying != caught).any(axis=-1))
    assert rows.size
    assert rows.max() < 60
    assert columns.min() > WIDTH // 2


def test_the_ball_leaves_a_trail_that_is_forgotten_with_a_new_throw() -> None:
    picture = Picture()
    now = state_with(x=1.5, z=1.0)
    clean = picture.draw(now, 0)
    for x in np.linspace(0.2, 1.4, 20):
        picture.see(state_with(x=x, z=1.0))
    trailed = picture.draw(now, 0)
    assert (clean != trailed).any(axis=-1).sum() > 100
    picture.forget(np.array([True]))
    np.testing.assert_array_equal(picture.draw(now, 0), clean)


def test_render_modes() -> None:
    silent = CatchEnv()
    silent.reset(seed=0)
    assert silent.render() is None
    env = gymnasium.make(ID, render_mode="rgb_array")
    assert env.metadata["render_fps"] == 40
    assert CatchEnv(render_mode="rgb_array").render() is None  # nothing is there yet
    env.reset(seed=0)
    before = np.asarray(env.render())
    env.step(np.ones(1, np.float32))
    after = np.asarray(env.render())
    assert before.shape == after.shape
    assert not np.array_equal(before, after)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_vector_renders_each_as_a_single_one_does(mode) -> None:
    assert CatchVectorEnv(1).render() is None
    many = CatchVectorEnv(2, render_mode="rgb_array", max_episode_steps=3, autoreset_mode=mode)
    single = CatchEnv(render_mode="rgb_array")
    single.reset(seed=4)
    many.reset(seed=4)
    for _ in range(2):
        single.step(np.ones(1, np.float32))
        many.step(np.ones((2, 1), np.float32))
    frames = many.render() or ()
    assert len(frames) == 2
    np.testing.assert_array_equal(frames[0], single.render())
    # Trails end with the episode: at the third step or the fourth.
    many.step(np.ones((2, 1), np.float32))
    many.step(np.ones((2, 1), np.float32))
    assert [len(trail) for trail in many._picture._trails] == [1 + (mode == "SameStep")] * 2
