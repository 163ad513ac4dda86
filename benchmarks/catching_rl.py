"""Reinforcement learning for benchmarks/catching.py: SAC and PPO of Stable-Baselines3."""
# ruff: noqa: D102 (the methods of Batch are those of VecEnv, those of Policy those of Controller)

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecEnv

from handeye.catching.environment import LONGEST, CatchTask, CatchVectorEnv
from handeye.catching.play import play
from handeye.catching.throws import Throws
from handeye.catching.world import Sensed

Test = Callable[[Any, int, float], bool]
"""Called with a model, the throws so far and its CPU seconds; True: it has trained enough."""

# Observations minus MIDDLE over UNIT: flights and movements are then of size one.
MIDDLE = np.array([1.5, 0.75, 0.0, 0.0, 1.5, 0.0, 0.0], np.float32)
UNIT = np.array([1.0, 1.0, 3.0, 5.0, 1.0, 3.0, 10.0], np.float32)


class Batch(VecEnv):
    """The vector environment as Stable-Baselines3 wants it: reset at once, infos one by one."""

    def __init__(self, n: int, seed: int, shaping: float) -> None:
        self.env = CatchVectorEnv(
            n, shaping=shaping, max_episode_steps=LONGEST, autoreset_mode=AutoresetMode.SAME_STEP
        )
        self.throws = 0
        self.first_seed = seed
        super().__init__(n, self.env.single_observation_space, self.env.single_action_space)

    def reset(self) -> np.ndarray:
        return (self.env.reset(seed=self.first_seed)[0] - MIDDLE) / UNIT

    def step_async(self, actions: np.ndarray) -> None:
        self.actions = actions

    def step_wait(self) -> Any:
        seen, reward, terminated, truncated, infos = self.env.step(self.actions)
        done = terminated | truncated
        each: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for i in np.flatnonzero(done):
            each[i]["terminal_observation"] = (infos["final_obs"][i] - MIDDLE) / UNIT
            each[i]["TimeLimit.truncated"] = bool(truncated[i] and not terminated[i])
        self.throws += int(done.sum())
        return (seen - MIDDLE) / UNIT, reward.astype(np.float32), done, each

    def close(self) -> None:
        self.env.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self.env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise NotImplementedError

    def env_method(
        self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any
    ) -> list[Any]:
        raise NotImplementedError

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:  # noqa: ARG002
        return [False] * len(list(self._get_indices(indices)))


class Policy:
    """A trained model as a controller, so that it is tested as everything else is."""

    def __init__(self, model: Any, task: CatchTask, throws: Throws) -> None:
        self.model, self.task, self.throws = model, task, throws

    def begin(self, n: int) -> None:
        assert n == len(self.throws)

    def act(self, sensed: Sensed) -> np.ndarray:
        seen = (self.task.observe(sensed, self.throws) - MIDDLE) / UNIT
        actions, _ = self.model.predict(seen, deterministic=True)
        return np.asarray(actions, np.float64)[:, 0]

    def traces(self) -> dict[str, np.ndarray]:
        return {}


def caught(model: Any, throws: Throws) -> np.ndarray:
    """Which throws (N,) the policy catches without exploring."""
    task = CatchTask()
    return play(task.world, throws, Policy(model, task, throws)).caught


class _Ask(BaseCallback):
    """Ask for a test every so many throws; the CPU seconds of tests do not count."""

    def __init__(self, env: Batch, every: int, most: int, test: Test) -> None:
        super().__init__()
        self.env, self.every, self.most, self.test = env, every, most, test
        self.next, self.testing, self.begun = every, 0.0, time.process_time()

    def _on_step(self) -> bool:
        if self.env.throws < self.next:
            return True
        self.next += self.every
        now = time.process_time()
        enough = self.test(self.model, self.env.throws, now - self.begun - self.testing)
        self.testing += time.process_time() - now
        return not enough and self.env.throws < self.most


def train_sac(seed: int, throws: int, every: int, shaping: float, test: Test) -> None:
    """Default settings, one throw at a time, one update at each tick after 1,000 of them."""
    _train(
        Batch(1, seed, shaping),
        lambda env: SAC("MlpPolicy", env, learning_starts=1_000, seed=seed, device="cpu"),
        throws, every, test,
    )  # fmt: skip


def train_ppo(seed: int, throws: int, every: int, shaping: float, test: Test) -> None:
    """Default settings but for the batch: 32 throws at once for 64 ticks, minibatches of 256."""
    _train(
        Batch(32, seed, shaping),
        lambda env: PPO("MlpPolicy", env, n_steps=64, batch_size=256, seed=seed, device="cpu"),
        throws, every, test,
    )  # fmt: skip


def _train(env: Batch, make: Callable[[Batch], Any], throws: int, every: int, test: Test) -> None:
    torch.set_num_threads(1)
    make(env).learn(total_timesteps=10**9, callback=_Ask(env, every, throws, test))
