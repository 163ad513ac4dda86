"""The outcome of a calibration run, as plain data that tables, pages and JSON are made from."""

from dataclasses import asdict, dataclass

import numpy as np

from handeye.arrays import Array, Integers


@dataclass(frozen=True)
class ErrorSummary:
    """Statistics of the lengths of N error vectors [m]."""

    n: int
    mean: float
    rms: float
    p95: float
    max: float

    @classmethod
    def of(cls, errors: Array) -> "ErrorSummary":
        """Summarise error vectors (N, k), N >= 1 (eq 3.43 for the mean)."""
        lengths: Array = np.linalg.norm(errors, axis=1)
        return cls(
            n=len(lengths),
            mean=float(lengths.mean()),
            rms=float(np.sqrt(np.mean(lengths**2))),
            p95=float(np.percentile(lengths, 95)),
            max=float(lengths.max()),
        )


@dataclass(frozen=True)
class HeldOut:
    """Errors on rows that took no part in learning.

    rows (M,) are indices into the arrays of the run, before and after (M, k) error vectors [m].
    """

    rows: Integers
    before: Array
    after: Array


@dataclass(frozen=True)
class CalibrationResult:
    """One run over a log.

    joints (N, n) [rad], positions (N, 3) [m] in the sensor's frame (z = 0 for a planar robot).
    before (N, k) [m]   measured minus predicted with frames placed and nominal kinematics
    online (N, k) [m]   the same with the calibrator as it stood before it learned that row
    n_neurons (N,)      size of the network after that row, None where no network learns
    findings            what a calibrator that watches the robot's parts says of them, in words
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

    def summary(self) -> dict[str, dict[str, float]]:
        """The error statistics of every stage, ready for JSON."""
        stages = {"before": self.before, "online": self.online}
        if self.held_out is not None:
            stages |= {
                "held_out_before": self.held_out.before,
                "held_out_after": self.held_out.after,
            }
        return {name: asdict(ErrorSummary.of(errors)) for name, errors in stages.items()}
