"""The catching world: N trials at once, one clock tick after another."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Booleans, shaped
from handeye.catching.advance import advance
from handeye.catching.arm import ARMS, Arm, drives
from handeye.catching.ball import BALLS, Ball
from handeye.catching.events import Place
from handeye.catching.layout import Layout
from handeye.catching.state import FLYING, State, copied, launched
from handeye.catching.throws import Throws
from handeye.errors import InvalidInput
from handeye.sensors.retina import Retina


class Sensed(NamedTuple):
    """What eye and arm report of N trials at one moment, each (N,).

    The force is that of the drive just before the moment. What the eye does not see is NaN.
    """

    time: Array  # since launch [s]
    ball_x: Array  # [m]
    ball_z: Array
    ball_vx: Array  # [m/s]
    ball_vz: Array
    arm_x: Array  # [m]
    arm_v: Array  # [m/s]
    arm_force: Array  # [N]
    active: Booleans  # False once the trial is over


class World:
    """Arms, balls, ground, an eye and a clock (section 4.4.1).

    The world holds no trials: `start` makes a State, `step` makes the next one from it and leaves
    the old one alone. Trials of one batch may have different arms and balls.

    layout      where everything is
    arms        identity i is arms[i]; they must carry the layout's cup
    balls       identity i is balls[i]
    retina      the eye; by default its field takes in all that is in bounds
    collisions  False: the arm is out of the way, as when balls are only watched
    """

    def __init__(
        self,
        layout: Layout = Layout(),
        *,
        arms: tuple[Arm, ...] = ARMS,
        balls: tuple[Ball, ...] = BALLS,
        retina: Retina | None = None,
        collisions: bool = True,
    ) -> None:
        if any(arm.cup != layout.cup for arm in arms):
            raise InvalidInput("every arm must carry the cup of the layout: Arm(..., cup=...)")
        if any(ball.radius > min(layout.cup.height, 0.5 * layout.cup.width) for ball in balls):
            raise InvalidInput("every ball must fit between the walls and touch them when it lies")
        self.layout = layout
        self.arms = arms
        self.balls = balls
        self.retina = _overview(layout) if retina is None else retina
        self._drives = drives(arms)
        self._place = Place(
            layout.tick,
            *layout.arm_travel,
            *layout.bounds_x,
            layout.ceiling,
            0.5 * layout.cup.width,
            layout.cup.height,
            layout.cup.restitution,
            collisions,
            decay=np.array([ball.decay for ball in balls]),
            radius=np.array([ball.radius for ball in balls]),
        )

    def start(self, throws: Throws) -> State:
        """The state at launch, tick 0.

        Raises InvalidInput for identities that this world does not have, arms beyond their travel
        and balls that start within a wall of the cup.
        """
        for identity, known, name in (
            (throws.ball, self.balls, "ball"),
            (throws.arm, self.arms, "arm"),
        ):
            if np.any((identity < 0) | (identity >= len(known))):
                raise InvalidInput(f"{name} must be identities below {len(known)}")
        low, high = self.layout.arm_travel
        if np.any((throws.arm_x < low) | (throws.arm_x > high)):
            raise InvalidInput(f"every arm must start within its travel {(low, high)}")
        place = self._place
        across = np.abs(np.abs(throws.x - throws.arm_x) - place.half_width)
        gap = np.hypot(across, np.maximum(throws.z - place.height, 0.0))
        if place.collisions and np.any(gap < place.radius[throws.ball]):
            raise InvalidInput("a ball starts within a wall of the cup: move it or the arm")
        return launched(throws)

    def step(self, state: State, voltage: ArrayLike, *, after: float = 0.0) -> State:
        """The state one tick later, with command voltages V_c (N,) held over the tick.

        A trial stops at its exact end, or `after` seconds later, and stays there.
        Raises InvalidInput for voltages that are not finite or not (N,).
        """
        commands = shaped(voltage, state.time.shape, "voltage")
        new = copied(state)
        advance(new, commands, after, self._drives, self._place)
        return new

    def restart(self, state: State, which: Any, throws: Throws) -> State:
        """The state with fresh throws in the trials `which`; the others go on.

        which is a mask (N,) or indices, for as many trials as there are throws.
        """
        new, fresh = copied(state), self.start(throws)
        for field, value in zip(new, fresh, strict=True):
            field[which] = value
        return new

    def sense(self, state: State) -> Sensed:
        """What eye and arm report now."""
        return self._sensed(
            state.time,
            (state.x, state.z, state.vx, state.vz),
            (state.arm_x, state.arm_v, state.motor),
            state,
        )

    def final(self, state: State) -> Sensed:
        """What they reported at the exact end of each trial; NaN for those not over."""
        x, z, vx, vz, arm_x, arm_v, motor = state.final.T
        return self._sensed(state.end_time, (x, z, vx, vz), (arm_x, arm_v, motor), state)

    def _sensed(
        self, time: Array, ball: tuple[Array, ...], arm: tuple[Array, ...], state: State
    ) -> Sensed:
        x, v, motor = arm
        force = self._drives.force_per_volt[state.arm] * (
            motor - self._drives.back_emf[state.arm] * v
        )
        seen = self.retina.sight(*ball)
        return Sensed(time, *seen, x, v, force, state.outcome == FLYING)


def _overview(layout: Layout) -> Retina:
    """A field that takes in all that is in bounds, and a little more."""
    low, high = layout.bounds_x
    width = 1.1 * max(high - low, layout.ceiling)
    return Retina(center_x=0.5 * (low + high), center_z=0.5 * layout.ceiling, width=width)
