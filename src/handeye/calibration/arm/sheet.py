"""How far a serial arm may be from its nominal model, as a data sheet states it."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np

from handeye.arrays import Array, Booleans, Integers, count, scalar
from handeye.calibration.arm.kernels import TWIST, SerialArm, joint_at, n_unknowns

_OWN_AXIS = 5
"""The component of a twist that turns about the joint's own axis (shifts along it: 2)."""


@dataclass(frozen=True)
class CurveTerms:
    """How many harmonics each joint's error curves have, of a turn (of two travels, if it slides).

    own     of the error along the joint's own motion: encoder disc, gears
    others  of each of the other five components: bearings that run out, links that bend
    """

    own: int = 36
    others: int = 2

    def __post_init__(self) -> None:
        count(self.own, "harmonics: own", least=0)
        count(self.others, "harmonics: others", least=0)

    def table(self, slides: Booleans) -> Integers:
        """Rows (T, 3): joint, component, harmonic; slides (n,) tells which joints slide."""
        return np.array(
            [
                (j, c, h)
                for j, sliding in enumerate(slides)
                for c in range(TWIST)
                for h in range(1, 1 + (self.own if c == (2 if sliding else 5) else self.others))
            ],
            np.int64,
        ).reshape(-1, 3)

    def ends(self) -> None:
        """Curves that are being learned are held nowhere."""


@dataclass(frozen=True)
class ChosenTerms:
    """Those terms of error curves that a fit has found, each a joint, a component, a harmonic.

    Beyond `low` and `high`, where the joints were seen, curves keep the value of the edge: what a
    series says out there is no more than how it happened to end. Empty for no such limits.
    """

    terms: tuple[tuple[int, int, int], ...]
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()

    @classmethod
    def of(cls, table: Integers, ends: Array | None = None) -> Self:
        """Rows (T, 3) as `CurveTerms.table` has them; ends (2, n) of joints."""
        rows: list[list[int]] = table.tolist()
        low, high = ((), ()) if ends is None else (tuple(end) for end in ends.tolist())
        return cls(tuple((j, c, h) for j, c, h in rows), low, high)

    def ends(self) -> Array | None:
        """(2, n), if there are any."""
        return np.array([self.low, self.high]) if self.low else None

    def table(self, slides: Booleans) -> Integers:  # noqa: ARG002
        """Rows (T, 3): joint, component, harmonic."""
        return np.array(self.terms, np.int64).reshape(-1, 3)


@dataclass(frozen=True)
class ArmSheet:
    """Manufacturing tolerances of a serial arm and its set-up, as standard deviations.

    base_shift, base_turn      base of the sensor from its fitted placement [m], [rad]
    marker_shift, marker_turn  marker on the flange from its fitted placement [m], [rad]
    shift, turn                placement of each joint: lengths [m] and directions [rad] of links
    zero                       zero of each joint [rad]; of one that slides `shift` counts
    scale                      of each joint, a number
    compliance                 of each joint under the load of gravity [rad/Nm]; 0 for a stiff arm
    curve_shift, curve_turn    error curves of each joint at one turn per turn [m], [rad]
    own_turn                   the same about the joint's own axis [rad]
    fall                       a harmonic h is expected to be smaller by h to this power
    own_fall                   the same about the joint's own axis: gears repeat many times a turn
    unexplained                what the model leaves over, at first [m]; of a turn, this over a
                               third of the arm's reach. Adjusted by what is seen, never below
                               `resolution`
    resolution                 the least of it [m]
    curves                     how many harmonics the error curves have, or which

    The defaults are those of ordinary industrial arms and cobots.

    Raises InvalidInput unless all are positive (compliance: at least 0).
    """

    base_shift: float = 0.02
    base_turn: float = 0.02
    marker_shift: float = 0.02
    marker_turn: float = 0.05
    shift: float = 1e-3
    turn: float = 1.5e-3
    zero: float = 1e-2
    scale: float = 1e-4
    compliance: float = 2e-5
    curve_shift: float = 1e-4
    curve_turn: float = 2e-4
    own_turn: float = 3e-4
    fall: float = 1.0
    own_fall: float = 1.0
    unexplained: float = 1e-4
    resolution: float = 1e-5
    curves: CurveTerms | ChosenTerms = CurveTerms()

    def __post_init__(self) -> None:
        for field in fields(self):
            name, value = f"arm sheet: {field.name}", getattr(self, field.name)
            if field.name == "curves":
                continue
            if field.name == "compliance":
                scalar(value, name, least=0.0)
            else:
                scalar(value, name, above=0.0)

    @classmethod
    def restored(cls, parts: Mapping[str, Any]) -> Self:
        """The sheet of `dataclasses.asdict`."""
        numbers = {name: value for name, value in parts.items() if name != "curves"}
        curves = dict(parts["curves"])
        if "terms" in curves:
            ends = np.array([curves["low"], curves["high"]]) if curves.get("low") else None
            return cls(curves=ChosenTerms.of(np.array(curves["terms"]), ends), **numbers)
        return cls(curves=CurveTerms(**curves), **numbers)

    def tolerances(self, kernel: SerialArm) -> Array:
        """Standard deviations (n_x,) of the priors of an arm's unknowns."""
        out = np.empty(n_unknowns(kernel))
        out[:TWIST] = np.repeat([self.base_shift, self.base_turn], 3)
        out[TWIST : joint_at(kernel, 0)] = np.repeat([self.marker_shift, self.marker_turn], 3)[
            : kernel.n_marker
        ]
        for j, slides in enumerate(kernel.slides):
            at = joint_at(kernel, j)
            out[at : at + TWIST] = np.repeat([self.shift, self.turn], 3)
            if not slides:
                out[at + _OWN_AXIS] = self.zero
            out[at + TWIST] = self.scale
            if kernel.compliant:
                out[at + TWIST + 1] = self.compliance
        at = joint_at(kernel, len(kernel.slides))
        for i, (j, component, harmonic) in enumerate(kernel.terms):
            own = component == (2 if kernel.slides[j] else _OWN_AXIS)
            first = self.curve_shift if component < 3 else self.curve_turn
            if own and not kernel.slides[j]:
                first = self.own_turn
            out[at + 2 * i : at + 2 * i + 2] = first / harmonic ** (
                self.own_fall if own else self.fall
            )
        return out
