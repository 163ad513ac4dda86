"""What a calibrator is told about a robot: its chain, and how it acts and errs."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from handeye.arrays import Array
from handeye.calibration.engine.chain import Chain
from handeye.calibration.engine.settings import Settings
from handeye.networks.inputs import InputSpace


class Acting(NamedTuple):
    """How commands are made.

    x (n,) unknowns; correct: network inputs (N, d) to the misses (N, m) that are left [m], if it is
    used; envelope: the hand goes at most so far from where the nominal robot would bring it [m].
    """

    x: Array
    correct: Callable[[Array], Array] | None
    envelope: float


class Judged(NamedTuple):
    """What the nominal and the learned robot would have made of an observation of the hand.

    misses (2, m) [m], where the hand was seen minus where it would have been put; joints (2, q) of
    the two.
    """

    misses: Array
    joints: Array


class Robot(Protocol):
    """One kind of robot. Rows are observations as the kernels of its chain read them, (w,)."""

    @property
    def chain(self) -> Chain:
        """For the engine."""
        ...

    @property
    def doubt(self) -> tuple[float, float]:
        """What its model leaves unexplained, at first and at least."""
        ...

    @property
    def settings(self) -> Settings:
        """How to learn, unless a user says otherwise."""
        ...

    @property
    def space(self) -> InputSpace:
        """Of the inputs of a network for what remains, d of them."""
        ...

    @property
    def n_outputs(self) -> int:
        """Components m of a miss, which is what that network predicts."""
        ...

    def seen_rows(self, observations: Any) -> Array:
        """One observation (w,) or N (N, w)."""
        ...

    def target_rows(self, target: Any) -> Array:
        """The same of targets, without what only an observation can tell."""
        ...

    def posed_rows(self, rows: Array, joints: Array) -> Array:
        """Targets (N, w) with the joints (N, q) that they will be reached with."""
        ...

    def judge(self, x: Array, row: Array, envelope: float) -> Judged:
        """What two commanders would have made of an observation."""
        ...

    def inputs(self, row: Array, judged: Judged) -> Array:
        """Of the network (d,), when it is to say what is left of an observation."""
        ...

    def explained(self, row: Array, shift: Array) -> Array:
        """The observation (w,) had the hand not been shifted (m,) by what the network explains."""
        ...

    def errors(self, acting: Acting, rows: Array) -> Array:
        """Misses (N, m) on observations (N, w)."""
        ...

    def commands(self, acting: Acting, rows: Array) -> Array:
        """Joints (N, q) for targets (N, w)."""
        ...

    def candidates(self, x: Array, region: Any, n: int) -> tuple[Array, Array]:
        """n poses of a region, (n, q + 1), joints and eccentricity; and what is seen there, (n, w).

        Raises InvalidInput for a region of another kind.
        """
        ...

    def corrected(self, x: Array) -> Any:
        """The nominal robot with constants of x (n,), and none of its learned curves."""
        ...
