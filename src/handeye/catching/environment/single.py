"""One throw at a time, as a Gymnasium environment."""

from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import NDArray

from handeye.catching.environment.rendering import Picture
from handeye.catching.environment.task import CatchTask, Observations
from handeye.catching.layout import Layout
from handeye.catching.state import State
from handeye.catching.throws import Throws
from handeye.errors import InvalidInput

FRAMES_PER_SECOND = 40


class CatchEnv(gymnasium.Env[NDArray[Any], NDArray[Any]]):
    """`handeye/Catch-v0`; see `CatchTask` for what is observed and rewarded.

    An episode terminates when the ball is caught, lies on the ground or is out of bounds;
    `info["is_success"]` says whether it was caught. `gymnasium.make` adds a limit of 3 s.
    `reset` has no options.

    Args:
        balls, arms: identities that are drawn from: 0 light, 1 heavy.
        shaping: reward for each metre towards where the ball will come down.
        observe_identities: whether the identities are observed.
        layout: where everything is.
        render_mode: None or "rgb_array".

    Raises:
        InvalidInput: an unknown render mode, or arguments that CatchTask refuses.
    """

    metadata: ClassVar[dict[str, Any]] = {  # pyright: ignore[reportIncompatibleVariableOverride]
        "render_modes": ["rgb_array"],
        "render_fps": FRAMES_PER_SECOND,
    }

    def __init__(
        self,
        *,
        balls: Sequence[int] = (0, 1),
        arms: Sequence[int] = (0, 1),
        shaping: float = 0.0,
        observe_identities: bool = False,
        layout: Layout = Layout(),
        render_mode: str | None = None,
    ) -> None:
        self.task = CatchTask(tuple(balls), tuple(arms), shaping, observe_identities, layout)
        self.observation_space = self.task.observation_space
        self.action_space = self.task.action_space
        self.render_mode = checked_mode(render_mode)
        self._begun: tuple[Throws, State] | None = None
        self._picture = Picture(layout)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """A fresh throw; the observation (d,) and info."""
        super().reset(seed=seed, options=options)
        throws = self.task.draw(1, self.np_random)
        self._begun = throws, self.task.world.start(throws)
        self._picture.begin(1)
        self._picture.see(self.state)
        return self._observed(), {"is_success": False}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observations, float, bool, bool, dict[str, Any]]:
        """One tick: observation (d,), reward, terminated, truncated (never here) and info."""
        throws, before = self.throws, self.state
        command = self.task.commands(np.reshape(action, (1, -1)), 1)
        after = self.task.world.step(before, command)
        self._begun = throws, after
        self._picture.see(after)
        reward = self.task.reward(before, after, throws)
        caught = bool(self.task.success(after)[0])
        over = bool(self.task.over(after)[0])
        return self._observed(), float(reward[0]), over, False, {"is_success": caught}

    def render(self) -> NDArray[np.uint8] | None:  # type: ignore[override]
        """The scene now, (height, width, 3), if the render mode is "rgb_array"."""
        if self.render_mode is None or self._begun is None:
            return None
        return self._picture.draw(self.state, 0)

    @property
    def throws(self) -> Throws:
        """The throw of this episode, one; never observed. InvalidInput before the first reset."""
        return self._now[0]

    @property
    def state(self) -> State:
        """Of the world, one trial. InvalidInput before the first reset."""
        return self._now[1]

    @property
    def _now(self) -> tuple[Throws, State]:
        if self._begun is None:
            raise InvalidInput("call reset first")
        return self._begun

    def _observed(self) -> Observations:
        return self.task.observe(self.task.world.sense(self.state), self.throws)[0]


def checked_mode(render_mode: str | None) -> str | None:
    """The render mode, or InvalidInput."""
    if render_mode not in {None, "rgb_array"}:
        raise InvalidInput(f'render_mode must be None or "rgb_array", got {render_mode!r}')
    return render_mode
