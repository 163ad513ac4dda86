"""Balls near cups, and what must hold at any moment."""

import numpy as np

from handeye.catching.throws import launch
from handeye.catching.world import World

RADIUS, HEIGHT, HALF_WIDTH = 0.03, 0.08, 0.1


def gaps(x, z, arm_x):
    """Distance from the ball's surface to the nearer wall of the cup (N,)."""
    above = np.maximum(z - HEIGHT, 0.0)
    return (
        np.minimum(np.hypot(x - arm_x + HALF_WIDTH, above), np.hypot(x - arm_x - HALF_WIDTH, above))
        - RADIUS
    )


def scene(n, rng, *, world=None, arm_speed=2.0):
    """A world and a state of n balls just above or beside moving cups, away from the stops."""
    world = World() if world is None else world
    arm_x = rng.uniform(1.4, 1.6, n)
    x, z = arm_x + rng.uniform(-0.3, 0.3, n), rng.uniform(0.05, 0.5, n)
    clear = gaps(x, z, arm_x) > 1e-3
    z = np.where(clear, z, z + 0.15)
    throws = launch(
        rng.integers(0, 2, n),
        rng.integers(0, 2, n),
        arm_x,
        x,
        z,
        rng.normal(0.0, 1.5, n),
        rng.normal(-1.0, 1.5, n),
    )
    moving = rng.normal(0.0, arm_speed, n) if arm_speed else np.zeros(n)
    return world, world.start(throws)._replace(arm_v=moving)
