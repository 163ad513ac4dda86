"""Learners with little practice, trained once for all tests of a process, and hand-made records."""

from functools import cache

import numpy as np

from handeye.catching import practice
from handeye.catching.learner import Learner
from handeye.catching.play import Recording
from handeye.catching.settings import IMPROVED, SMOOTH, THESIS
from handeye.catching.throws import draw_throws
from handeye.catching.world import Sensed, World

SETTINGS = {"thesis": THESIS, "improved": IMPROVED, "smooth": SMOOTH}
WORLD = World()


@cache
def trained(name="improved", pursuits=60, tosses=30):
    """Do not let it learn more: copy it through a file first."""
    learner = Learner(SETTINGS[name])
    practice.train(learner, WORLD, 300, pursuits=pursuits, tosses=tosses, mentored=0)
    return learner


def copied(learner, folder):
    learner.save(folder / "copy.safetensors")
    return Learner.load(folder / "copy.safetensors")


def throws(n, seed=0, **kwargs):
    return draw_throws(n, np.random.default_rng(seed), **kwargs)


def record(arm_x, *, crossing, contact_time=np.inf, generated=(0.0, 0.0), arm=1.0):
    """One throw in which the arm was at arm_x (T,) and the ball crossed at (x, time)."""
    ticks = len(arm_x)

    def column(value):
        return np.broadcast_to(np.asarray(value, float), ticks)[:, np.newaxis].copy()

    sensed = Sensed(
        time=column(0.025 * np.arange(ticks)), ball_x=column(0.0), ball_z=column(0.0),
        ball_vx=column(0.0), ball_vz=column(0.0), arm_x=column(arm_x),
        arm_v=column(np.gradient(arm_x, 0.025)), arm_force=column(0.0),
        active=np.ones((ticks, 1), bool),
    )  # fmt: skip
    nothing, over = np.zeros(1), np.array([False])
    end = Sensed(*[nothing] * 8, active=over)._replace(
        time=np.array([crossing[1]]), ball_x=np.array([crossing[0]]), arm_x=arm_x[-1:]
    )
    traces = {
        "arm": column(arm), "correction_x": column(generated[0]),
        "correction_time": column(generated[1]), "crossing_x": column(crossing[0] + 0.5),
        "crossing_time": column(crossing[1] + 0.2),
    }  # fmt: skip
    return Recording(
        throws=throws(1), sensed=sensed, voltage=column(0.0), final=end,
        caught=np.array([False]), outcome=np.array([2]), position_error=np.zeros(1),
        contact_time=np.array([contact_time]), traces=traces,
    )  # fmt: skip
