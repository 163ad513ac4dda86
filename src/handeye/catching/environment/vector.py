"""Many throws at once, as a Gymnasium vector environment: one call of the world for all."""

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from handeye.arrays import Array, Booleans, count
from handeye.catching.environment.rendering import Picture
from handeye.catching.environment.single import FRAMES_PER_SECOND, checked_mode
from handeye.catching.environment.task import CatchTask, Observations, replaced
from handeye.catching.layout import Layout
from handeye.errors import InvalidInput

Infos = dict[str, Any]


class CatchVectorEnv(VectorEnv[Observations, NDArray[np.float32], NDArray[Any]]):
    """`handeye/Catch-v0` by `gymnasium.make_vec`; the same task as `CatchEnv`, N throws at once.

    The first throws of N environments are those that one environment with the same seed would
    make one after the other.

    When an episode ends, the next one begins as the autoreset mode says: NEXT_STEP, at the next
    step, which ignores the action and pays nothing; SAME_STEP, at once, with the last observations
    in `infos["final_obs"]`; DISABLED, when `reset(options={"reset_mask": ...})` asks for it.

    Args:
        num_envs: throws at once.
        balls, arms, shaping, observe_identities, layout, render_mode: as in `CatchEnv`.
        max_episode_steps: ticks after which an episode is truncated; None: never.
        autoreset_mode: see above; the mode or its value.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": FRAMES_PER_SECOND,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        balls: Sequence[int] = (0, 1),
        arms: Sequence[int] = (0, 1),
        shaping: float = 0.0,
        observe_identities: bool = False,
        layout: Layout = Layout(),
        render_mode: str | None = None,
        max_episode_steps: int | None = 120,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
    ) -> None:
        self.num_envs = count(num_envs, "num_envs")
        self.task = CatchTask(tuple(balls), tuple(arms), shaping, observe_identities, layout)
        self.single_observation_space = self.task.observation_space
        self.single_action_space = self.task.action_space
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.render_mode = checked_mode(render_mode)
        self._longest = (
            np.inf if max_episode_steps is None else count(max_episode_steps, "max_episode_steps")
        )
        self._mode = AutoresetMode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self._mode}  # type: ignore[misc]
        self._state = None
        self._done = np.zeros(self.num_envs, np.bool_)
        self._picture = Picture(layout)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, Infos]:
        """Fresh throws, for all or where `options["reset_mask"]` (N,) is true."""
        super().reset(seed=seed)
        mask = np.asarray((options or {}).get("reset_mask", np.ones(self.num_envs, np.bool_)))
        if mask.dtype != np.bool_ or mask.shape != (self.num_envs,) or not mask.any():
            raise InvalidInput(f"reset_mask must be {self.num_envs} truth values, one of them true")
        if mask.all():
            self._throws = self.task.draw(self.num_envs, self.np_random)
            self._state = self.task.world.start(self._throws)
            self._done[:] = False
            self._picture.begin(self.num_envs)
            self._see()
        elif self._state is None:
            raise InvalidInput("the first reset must be of all environments")
        else:
            self._restart(mask)
        return self._observed(), self._infos(np.zeros(self.num_envs, np.bool_), mask)

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[Observations, Array, Booleans, Booleans, Infos]:
        """One tick of all: observations (N, d), rewards, terminated, truncated and infos."""
        if self._state is None:
            raise InvalidInput("call reset before step")
        commands = self.task.commands(actions, self.num_envs)
        resumed = self._done.copy()
        if resumed.any() and self._mode is AutoresetMode.DISABLED:
            raise InvalidInput("some episodes are over: reset them with a reset_mask")
        before, self._state = self._state, self.task.world.step(self._state, commands)
        reward = self.task.reward(before, self._state, self._throws)
        terminated = self.task.over(self._state)
        if resumed.any():
            self._restart(resumed)
            reward[resumed], terminated[resumed] = 0.0, False
        self._see()
        truncated = self._state.ticks >= self._longest
        self._done = terminated | truncated
        success = self.task.success(self._state)
        if self._mode is AutoresetMode.SAME_STEP and self._done.any():
            infos = self._begin_again(success)
        else:
            infos = self._infos(success, np.ones(self.num_envs, np.bool_))
        return self._observed(), reward, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:  # type: ignore[override]
        """The scenes now, each (height, width, 3), if the render mode is "rgb_array"."""
        if self.render_mode is None or self._state is None:
            return None
        return tuple(self._picture.draw(self._state, i) for i in range(self.num_envs))

    def _begin_again(self, success: Booleans) -> Infos:
        """Restart what is over; the infos of this step hold how that ended."""
        done, seen = self._done.copy(), self._observed()
        final = np.full(self.num_envs, None, dtype=object)
        for i in np.flatnonzero(done):
            final[i] = seen[i].copy()
        self._restart(done)
        self._see()
        return {
            **self._infos(success & ~done, np.ones(self.num_envs, np.bool_)),
            "final_obs": final,
            "_final_obs": done,
            "final_info": self._infos(success & done, done),
            "_final_info": done.copy(),
        }

    def _restart(self, which: Booleans) -> None:
        """Fresh throws in some environments."""
        assert self._state is not None
        fresh = self.task.draw(int(which.sum()), self.np_random)
        self._throws = replaced(self._throws, which, fresh)
        self._state = self.task.world.restart(self._state, which, fresh)
        self._done[which] = False
        self._picture.forget(which)

    def _see(self) -> None:
        if self.render_mode is not None and self._state is not None:
            self._picture.see(self._state)

    def _observed(self) -> Observations:
        assert self._state is not None
        return self.task.observe(self.task.world.sense(self._state), self._throws)

    @staticmethod
    def _infos(success: Booleans, present: Booleans) -> Infos:
        return {"is_success": success.copy(), "_is_success": present.copy()}
