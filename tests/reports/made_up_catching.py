"""Plausible made-up throws to draw: no world, no learner, only parabolas and a cup that moves."""

import numpy as np

from handeye.catching.layout import GRAVITY, Layout
from handeye.catching.play import Recording
from handeye.catching.results import CatchingResult, Mark, Score, Take
from handeye.catching.state import CAUGHT, MISSED
from handeye.catching.throws import Throws
from handeye.catching.world import Sensed

LAYOUT = Layout()
RADIUS = 0.03
TICKS = 70


def made_up_throws(n, seed=3):
    rng = np.random.default_rng(seed)
    x, z = rng.uniform(0.0, 0.2, n), rng.uniform(0.05, 0.15, n)
    vz = np.sqrt(2 * GRAVITY * (rng.uniform(1.25, 1.5, n) - z))
    crossing_x = rng.uniform(0.8, 2.2, n)
    time = (vz + np.sqrt(vz**2 + 2 * GRAVITY * (z - RADIUS))) / GRAVITY
    vx = (crossing_x - x) / time
    which = np.arange(n)
    return Throws(
        which % 2, which // 2 % 2, rng.uniform(0.8, 2.2, n), x, z, vx, vz, time, crossing_x, vx
    )


def made_up_recording(n=8, skill=1.0, after=0.5, seed=3):
    """The cup goes to where the ball comes down, `skill` 1, or anywhere near, 0."""
    throws = made_up_throws(n, seed)
    rng = np.random.default_rng(seed + 1)
    time = np.arange(TICKS)[:, None] * LAYOUT.tick * np.ones(n)
    end = throws.crossing_time
    aim = throws.crossing_x + (1.0 - skill) * rng.normal(0.0, 0.3, n)
    progress = np.clip(time / (0.85 * end), 0.0, 1.0)
    arm_x = throws.arm_x + (aim - throws.arm_x) * progress**2 * (3.0 - 2.0 * progress)
    caught = np.abs(aim - throws.crossing_x) < LAYOUT.cup.width / 2 - RADIUS
    ball_x = throws.x + throws.vx * time
    ball_z = throws.z + throws.vz * time - GRAVITY / 2 * time**2
    ball_vz = throws.vz - GRAVITY * time
    past = np.maximum(time - end, 0.0)
    up = 0.5 * throws.vz
    bounced = np.maximum(RADIUS + up * past - GRAVITY / 2 * past**2, RADIUS)
    over = time > end
    ball_x = np.where(over & caught, throws.crossing_x, ball_x)
    ball_z = np.where(over, np.where(caught, RADIUS, bounced), ball_z)
    ball_vz = np.where(over, np.where(caught, 0.0, up - GRAVITY * past), ball_vz)
    stopped = time > end + after

    def seen(values):
        return np.where(stopped, np.nan, values)

    noise = np.exp(-time / 0.2) * rng.normal(0.0, 0.15, time.shape)
    predicted = np.where(time < 0.1, np.nan, throws.crossing_x + noise)
    wrong = time < 0.25
    traces = {
        "crossing_x": predicted,
        "crossing_time": np.where(time < 0.1, np.nan, end + 0.3 * noise),
        "ball": np.where(wrong, 1 - throws.ball, np.where(time < 0.3, -1, throws.ball)),
        "arm": np.broadcast_to(throws.arm, time.shape),
        "ball_surprise": np.where(time < 0.1, np.nan, np.where(wrong, 8 * time, 0.4)),
        "arm_surprise": 0.3 + 0.1 * rng.random(time.shape),
    }
    level = np.sign(aim - throws.arm_x) * 0.3
    fields = (time, ball_x, ball_z, throws.vx + 0 * time, ball_vz, arm_x,
              np.gradient(arm_x, LAYOUT.tick, axis=0), 0 * time)  # fmt: skip
    final = (end, throws.crossing_x, RADIUS + 0 * end, throws.vx, -throws.vz, aim, 0 * end, 0 * end)
    return Recording(
        throws=throws,
        sensed=Sensed(*(seen(field) for field in fields), active=~over),
        voltage=seen(np.where(progress < 0.5, level, np.where(progress < 1.0, -level, 0.0))),
        final=Sensed(*final, active=np.zeros(n, bool)),
        caught=caught,
        outcome=np.where(caught, CAUGHT, MISSED),
        position_error=aim - throws.crossing_x,
        contact_time=np.where(caught, end - 0.02, np.inf),
        traces={name: seen(trace) for name, trace in traces.items()},
    )


def made_up_marks():
    pairs = [(0, 0), (0, 1), (1, 0), (1, 1)]
    course = ((0, 0, 0.0, 0.4), (10, 0, 0.5, 0.12), (100, 0, 0.85, 0.05), (300, 0, 0.95, 0.03),
              (300, 50, 0.98, 0.02))  # fmt: skip
    return [
        Mark(
            pursuits,
            mentored,
            tuple(Score(b, a, 50, round(50 * share) - b * (0 < share < 1), rms * (1 + 0.3 * a))
                  for b, a in pairs),
        )
        for pursuits, mentored, share, rms in course
    ]  # fmt: skip


def made_up_result(n=40):
    skills = {"nothing": 0.0, "10 pursuits": 0.3, "100 pursuits": 0.7, "300 pursuits": 1.0}
    return CatchingResult(
        test=made_up_recording(n, skill=0.9),
        surprised=made_up_recording(4, skill=0.9, seed=7),
        takes=[Take(title, made_up_recording(4, skill)) for title, skill in skills.items()],
        marks=made_up_marks(),
        neurons={
            "ball_recogniser": 900,
            "arm_recogniser": 1200,
            "motors.0": 2100,
            "motors.1": 4300,
        },
        cpu_seconds=47.3,
        settings={"settings": "improved", "replicate": "0"},
    )
