"""What the plant is said to be like."""

import numpy as np

from handeye.thesis.records import Records
from handeye.thesis.shapes.finding import Finding, Limits, Shape, in_every_replicate
from handeye.thesis.units import digits, scale_for, show


def perturbation_size(records: Records, limits: Limits) -> Finding:
    """On the normal plant the perturbations are as large as stated, give or take `slack` of it.

    Each angular one moves a point at 2 m by at most `angular` (1 + slack), and the range
    perturbation at 3 m is `range` within slack.
    """

    def size(name: str) -> float:
        return float(records.values(f"perturbations/normal/{name}")[0])

    angular = {name: size(name) for name in ("alpha", "beta", "gamma", "eccentricity")}
    radial, slack = size("range"), limits["slack"]
    small = max(angular.values()) <= limits["angular"] * (1.0 + slack)
    reached = abs(radial - limits["range"]) <= limits["range"] * slack
    scale = scale_for(min(angular.values()), "m")
    sizes = ", ".join(f"{name} {show(moved, 'm', scale)}" for name, moved in angular.items())
    return in_every_replicate(
        (small and reached,), f"Largest at 2 m: {sizes}; range at 3 m: {show(radial, 'm', scale)}."
    )


def excluded_region(records: Records, limits: Limits) -> Finding:
    """Leaving out the singular strip loses less than `radius` of the reach, `area` of the area."""
    radius, area = (records.values(f"excluded-region/nominal/{n}")[0] for n in ("radius", "area"))
    return in_every_replicate(
        (bool(radius < limits["radius"] and area < limits["area"]),),
        f"Lost: {show(radius, 'fraction')} of the radius, {show(area, 'fraction')} of the area "
        "that the hand reaches.",
    )


def stays_empty(records: Records, limits: Limits) -> Finding:
    """No neuron is needed, and no parameter moves.

    No replicate allocates more than `neurons`, and none is ever wrong by more than `error`. An
    estimator with an error threshold stays exactly nominal, and one without within `change`.
    """
    neurons, largest, change, forced = (
        records.values(f"exact/clean/{name}")
        for name in ("neurons", "largest_error", "change", "change_without_threshold")
    )
    empty = (neurons <= limits["neurons"]) & (largest <= limits["error"])
    nominal = (change == 0.0) & (forced <= limits["change"])
    return in_every_replicate(
        tuple((empty & nominal).tolist()),
        f"At most {show(np.max(neurons), 'neurons')} and a position error of "
        f"{show(np.max(largest), 'm')}, over all training and test poses. The estimator's largest "
        f"change of a parameter: {digits(np.max(change), 2)} with a threshold for the error, "
        f"{digits(np.max(forced), 2)} without.",
    )


PLANT: dict[str, Shape] = {
    "plant-perturbation-size": perturbation_size,
    "plant-excluded-region": excluded_region,
    "exact-plant-stays-empty": stays_empty,
}
"""The predicates of the claims about the plant, by claim."""
