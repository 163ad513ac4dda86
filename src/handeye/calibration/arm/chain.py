"""A serial arm's chain for the engine: unknowns in words, tolerances, parts and changes."""

import numpy as np

from handeye.calibration.arm.kernels import TWIST, SerialArm, joint_at, n_unknowns
from handeye.calibration.arm.residuals import measured_at
from handeye.calibration.arm.sheet import ArmSheet
from handeye.calibration.engine.chain import Chain, Group

_AXES = ("shift x", "shift y", "shift z", "turn x", "turn y", "turn z")
_UNITS = ("m", "m", "m", "rad", "rad", "rad")
_OWN_TURN, _OWN_SHIFT = 5, 2


def arm_chain(kernel: SerialArm, joint_names: tuple[str, ...], sheet: ArmSheet) -> Chain:
    """What the engine is told of an arm.

    Directions in which the parts of an arm cannot be told from each other (a base that moves from
    a first link that is bent) are left to the priors: the posterior says how well all are known.
    """
    n, m = len(joint_names), kernel.n_marker
    names = [f"base {axis}" for axis in _AXES] + [f"marker {axis}" for axis in _AXES[:m]]
    units = [*_UNITS, *_UNITS[:m]]
    base = Group("base of the sensor", tuple(range(TWIST)))
    marker = Group("marker on the flange", tuple(range(TWIST, TWIST + m)))
    groups = [base, marker]
    offsets: list[Group] = []
    curves: dict[int, list[int]] = {j: [] for j in range(n)}
    for j, name in enumerate(joint_names):
        at, slides = joint_at(kernel, j), bool(kernel.slides[j])
        own = at + (_OWN_SHIFT if slides else _OWN_TURN)
        places = range(at, at + TWIST)
        axes = zip(places, _AXES, strict=True)
        names += [f"{name} {'zero' if p == own else axis}" for p, axis in axes]
        units += [*_UNITS, ""]
        names.append(f"{name} scale")
        offsets.append(Group(f"encoder offset of joint {name}", (own,)))
        rest = tuple(p for p in places if p != own)
        groups.append(Group(f"placement of joint {name}", rest))
        groups.append(Group(f"scale of joint {name}", (at + TWIST,)))
        if kernel.compliant:
            names.append(f"{name} compliance")
            units.append("m/N" if slides else "rad/Nm")
            groups.append(Group(f"compliance of joint {name}", (at + TWIST + 1,)))
    at = joint_at(kernel, n)
    terms: list[list[int]] = kernel.terms.tolist()
    for i, (j, component, harmonic) in enumerate(terms):
        for k, wave in enumerate(("cos", "sin")):
            names.append(f"{joint_names[j]} {_AXES[component]}, {wave} {harmonic}")
            units.append(_UNITS[component])
            curves[j].append(at + 2 * i + k)
    groups += offsets
    groups += [
        Group(f"error curves of joint {joint_names[j]}", tuple(places))
        for j, places in curves.items()
        if places
    ]
    total = n_unknowns(kernel)
    return Chain(
        kernel=kernel,
        names=tuple(names),
        units=tuple(units),
        nominal=np.zeros(total),
        tolerance=sheet.tolerances(kernel),
        curved=np.arange(total) >= at,
        n_moving=TWIST + m,
        n_values=6 if kernel.oriented else 3,
        n_hand=3,
        n_seen=measured_at(kernel) + (10 if kernel.oriented else 6),
        groups=tuple(groups),
        changes=(
            *offsets,
            base,
            marker,
            Group("base of the sensor and marker on the flange", base.places + marker.places),
        ),
        gauges=(),
    )
