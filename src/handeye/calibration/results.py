"""The outcome of a calibration run, as plain data that tables, pages and JSON are made from."""

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from handeye.arrays import Array, Booleans, Integers
from handeye.intervals import mean_interval

Validation = Literal["blocks", "random", "none"]
"""Which rows are held out: blocks in time, a random third, or none."""


@dataclass(frozen=True)
class ErrorSummary:
    """Statistics of the lengths of N error vectors [m], or of N turns [rad].

    interval: 95 % interval of the mean, None where nothing was known of how errors depend on each
    other.
    """

    n: int
    mean: float
    rms: float
    p95: float
    max: float
    interval: tuple[float, float] | None = None

    @classmethod
    def of(cls, errors: Array, parts: Integers | None = None) -> "ErrorSummary":
        """Summarise error vectors (N, k), N >= 1 (eq 3.43 for the mean).

        parts (N,): which errors may depend on each other; the interval comes from the spread of
        the parts' means (`mean_interval`), if there are two or more.
        """
        lengths: Array = np.linalg.norm(errors, axis=1)
        mean = float(lengths.mean())
        interval = None
        if parts is not None and len(kinds := np.unique(parts)) > 1:
            means = [float(lengths[parts == part].mean()) for part in kinds]
            interval = mean_interval(mean, means)
        return cls(
            n=len(lengths),
            mean=mean,
            rms=float(np.sqrt(np.mean(lengths**2))),
            p95=float(np.percentile(lengths, 95)),
            max=float(lengths.max()),
            interval=interval,
        )


@dataclass(frozen=True)
class HeldOut:
    """Errors on rows that took no part in learning.

    rows (M,)         indices into the arrays of the run, rising
    before, after     (M, k) error vectors [m], with frames placed and after learning other rows
    parts (M,)        rows of the same part were left out together
    how               which rows were left out
    turns_before,     (M, 3) rotation vectors from predicted to measured orientation [rad]; None
    turns_after       where no orientation was measured
    moves (B,)        how far, in the mean over the rows, predictions move when part b is left out
                      of what is learned [m]
    rigid             errors after learning others without error curves; None where there are none
    turns_rigid       the same of orientation
    expected (M,)     root mean square of what each `after` was expected to be, by a calibrator
                      that knows how certain it is [m]
    """

    rows: Integers
    before: Array
    after: Array
    parts: Integers
    how: Validation = "blocks"
    turns_before: Array | None = None
    turns_after: Array | None = None
    moves: Array | None = None
    rigid: Array | None = None
    turns_rigid: Array | None = None
    expected: Array | None = None

    @property
    def alike(self) -> Integers:
        """Which rows may depend on each other: those of a block; random ones do not."""
        return self.parts if self.how == "blocks" else np.arange(len(self.rows))


@dataclass(frozen=True)
class Parameter:
    """A number that was learned: its standard deviation and what it was before, where known."""

    name: str
    value: float
    std: float | None
    unit: str
    nominal: float | None = None


@dataclass(frozen=True)
class PartChange:
    """A part of the robot, and how far it was found to be off.

    moves    by how much its change moves the hand, root mean square over the rows [m]
    unknown  its most changed number, with change and std in `unit`
    known    share of the prior uncertainty of its numbers that rows have taken away, 0 to 1
    """

    part: str
    moves: float
    unknown: str
    change: float
    std: float
    unit: str
    known: float


@dataclass(frozen=True)
class Influence:
    """What each of N rows says against the others.

    residual (N,)  length of the error with the row held out, or, where it was not, with all rows
                   learned [m]; nan before the robot last changed
    times (N,)     the same over the size that is to be expected, 1 being ordinary
    left_out (N,)  whether the calibrator did not believe the row when it came
    expected (N,)  root mean square of what the residual was expected to be [m], by a calibrator
                   that knows how certain it is: the row's surprise is the residual over this
    """

    residual: Array
    times: Array
    left_out: Booleans
    expected: Array | None = None

    def worst(self, most: int) -> Integers:
        """Rows that fit least, at most so many, worst first."""
        return np.argsort(-np.nan_to_num(self.times, nan=-1.0), kind="stable")[:most]


@dataclass(frozen=True, eq=False)
class Workspace:
    """Poses all over what an arm can reach, and how far its hand is expected to miss there.

    joints (N, n)     within the limits [rad] or [m]
    positions (N, 3)  of the marker in the base frame [m]
    expected (N,)     root mean square miss [m]
    worked (N,)       whether all joints are in the range in which the robot was seen
    seen (M, 3)       where the marker was at some of the rows, in the base frame [m]
    """

    joints: Array
    positions: Array
    expected: Array
    worked: Booleans
    seen: Array


@dataclass(frozen=True)
class CalibrationResult:
    """One run over a log, its rows in the order of time.

    joints (N, n) [rad], positions (N, 3) [m] in the sensor's frame (z = 0 for a planar robot).
    before (N, k) [m]   measured minus predicted with frames placed and nominal kinematics
    online (N, k) [m]   the same with the calibrator as it stood before it learned that row
    n_neurons (N,)      size of the network after that row, None where no network learns
    findings            what a calibrator that watches the robot's parts says of them, in words
    since               the first row since the robot last changed, as far as was noticed
    drifting            whether it was changing all the time at the end
    times, rows (N,)    time stamps [s], and numbers of the rows in the file
    workspace           how far the hand is expected to miss all over its reach, where known
    suspects            what seems to be wrong with the log, in words
    sliding             joints that slide: their readings are in metres
    """

    robot: str
    log: str
    method: str
    joint_names: tuple[str, ...]
    joints: Array
    positions: Array
    before: Array
    online: Array
    n_neurons: Integers | None
    held_out: HeldOut | None
    rejected: tuple[str, ...]
    settings: dict[str, str]
    findings: tuple[str, ...] = ()
    since: int = 0
    drifting: bool = False
    times: Array | None = None
    rows: Integers | None = None
    parameters: tuple[Parameter, ...] = ()
    parts: tuple[PartChange, ...] = ()
    undetermined: tuple[str, ...] = ()
    influence: Influence | None = None
    workspace: Workspace | None = None
    suspects: tuple[str, ...] = ()
    sliding: tuple[str, ...] = ()

    def summary(self) -> dict[str, dict[str, Any]]:
        """The error statistics of every stage, ready for JSON."""
        stages = {
            "before": ErrorSummary.of(self.before),
            "online": ErrorSummary.of(self.online),
        }
        held = self.held_out
        if held is not None:
            stages["held_out_before"] = ErrorSummary.of(held.before, held.alike)
            if held.rigid is not None:
                stages["held_out_rigid"] = ErrorSummary.of(held.rigid, held.alike)
            stages |= {
                "held_out_after": ErrorSummary.of(held.after, held.alike),
            }
        return {name: asdict(errors) for name, errors in stages.items()}
