"""Runs experiments, over several processes if asked."""

import multiprocessing
import os
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, NamedTuple

from handeye.arrays import count
from handeye.errors import HandeyeError
from handeye.thesis.experiment import FULL, Effort, Experiment
from handeye.thesis.records import Record, Records, flatten

Progress = Callable[[int, int], None]
"""Called with the parts done and their total, first with none done."""


def silent(done: int, total: int) -> None:
    """Shows nothing."""


class WorkerLost(HandeyeError):
    """A process ended before it gave its result."""


class _Part(NamedTuple):
    experiment: Experiment[Any]
    setting: str
    replicate: int
    effort: Effort


def run(
    experiments: Sequence[Experiment[Any]],
    *,
    replicates: int | None = None,
    jobs: int | None = None,
    progress: Progress = silent,
    effort: Effort = FULL,
) -> Records:
    """The records of experiments; the same, in the same order, however many processes work.

    Args:
        experiments: what to run, with all settings.
        replicates: repetitions of each, by default its own number; deterministic ones have one.
        jobs: processes, by default one for each core this process may use. With more than one, a
            script that calls this needs the usual `if __name__ == "__main__":`.
        progress: told what is done.
        effort: how much of each experiment to run.

    Raises:
        InvalidInput: replicates or jobs below one.
        WorkerLost: a process could not start or was killed.
    """
    workers = _cores() if jobs is None else count(jobs, "jobs")
    parts = [
        _Part(experiment, setting, replicate, effort)
        for experiment in experiments
        for setting in experiment.settings
        for replicate in range(experiment.repetitions(replicates))
    ]
    done: dict[int, list[Record]] = {}
    progress(0, len(parts))
    for index, rows in _measured(parts, min(workers, len(parts))):
        done[index] = rows
        progress(len(done), len(parts))
    return Records(row for index in range(len(parts)) for row in done[index])


def _cores() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not every system can say
        return os.cpu_count() or 1


def _measure(part: _Part) -> list[Record]:
    experiment, setting, replicate, effort = part
    try:
        measured = experiment.measure(experiment.settings[setting], replicate, effort)
    except Exception as error:
        error.add_note(f"in experiment {experiment.id}, setting {setting}, replicate {replicate}")
        raise
    return flatten(experiment.id, setting, replicate, measured)


def _measured(parts: list[_Part], workers: int) -> Iterator[tuple[int, list[Record]]]:
    """Every part's index and records, as they are ready."""
    if workers <= 1:
        yield from enumerate(map(_measure, parts))
        return
    with _pool(workers) as pool:
        indices = {pool.submit(_measure, part): index for index, part in enumerate(parts)}
        for future in as_completed(indices):
            yield indices[future], future.result()


@contextmanager
def _pool(workers: int) -> Generator[ProcessPoolExecutor]:
    """Fresh processes, alike on every system; what is not yet begun is dropped on an error."""
    pool = ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))
    try:
        yield pool
    except BrokenProcessPool as broken:
        raise WorkerLost(
            "a process ended before it gave its result: put the call behind "
            'if __name__ == "__main__": in a script file, check that memory suffices, or use jobs=1'
        ) from broken
    finally:
        pool.shutdown(cancel_futures=True)
