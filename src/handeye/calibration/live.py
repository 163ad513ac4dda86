"""A calibrator at work beside a running robot."""

from concurrent.futures import Future, ThreadPoolExecutor
from copy import deepcopy
from os import PathLike
from threading import Lock
from typing import Any, NamedTuple, Self

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrator import Feedback
from handeye.calibration.session import AnyCalibrator
from handeye.calibration.storage import load_model, save_model
from handeye.errors import HandeyeError, InvalidInput
from handeye.observations import Observation, Target

# While more observations wait, commands follow what is learned after every so many.
_EVERY = 10


class Snapshot(NamedTuple):
    """What is known at a moment.

    calibrator   as it was then; it learns nothing more: ask it for `covariance`, `health` and so on
    observed     observations it has learned from
    refused      observations that it could not use
    """

    calibrator: AnyCalibrator
    observed: int
    refused: int


class Session:
    """Feeds a calibrator from any thread and asks it for commands from any other.

    Observations are learned one after the other, in the order in which they were fed, by a thread
    of the session's own. Commands come from a copy of the calibrator, which is replaced as a whole
    once something has been learned: a command never waits for an observation, it only may not
    know yet of the latest. While many observations wait, the copy is replaced every ten.

        with Session(calibrator) as session:
            session.observe(sighting)         # returns at once
            joints = session.command(target)  # at control rate

    Args:
        calibrator: what learns. The session works on copies; this one stays as it is.
        observed: observations it has already learned from.
    """

    def __init__(self, calibrator: AnyCalibrator, *, observed: int = 0) -> None:
        self._learner = deepcopy(calibrator)
        self._now = Snapshot(deepcopy(calibrator), observed, 0)
        self._sample = deepcopy(calibrator)
        self._observed, self._refused, self._waiting = observed, 0, 0
        self._failure: BaseException | None = None
        self._closed = False
        self._feeding, self._commanding = Lock(), Lock()
        self._worker = ThreadPoolExecutor(max_workers=1, thread_name_prefix="handeye")

    @classmethod
    def restore(cls, path: str | PathLike[str]) -> Self:
        """A session that goes on from what `save` wrote; raises as `load_model`."""
        stored = load_model(path)
        return cls(stored.calibrator, observed=stored.observed)

    @property
    def now(self) -> Snapshot:
        """What is known now, never waiting for anything."""
        return self._now

    @property
    def waiting(self) -> int:
        """Observations that were fed and not yet learned."""
        return self._waiting

    def observe(self, observation: Observation) -> Future[Feedback]:
        """Feed one observation; returns at once.

        The result of the future, if anyone asks for it, is what the observation taught.

        Raises:
            InvalidInput: an observation that this calibrator cannot use, or a closed session;
                nothing is lost or changed.
        """
        with self._feeding:
            if self._closed:
                raise InvalidInput("the session is closed: nothing can be observed any more")
            self._check(observation)
            self._waiting += 1
            future = self._worker.submit(self._learn, observation)
        future.add_done_callback(self._note)
        return future

    def command(self, target: Target) -> Array:
        """Joint commands for one target or N, by what is known now; also of a closed session.

        Raises:
            InvalidInput: as the calibrator's own `command`.
        """
        # Arms keep scratch memory; only other commands are ever waited for here.
        with self._commanding:
            return self._now.calibrator.command(target)

    def wait(self, timeout: float | None = None) -> Snapshot:
        """Wait until all that was fed before is learned; the snapshot that knows it.

        Raises:
            TimeoutError: when that takes longer than so many seconds.
        """
        with self._feeding:
            done = None if self._closed else self._worker.submit(self._publish)
        if done is not None:
            done.result(timeout)
        return self._now

    def save(self, path: str | PathLike[str]) -> Snapshot:
        """Wait, and write what is known to a file, whole or not at all.

        `restore`, `handeye apply` and `load_model` read it. Raises as `save_model`.
        """
        snapshot = self.wait()
        save_model(path, snapshot.calibrator, snapshot.observed)
        return snapshot

    def close(self) -> Snapshot:
        """Learn what was fed, then accept no more; commands go on.

        Raises what went wrong unexpectedly while learning, if anything did.
        """
        with self._feeding:
            self._closed = True
        self._worker.shutdown(wait=True)
        if self._failure is not None:
            raise self._failure
        return self._now

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        """How much was learned and how much waits."""
        now = self._now
        return f"Session({now.observed} learned, {self._waiting} waiting, {now.calibrator!r})"

    def _check(self, observation: Observation) -> None:
        """Refuse what does not fit, by the errors of a copy that never learns."""
        one: Any = observation
        if np.ndim(getattr(one, "time", 0.0)):
            raise InvalidInput("feed one observation at a time: `for one in observations: ...`")
        try:
            self._sample.errors(one[np.newaxis])
        except (AttributeError, TypeError, ValueError) as error:
            raise InvalidInput(
                f"this {type(one).__name__} is nothing that {type(self._sample).__name__} of this "
                f"robot can learn from: {error}"
            ) from error

    def _learn(self, observation: Observation) -> Feedback:
        learned = False
        try:
            feedback = self._learner.observe(observation)
            learned = True
        finally:
            self._observed += learned
            self._refused += not learned
            with self._feeding:
                self._waiting -= 1
                last = self._waiting == 0
            if last or self._observed % _EVERY == 0:
                self._publish()
        return feedback

    def _publish(self) -> None:
        """One assignment: whoever asks sees the old snapshot or the new one."""
        if (self._observed, self._refused) != self._now[1:]:
            self._now = Snapshot(deepcopy(self._learner), self._observed, self._refused)

    def _note(self, done: Future[Feedback]) -> None:
        error = done.exception()
        if error is not None and not isinstance(error, HandeyeError):
            self._failure = self._failure or error
