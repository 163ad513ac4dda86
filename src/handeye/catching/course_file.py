"""A course as one file: a learner's file, and in it how far the course has come."""

from dataclasses import asdict, fields
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.catching import storage
from handeye.catching.course import Course, Plan
from handeye.catching.learner import Learner
from handeye.catching.play import Recording
from handeye.catching.results import Mark, Score, Take
from handeye.catching.throws import Throws
from handeye.catching.world import Sensed, World
from handeye.errors import FileFormatError
from handeye.io.tensors import Header, read_tensors, write_tensors

_TITLE = "a learner that catches"
_OUTCOMES = ("caught", "outcome", "position_error", "contact_time")


def save_course(path: str | PathLike[str], course: Course) -> None:
    """Write a learner's file that says as well how far its course has come.

    `Learner.load` reads it like any other. An old file is replaced only once the new is complete.
    """
    with TemporaryDirectory() as folder:
        plain = Path(folder) / "learner"
        course.learner.save(plain)
        arrays, header = read_tensors(plain, storage.FORMAT, storage.VERSION, _TITLE)
    for i, take in enumerate(course.takes):
        arrays |= {f"course/{i}/{name}": a for name, a in _to_arrays(take.recording).items()}
    header["course"] = {
        "plan": asdict(course.plan),
        "marks": [
            {**asdict(mark), "scores": list(map(asdict, mark.scores))} for mark in course.marks
        ],
        "takes": [take.title for take in course.takes],
        "cpu_seconds": course.cpu_seconds,
    }
    write_tensors(path, storage.FORMAT, storage.VERSION, arrays, header)


def load_course(path: str | PathLike[str], world: World) -> Course:
    """What `save_course` wrote; of a learner that was saved alone, a course that is at its end.

    Raises:
        FileFormatError: no such file, damaged, foreign, or from a newer version.
    """
    learner = Learner.load(path)
    arrays, header = read_tensors(path, storage.FORMAT, storage.VERSION, _TITLE)
    if "course" not in header:
        return Course(learner, world, _as_practised(learner))
    try:
        return _course(learner, world, arrays, header["course"])
    except (LookupError, TypeError, ValueError) as error:
        raise FileFormatError(
            f"{path}: damaged, its course does not fit together ({error})"
        ) from error


def _course(learner: Learner, world: World, arrays: dict[str, Array], said: Header) -> Course:
    plan: dict[str, Any] = dict(said["plan"])
    plan |= {name: tuple(plan[name]) for name in ("arms", "balls")}
    course = Course(learner, world, Plan(**plan))
    course.marks = [
        Mark(mark["pursuits"], mark["mentored"], tuple(Score(**score) for score in mark["scores"]))
        for mark in said["marks"]
    ]
    for i, title in enumerate(said["takes"]):
        prefix = f"course/{i}/"
        mine = {k.removeprefix(prefix): a for k, a in arrays.items() if k.startswith(prefix)}
        course.takes.append(Take(str(title), _from_arrays(mine)))
    course.cpu_seconds = float(said["cpu_seconds"])
    return course


def _as_practised(learner: Learner) -> Plan:
    """A plan that asks for no more than what a learner has done already."""
    arms = tuple(i for i, n in enumerate(learner.pursuits) if n) or (0,)
    balls = tuple(i for i, n in enumerate(learner.tosses) if n) or (0,)
    return Plan(
        pursuits=min(learner.pursuits[arm] for arm in arms),
        tosses=min(learner.tosses[ball] for ball in balls),
        mentored=learner.mentored,
        arms=arms,
        balls=balls,
    )


def _to_arrays(recording: Recording) -> dict[str, Array]:
    """What pictures need of a recording: all but the controller's traces."""
    groups = {"throws": recording.throws, "sensed": recording.sensed, "final": recording.final}
    named: dict[str, Any] = {name: getattr(recording, name) for name in ("voltage", *_OUTCOMES)}
    for group, parts in groups.items():
        names = Throws.__dataclass_fields__ if group == "throws" else Sensed._fields
        named |= {f"{group}/{name}": getattr(parts, name) for name in names}
    return {name: np.asarray(value) for name, value in named.items()}


def _from_arrays(arrays: dict[str, Array]) -> Recording:
    sensed, final = (
        Sensed(**{name: arrays[f"{group}/{name}"] for name in Sensed._fields})  # pyright: ignore[reportArgumentType]
        for group in ("sensed", "final")
    )
    throws: dict[str, Any] = {f.name: arrays[f"throws/{f.name}"] for f in fields(Throws)}
    outcomes: dict[str, Any] = {name: arrays[name] for name in _OUTCOMES}
    return Recording(
        throws=Throws(**throws), sensed=sensed, voltage=arrays["voltage"], final=final,
        traces={}, **outcomes,
    )  # fmt: skip
