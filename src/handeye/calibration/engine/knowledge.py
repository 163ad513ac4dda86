"""How well the unknowns are known, what the observations do not tell, and how the robot is."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.calibration.engine.chain import Chain
from handeye.calibration.engine.engine import Engine

# A direction counts as determined once observations tell more about it than the priors do.
_DETERMINED = np.sqrt(0.5)
_RECENT = 100


@dataclass(frozen=True, eq=False)
class PartKnowledge:
    """One part of the robot: its most changed unknown, and how well the part is known.

    change, std  of that unknown, in `unit`
    known        share of the prior uncertainty that observations have taken away, 0 to 1, in the
                 mean over the part's unknowns
    """

    words: str
    unknown: str
    change: float
    std: float
    unit: str
    known: float


@dataclass(frozen=True, eq=False)
class RobotKnowledge:
    """What is known of a robot.

    names, units  of n unknowns
    values        (n,) deviations from nominal
    covariance    (n, n)
    parts         the same by parts
    undetermined  directions that the priors decide rather than the observations, in words
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: Array
    covariance: Array
    parts: tuple[PartKnowledge, ...]
    undetermined: tuple[str, ...]

    @property
    def std(self) -> Array:
        """Standard deviations (n,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def status(self) -> str:
        """What is determined, and what to do about the rest."""
        if not self.undetermined:
            return "every parameter is determined by the observations"
        lines = "; ".join(self.undetermined)
        return (
            f"not determined by the observations, so that the priors decide: {lines}. Commands are "
            "good where the hand has worked; elsewhere ask `covariance`, and `suggest` for poses"
        )


def robot_knowledge(engine: Engine) -> RobotKnowledge:
    """Summarise an engine's belief."""
    chain, covariance = engine.chain, engine.covariance()
    std = np.sqrt(np.diag(covariance))
    parts: list[PartKnowledge] = []
    for group in chain.groups:
        places = np.array(group.places)
        scaled = engine.x[places] / chain.tolerance[places]
        most = int(places[np.argmax(np.abs(scaled))])
        known = float(np.mean(1.0 - np.minimum(std[places] / chain.tolerance[places], 1.0)))
        change = float(engine.x[most])
        unit = chain.units[most]
        parts.append(
            PartKnowledge(group.words, chain.names[most], change, float(std[most]), unit, known)
        )
    return RobotKnowledge(
        chain.names, chain.units, engine.x.copy(), covariance, tuple(parts),
        _undetermined(chain, covariance),
    )  # fmt: skip


def _undetermined(chain: Chain, covariance: Array) -> tuple[str, ...]:
    """Gauges, and parameters (not terms of curves) whose prior has hardly narrowed."""
    words = [gauge.words for gauge in chain.gauges]
    scaled = covariance / np.outer(chain.tolerance, chain.tolerance)
    plain = np.flatnonzero(~chain.curved)
    block = scaled[np.ix_(plain, plain)]
    basis = np.array([gauge.direction[plain] for gauge in chain.gauges]).reshape(-1, len(plain))
    if len(basis):
        q = np.linalg.qr(basis.T).Q
        away = np.eye(len(plain)) - q @ q.T
        block = away @ block @ away
    return (*words, *open_directions([chain.names[k] for k in plain], block))


def open_directions(names: Sequence[str], scaled: Array) -> tuple[str, ...]:
    """Directions in which priors have hardly narrowed, the most open first, in words.

    scaled (n, n): covariance of the unknowns of these names, in their tolerances.
    """
    words: list[str] = []
    sizes, directions = np.linalg.eigh(scaled)
    for size, direction in zip(sizes[::-1], directions.T[::-1], strict=True):
        if np.sqrt(size) < _DETERMINED:
            break
        order: list[int] = np.argsort(-np.abs(direction)).tolist()
        words.append(" with ".join(names[k] for k in order if abs(direction[k]) > 0.3))
    return tuple(words)


def health(engine: Engine, falling_back: bool, network_used: bool) -> str:
    """The state of a robot in words, for a person."""
    n, window = engine.n_observations, engine.settings.window
    if n == 0:
        return "nothing observed yet: commands are nominal"
    inside = engine.recent_slots(window)
    rejected = np.count_nonzero(engine.bank.weights[inside] == 0.0) / len(inside)
    way = engine.settings.hypotheses[engine.leader].words
    lines = [f"{n} observations; the robot is {way} ({engine.shares[engine.leader]:.0%} sure)"]
    if falling_back:
        lines.append("commands fall back to nominal: recent corrections were worse than none")
    if rejected > 0.05:
        lines.append(f"{rejected:.0%} of recent observations did not fit and were left out")
    if engine.leaves_something:
        lines.append(
            f"the model leaves about {engine.doubt:.2g} (rad, m) unexplained: something is not in "
            "the model, or the sensor is noisier than its data sheet says"
        )
    if network_used:
        lines.append("a network corrects what the model leaves over")
    recent = [
        e for e in engine.events if e.kind in {"change", "lost"} and e.observation > n - _RECENT
    ]
    lines += [str(event) for event in recent[-3:]]
    return "; ".join(lines)
