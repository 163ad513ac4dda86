"""Levenberg-Marquardt: a damped direction and a rule for accepting the step (section 3.6.1)."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, finite, scalar, shaped
from handeye.errors import InvalidInput

# Of a cost: sums of a few thousand terms are not better than this.
_ROUNDING = 1e-15


class Problem(Protocol):
    """A cost of n parameters: the sum of squares of M residuals, or one that they stand in for."""

    def cost(self, parameters: Array) -> float:
        """What is minimised, with gradient 2 J^T r; infinite where parameters are impossible."""
        ...

    def residuals(self, parameters: Array) -> Array:
        """Residuals r (M,) at parameters (n,)."""
        ...

    def jacobian(self, parameters: Array) -> Array:
        """Their derivatives J (M, n)."""
        ...


class Status(Enum):
    """How a solve ended; the value says what to do next."""

    CONVERGED = "converged: a smaller cost needs other data, another model or another start"
    NO_BETTER_STEP = (
        "no step lowers the cost any more, though its slope is not zero: rounding, if the cost is "
        "as small as expected; else check the Jacobian, or start nearer"
    )
    TOO_MANY_ITERATIONS = "stopped while the cost still fell: allow more iterations or start nearer"
    NOT_DETERMINED = (
        "some parameter changes no residual: fix it, give it a prior, or observe other poses"
    )
    IMPOSSIBLE_START = "the residuals are not finite at the start: start elsewhere or mend the data"
    DIVERGED = "the derivatives stopped being finite on the way: start nearer or fix a parameter"


@dataclass(frozen=True, eq=False)
class Solution:
    """Where a solve ended: the best parameters (n,) met, whatever the status.

    cost        there (chi^2 of eq 3.113)
    iterations  directions computed
    """

    parameters: Array
    cost: float
    iterations: int
    status: Status

    @property
    def converged(self) -> bool:
        """Whether the parameters are a minimum."""
        return self.status is Status.CONVERGED


Direction = Callable[[Array, Array, float], Array]
"""Residuals (M,), Jacobian (M, n) and damping to a step (n,)."""


def normal_equations(residuals: Array, jacobian: Array, damping: float) -> Array:
    """The thesis's direction: `(H + damping diag H) step = -J^T r`, H = J^T J (eq 3.114 to 3.116).

    Raises numpy's LinAlgError where the matrix is singular.
    """
    H = jacobian.T @ jacobian
    M = H + damping * np.diag(np.diag(H))
    return np.asarray(np.linalg.solve(M, -jacobian.T @ residuals), np.float64)


def orthogonal(residuals: Array, jacobian: Array, damping: float) -> Array:
    """The same step by QR of `[J; sqrt(damping diag H)]`, which keeps twice as many digits."""
    scale = np.sqrt(damping) * np.linalg.norm(jacobian, axis=0)
    Q, R = np.linalg.qr(np.vstack([jacobian, np.diag(scale)]))
    return np.asarray(np.linalg.solve(R, -Q[: len(residuals)].T @ residuals), np.float64)


def levenberg_marquardt(
    problem: Problem,
    start: ArrayLike,
    *,
    direction: Direction = normal_equations,
    damping: float = 1e-3,
    factor: float = 10.0,
    tolerance: float = 1e-12,
    iterations: int = 200,
) -> Solution:
    """Minimise a cost from start (n,).

    A step is accepted if it lowers the cost; then the damping (lambda of eq 3.116) is divided by
    `factor`, else it is multiplied by it and the step tried anew. Converged: the residuals are
    orthogonal to every column of the Jacobian to `tolerance` (a cosine), the first step tried is no
    longer than this share of the parameters' length, or what it promises drowns in rounding.

    Raises:
        InvalidInput: a start that is not a finite vector, settings that make no sense, or a
            problem whose residuals and Jacobian do not fit together.
    """
    p = shaped(start, (None,), "start")
    scalar(damping, "damping", above=0.0)
    scalar(factor, "factor", above=1.0)
    scalar(tolerance, "tolerance", above=0.0)
    count(iterations, "iterations")
    cost = problem.cost(p)
    if not np.isfinite(cost):
        return Solution(p, cost, 0, Status.IMPOSSIBLE_START)
    linear = _linearised(problem, p)
    status = _ended(*linear, tolerance)
    largest = damping * factor**16
    fresh = True
    done = 0
    while status is None:
        step = _step(direction, *linear, damping)
        done += 1
        # A step that only its damping has made short proves nothing.
        if fresh and step is not None and _negligible(linear[1], step, p, cost, tolerance):
            return Solution(p, cost, done, Status.CONVERGED)
        new = problem.cost(p + step) if step is not None else np.inf
        if step is not None and new < cost:
            p, cost, fresh = p + step, new, True
            damping /= factor
            linear = _linearised(problem, p)
            status = _ended(*linear, tolerance)
        else:
            fresh = False
            damping *= factor
            status = Status.NO_BETTER_STEP if damping > largest else None
        if status is None and done == iterations:
            status = Status.TOO_MANY_ITERATIONS
    return Solution(p, cost, done, status)


def _linearised(problem: Problem, p: Array) -> tuple[Array, Array]:
    r, J = problem.residuals(p), problem.jacobian(p)
    if r.ndim != 1 or J.shape != (len(r), len(p)):
        raise InvalidInput(
            f"{len(p)} parameters need residuals (M,) and a Jacobian (M, {len(p)}), got shapes "
            f"{r.shape} and {J.shape}"
        )
    return r, J


def _ended(r: Array, J: Array, tolerance: float) -> Status | None:
    if not (np.isfinite(J).all() and np.isfinite(r).all()):
        return Status.DIVERGED
    length = float(np.linalg.norm(r))
    if length == 0.0:
        return Status.CONVERGED
    columns = np.linalg.norm(J, axis=0)
    if not columns.all():
        return Status.NOT_DETERMINED
    if np.all(np.abs(J.T @ r) <= tolerance * columns * length):
        return Status.CONVERGED
    return None


def _negligible(J: Array, step: Array, p: Array, cost: float, tolerance: float) -> bool:
    short = np.linalg.norm(step) <= tolerance * np.linalg.norm(p)
    return bool(short or np.sum((J @ step) ** 2) <= _ROUNDING * cost)


def _step(direction: Direction, r: Array, J: Array, damping: float) -> Array | None:
    """The step, or None where it cannot be computed."""
    try:
        return finite(direction(r, J, damping), "step")
    except (np.linalg.LinAlgError, InvalidInput):
        return None
