"""What both environments share: what is observed, what may be done and what is rewarded."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from handeye.arrays import Array, Booleans, finite, scalar
from handeye.catching.ball import speed_to_reach
from handeye.catching.layout import GRAVITY, Layout
from handeye.catching.state import CAUGHT, FLYING, State
from handeye.catching.throws import Throws, draw_throws
from handeye.catching.world import Sensed, World
from handeye.errors import InvalidInput

Observations = NDArray[np.float32]
SENSES = ("ball_x", "ball_z", "ball_vx", "ball_vz", "arm_x", "arm_v", "arm_force")


@dataclass(frozen=True)
class CatchTask:
    """Catch one ball; an episode is one throw.

    Observed are what eye and arm report at the tick, as `SENSES` in SI units and float32: where the
    ball is and how fast (4), where the arm is and how fast (2), and the drive's force. Which arm
    and ball they are is drawn anew for each episode and not observed, unless asked for. What the
    eye does not see reads 0. The action is the command voltage V_c in [-1, 1], held over the tick.

    The reward is 1 at the tick at which the ball is caught, and 0 otherwise. With `shaping` w,
    each tick also pays w times the metres by which the arm came nearer to where the ball will come
    down if nothing deflects it, so that over an episode w (|first distance| - |last distance|) is
    added. That place is never observed.

    balls, arms         identities that are drawn from
    shaping             w [1/m]
    observe_identities  appends the identities of ball and arm to the observation
    layout              where everything is
    """

    balls: Sequence[int] = (0, 1)
    arms: Sequence[int] = (0, 1)
    shaping: float = 0.0
    observe_identities: bool = False
    layout: Layout = Layout()

    def __post_init__(self) -> None:
        scalar(self.shaping, "shaping", least=0.0)
        # Refuses identities and a layout that no throw can be drawn with.
        self.draw(1, np.random.default_rng(0))
        _ = self.world

    @cached_property
    def world(self) -> World:
        """Where it happens."""
        return World(self.layout)

    @cached_property
    def observation_space(self) -> Box:
        """Bounds that the layout implies; what is outside of them is cut off."""
        place, arms, balls = self.layout, self.world.arms, self.world.balls
        arm_v = max(arm.terminal_velocity for arm in arms)
        force = max(arm.force_per_volt * (arm.supply + arm.back_emf * arm_v) for arm in arms)
        vz = max(speed_to_reach(place.apex[1] - place.launch_z[0], b.decay) for b in balls)
        vx = max(self._fastest_across(ball.decay) for ball in balls)
        # A wall that comes towards the ball at full speed sends it back with up to twice that more.
        hit = 2.0 * arm_v
        low = [place.bounds_x[0], 0.0, -vx - hit, -vz - hit, place.arm_travel[0], -arm_v, -force]
        high = [place.bounds_x[1], place.ceiling, vx + hit, vz + hit, place.arm_travel[1]]
        high += [arm_v, force]
        if self.observe_identities:
            low += [0.0, 0.0]
            high += [len(balls) - 1.0, len(arms) - 1.0]
        return Box(np.array(low, np.float32), np.array(high, np.float32), dtype=np.float32)

    @property
    def action_space(self) -> Box:
        """The command voltage V_c."""
        return Box(-1.0, 1.0, (1,), np.float32)

    def draw(self, n: int, rng: np.random.Generator) -> Throws:
        """n throws of this task."""
        return draw_throws(n, rng, layout=self.layout, balls=self.balls, arms=self.arms)

    def observe(self, sensed: Sensed, throws: Throws) -> Observations:
        """Observations (N, d) in the bounds of the space."""
        columns = [getattr(sensed, name) for name in SENSES]
        if self.observe_identities:
            columns += [throws.ball, throws.arm]
        space = self.observation_space
        seen = np.nan_to_num(np.stack(columns, axis=-1).astype(np.float32), nan=0.0)
        return np.clip(seen, space.low, space.high)

    def commands(self, actions: Any, n: int) -> Array:
        """Command voltages (n,) of actions (n, 1), cut off at the bounds.

        Raises InvalidInput for actions of another shape or not finite.
        """
        given = finite(actions, "action")
        if given.shape != (n, 1):
            raise InvalidInput(f"action must have shape {(n, 1)}, got {given.shape}")
        return np.clip(given[:, 0], -1.0, 1.0)

    def reward(self, before: State, after: State, throws: Throws) -> Array:
        """Of one tick (N,)."""
        caught = (before.outcome == FLYING) & (after.outcome == CAUGHT)
        earlier = np.abs(before.arm_x - throws.crossing_x)
        return caught + self.shaping * (earlier - np.abs(after.arm_x - throws.crossing_x))

    def success(self, state: State) -> Booleans:
        """Which balls (N,) have been caught."""
        return state.outcome == CAUGHT

    def over(self, state: State) -> Booleans:
        """Which trials (N,) have ended: caught, on the ground, or out of bounds."""
        return state.outcome != FLYING

    def _fastest_across(self, decay: float) -> float:
        """A bound of the horizontal launch speed [m/s]: |x_c - x_0| k / (1 - exp(-k t)).

        No flight is shorter than the fall without drag from the lowest apex.
        """
        (left, right), (near, far) = self.layout.launch_x, self.layout.crossing_x
        t = np.sqrt(2.0 * self.layout.apex[0] / GRAVITY)
        way = max(abs(far - left), abs(right - near))
        return float(way * decay / -np.expm1(-decay * t))


def replaced(throws: Throws, which: Booleans, fresh: Throws) -> Throws:
    """The throws with fresh ones at `which` (N,)."""
    columns: dict[str, Any] = {}
    for field in fields(Throws):
        columns[field.name] = getattr(throws, field.name).copy()
        columns[field.name][which] = getattr(fresh, field.name)
    return Throws(**columns)
