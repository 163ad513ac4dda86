"""A session: observations from any thread, commands at any time, nothing lost."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier, Event
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.calibration.cases import CASES, sightings

import handeye
from handeye.calibration.calibrator import Feedback
from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.combined import Combined
from handeye.calibration.live import Session
from handeye.calibration.models import PlanarModel
from handeye.errors import InvalidInput
from handeye.observations import PointObservation
from handeye.thesis.plants import NOMINAL

SEEN = sightings(n=60)
LONG = 600.0  # seconds until a test that hangs is given up


class Slow:
    """Remembers the times of what it observed; `go` lets it finish each observation."""

    def __init__(self, learned=(), go=None, began=None):
        self.learned, self.go, self.began = list(learned), go, began

    def __deepcopy__(self, _memo):
        return Slow(self.learned, self.go, self.began)

    def observe(self, observation):
        if self.began is not None:
            self.began.set()
        if self.go is not None:
            assert self.go.wait(LONG)
        if observation.time < 0.0:
            raise InvalidInput("time runs backwards")
        if observation.time > 1e6:
            raise ZeroDivisionError("a mistake")
        self.learned.append(float(observation.time))
        return Feedback(np.array([observation.time, 0.0]), np.zeros((), np.bool_))

    def errors(self, observations):
        return np.zeros((len(observations), 2))

    def command(self, _target):
        return np.array(self.learned)


def slow_session(**events) -> Session:
    fake: Any = Slow(**events)
    return Session(fake)


def at(time):
    one = SEEN[0]
    return type(one)(time, one.joints, one.pointing, one.range, one.eccentricity)


@pytest.mark.parametrize("case", CASES[:1] + CASES[-2:], ids=str)
def test_it_learns_what_the_calibrator_alone_would(case):
    alone, given_one = NetworkCorrection(case.model), NetworkCorrection(case.model)
    feedback = alone.observe_many(case.seen)
    with Session(given_one, observed=5) as session:
        futures = [session.observe(one) for one in case.seen]
        errors = np.array([future.result(LONG).error for future in futures])
        np.testing.assert_array_equal(
            session.wait(LONG).calibrator.command(case.seen.target),
            alone.command(case.seen.target),
        )
    np.testing.assert_array_equal(errors, feedback.error)
    assert session.now.observed == 65
    assert session.waiting == 0
    assert given_one.network.trials == 0


def test_a_command_does_not_wait_for_an_observation_in_progress():
    go, began = Event(), Event()
    session = slow_session(go=go, began=began)
    first = session.observe(at(1.0))
    assert began.wait(LONG)
    # The worker now stands inside the calibrator.
    assert session.command(SEEN[0].target).tolist() == []
    assert session.now.observed == 0
    second = session.observe(at(2.0))
    assert session.waiting == 2
    assert not first.done()
    go.set()
    assert second.result(LONG).error[0] == 2.0
    assert session.command(SEEN[0].target).tolist() == [1.0, 2.0]
    session.close()


def test_a_snapshot_stays_as_it_was():
    with Session(NetworkCorrection(PlanarModel(NOMINAL))) as session:
        nominal = session.now.calibrator.command(SEEN.target)
        for one in SEEN[:30]:
            session.observe(one)
        half = session.wait(LONG)
        known = half.calibrator.command(SEEN.target)
        for one in SEEN[30:]:
            session.observe(one)
        after = session.wait(LONG)
        assert (half.observed, after.observed) == (30, 60)
        np.testing.assert_array_equal(half.calibrator.command(SEEN.target), known)
        assert np.any(known != nominal)
        assert np.any(after.calibrator.command(SEEN.target) != known)


@settings(max_examples=10)
@given(threads=st.integers(2, 6), each=st.integers(1, 30))
def test_threads_that_feed_at_once_lose_nothing(threads, each):
    start = Barrier(threads)

    def feed(thread):
        start.wait(LONG)
        for i in range(each):
            session.observe(at(float(thread * each + i)))
            session.command(SEEN[0].target)

    with slow_session() as session, ThreadPoolExecutor(threads) as pool:
        list(pool.map(feed, range(threads)))
        learned = session.wait(LONG).calibrator.command(SEEN[0].target).tolist()
    assert sorted(learned) == [float(i) for i in range(threads * each)]
    # Each thread's own come in its own order.
    for thread in range(threads):
        own = [time for time in learned if time // each == thread]
        assert own == sorted(own)


@pytest.mark.parametrize(
    ("bad", "said"),
    [
        (CASES[-1].seen[0], "PointObservation is nothing that Combined"),
        (SEEN, "one observation at a time"),
        (None, "NoneType is nothing that"),
    ],
)
def test_what_does_not_fit_is_refused_where_it_is_fed(bad, said):
    with Session(Combined(PlanarModel(NOMINAL))) as session:
        session.observe(SEEN[0])
        with pytest.raises(InvalidInput, match=said):
            session.observe(bad)
        session.observe(SEEN[1])
        assert session.wait(LONG)[1:] == (2, 0)


def test_joints_of_another_arm_are_refused():
    arm = CASES[-1]
    joints = np.append(arm.seen[0].joints, 0.0)
    with (
        Session(NetworkCorrection(arm.model)) as session,
        pytest.raises(InvalidInput, match=r"NetworkCorrection of this robot .* \(1, 7\)"),
    ):
        session.observe(PointObservation(np.array(0.0), joints, np.zeros(3)))


def test_what_the_calibrator_refuses_later_is_counted_and_the_rest_is_learned():
    with slow_session() as session:
        futures = [session.observe(at(time)) for time in (1.0, -1.0, 2.0)]
        with pytest.raises(InvalidInput, match="backwards"):
            futures[1].result(LONG)
        assert session.wait(LONG)[1:] == (2, 1)
        assert session.command(SEEN[0].target).tolist() == [1.0, 2.0]


def test_a_mistake_inside_the_calibrator_is_told_at_the_end():
    session = slow_session()
    for time in (1.0, 2e6, 3.0):
        session.observe(at(time))
    with pytest.raises(ZeroDivisionError, match="a mistake"):
        session.close()
    assert session.command(SEEN[0].target).tolist() == [1.0, 3.0]


def test_closing_waits_for_what_was_fed_and_commands_go_on():
    go = Event()
    session = slow_session(go=go)
    for time in range(25):
        session.observe(at(float(time)))
    go.set()
    assert session.close().observed == 25
    assert len(session.command(SEEN[0].target)) == 25
    with pytest.raises(InvalidInput, match="session is closed"):
        session.observe(at(1.0))
    assert session.wait(LONG) is session.close()


def test_waiting_gives_up_in_time():
    go = Event()
    with slow_session(go=go) as session:
        session.observe(at(1.0))
        with pytest.raises(TimeoutError):
            session.wait(0.0)
        go.set()


def test_a_restored_session_goes_on_where_it_was_saved(tmp_path):
    path = tmp_path / "robot.model.safetensors"
    whole = Combined(PlanarModel(NOMINAL))
    whole.observe_many(SEEN)
    with Session(Combined(PlanarModel(NOMINAL))) as session:
        for one in SEEN[:30]:
            session.observe(one)
        assert session.save(path).observed == 30
    with Session.restore(path) as session:
        for one in SEEN[30:]:
            session.observe(one)
        session.save(path)
    stored = Session.restore(path).now
    assert stored.observed == 60
    np.testing.assert_array_equal(
        stored.calibrator.command(SEEN.target), whole.command(SEEN.target)
    )
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_a_file_that_cannot_be_written_costs_nothing(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with Session(NetworkCorrection(PlanarModel(NOMINAL))) as session:
        session.observe(SEEN[0])
        with pytest.raises(OSError, match="file"):
            session.save(tmp_path / "file" / "model")
        session.observe(SEEN[1])
    assert session.now.observed == 2


def test_the_package_offers_it_and_loads_it_only_then():
    assert handeye.Session is Session
    with pytest.raises(AttributeError, match="no attribute 'session'"):
        _ = handeye.session  # pyright: ignore[reportAttributeAccessIssue]
    quick = "import sys, handeye; sys.exit('numpy' in sys.modules)"
    subprocess.run([sys.executable, "-c", quick], check=True)
