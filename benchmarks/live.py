"""How long commands of a live session take while observations are being learned.

    python benchmarks/live.py

One thread asks for commands at 500 Hz, another feeds sightings at 30 Hz, for ten seconds each:
the planar robot and a simulated UR10, each with the calibrator that is the default for it.
"""

import threading
import time
from typing import Any

import numpy as np

import handeye
from handeye.calibration import PlanarModel, PlanarWorld, WorldStreams
from handeye.calibration.arm_world import ArmWorld
from handeye.calibration.combined import Combined
from handeye.calibration.placed import place
from handeye.robots.urdf import load_arm
from handeye.thesis.plants import NOMINAL, NORMAL

SECONDS, CONTROL, CAMERA = 10.0, 500.0, 30.0


def measured(session: handeye.Session, seen: Any, *, feed: bool) -> np.ndarray:
    """Durations of commands [s]."""
    stop, taken, target = threading.Event(), [], seen[0].target

    def control() -> None:
        while not stop.wait(1.0 / CONTROL):
            start = time.perf_counter()
            session.command(target)
            taken.append(time.perf_counter() - start)

    thread = threading.Thread(target=control)
    thread.start()
    end = time.perf_counter() + SECONDS
    for one in seen:
        if time.perf_counter() > end:
            break
        if feed:
            session.observe(one)
        time.sleep(1.0 / CAMERA)
    stop.set()
    thread.join()
    return np.array(taken)


def report(name: str, calibrator: Any, seen: Any) -> None:
    """Print one line without and one with learning."""
    with handeye.Session(calibrator) as session:
        for one in seen[:80]:  # compile, and leave the first moments behind
            session.observe(one)
        session.wait()
        session.command(seen[0].target)
        for feed in (False, True):
            ms = 1e3 * measured(session, seen[80:], feed=feed)
            print(
                f"{name:<10} {'learning' if feed else 'idle':<9} {len(ms):>6} commands   median "
                f"{np.median(ms):6.3f}   99.9 % {np.percentile(ms, 99.9):6.3f}   "
                f"longest {ms.max():6.3f} ms"
            )


def main() -> None:
    """Measure both robots."""
    streams = WorldStreams.of(0)
    planar = PlanarWorld(NORMAL).observe(np.arange(500), streams.train_poses, streams.train_noise)
    report("planar", Combined(PlanarModel(NOMINAL)), planar)
    world = ArmWorld.of(load_arm("ur10"))
    times = np.arange(500) / 2.0
    seen = world.observe(times, world.motion(times), np.random.default_rng(0))
    model: Any = place(world.nominal, seen[:80])[0]
    report("UR10", Combined(model), seen)


if __name__ == "__main__":
    main()
