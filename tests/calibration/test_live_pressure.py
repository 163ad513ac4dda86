"""A session under pressure: threads that feed, ask and save at once, and a program that dies."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
from tests.calibration.cases import sightings

from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.live import Session
from handeye.calibration.models import PlanarModel
from handeye.thesis.plants import NOMINAL

SEEN = sightings(n=60)
LONG = 600.0  # seconds until a test that hangs is given up


def test_saves_commands_and_feeds_at_once_each_see_a_whole(tmp_path):
    """Whoever restores finds so many observations learned as the file says, in the order fed."""
    path, start = tmp_path / "robot.model.safetensors", Barrier(3)
    session = Session(NetworkCorrection(PlanarModel(NOMINAL)))

    def feed():
        start.wait(LONG)
        for one in SEEN:
            session.observe(one)

    def save():
        start.wait(LONG)
        return [session.save(path) for _ in range(5)]

    def ask():
        start.wait(LONG)
        return [session.command(SEEN[0].target) for _ in range(200)]

    with ThreadPoolExecutor(3) as pool:
        fed, saved, asked = pool.submit(feed), pool.submit(save), pool.submit(ask)
        fed.result(LONG)
        commands = asked.result(LONG)
        observed = [snapshot.observed for snapshot in saved.result(LONG)]
    assert observed == sorted(observed)
    stored = Session.restore(path).now
    alone = NetworkCorrection(PlanarModel(NOMINAL))
    known = [alone.command(SEEN[0].target)]
    for one in SEEN:
        alone.observe(one)
        known.append(alone.command(SEEN[0].target))
    assert stored.observed == observed[-1]
    np.testing.assert_array_equal(stored.calibrator.command(SEEN[0].target), known[stored.observed])
    # Every command is one that the calibrator would have given at some moment, never a mixture.
    assert all(any(np.array_equal(c, k) for k in known) for c in commands)
    assert session.close().observed == len(SEEN)


def test_a_program_that_is_killed_while_it_saves_leaves_a_whole_file(tmp_path):
    path = tmp_path / "robot.model.safetensors"
    session = Session(NetworkCorrection(PlanarModel(NOMINAL)))
    session.observe(SEEN[0])
    session.save(path)
    forever = (
        "import sys; from handeye import Session; s = Session.restore(sys.argv[1])\n"
        "while True: s.save(sys.argv[1]); print('saved', flush=True)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", forever, str(path)], stdout=subprocess.PIPE
    ) as program:
        assert program.stdout is not None
        for _ in range(20):
            assert program.stdout.readline() == b"saved\n"
        program.kill()
    assert Session.restore(path).now.observed == 1
