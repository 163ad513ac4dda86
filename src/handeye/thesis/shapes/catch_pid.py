"""What is said of the PID controller that follows the ball."""

from functools import partial

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.thesis.records import Records
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import Scale, show

OTHERS = {
    "exact-": "With an arm that moves as the held voltage makes it",
    "mistuned-": "By Euler steps with the gains of the light arm and a start below the ball",
}
"""Other ways of doing it that are told, by the beginning of the setting's name."""

_PERCENT, _CENTIMETRES = Scale("%", 1e2), Scale("cm", 1e2)


def follows_the_ball(records: Records, limits: Limits, *, setting: str) -> Finding:
    """The controller catches the shares that are stated, with the stated errors.

    Of every stated quantity of a ball, a share caught in the twenty throws is met within `share`,
    an error at the crossing within `slack` of it. The verdict is on the means over replicates.
    """

    def near(name: str, values: Array) -> Booleans:
        stated = limits[name]
        room = limits["share"] if name.endswith("caught") else limits["slack"] * abs(stated)
        return np.abs(values - stated) <= room

    stated = [name for name in limits if name.startswith(("light_", "heavy_"))]
    found = {name: records.values(f"catch-pid/{setting}/{name}_20") for name in stated}
    each = np.array([near(name, values) for name, values in found.items()])
    means = np.array([near(name, values.mean(keepdims=True)) for name, values in found.items()])
    others = "".join(
        f" {words}: {_told(records, f'{way}{setting}')}." for way, words in OTHERS.items()
    )
    return Finding(
        tuple(np.all(each, axis=0).tolist()),
        bool(np.all(means)),
        f"Measured: {_told(records, setting)}.{others}",
    )


def _told(records: Records, setting: str) -> str:
    """What became of both balls."""
    return "; ".join(
        f"{ball} ball {_percent(records, setting, ball, 'caught_20')} of twenty throws caught "
        f"({_percent(records, setting, ball, 'caught')} of fresh ones), rms "
        f"{_length(records, setting, ball, 'rms_20')}, mean "
        f"{_length(records, setting, ball, 'mean_20')}"
        for ball in ("light", "heavy")
    )


def _mean(records: Records, setting: str, ball: str, quantity: str) -> float:
    return float(records.values(f"catch-pid/{setting}/{ball}_{quantity}").mean())


def _percent(records: Records, setting: str, ball: str, quantity: str) -> str:
    return show(_mean(records, setting, ball, quantity), "fraction", _PERCENT)


def _length(records: Records, setting: str, ball: str, quantity: str) -> str:
    return show(_mean(records, setting, ball, quantity), "m", _CENTIMETRES)


CATCH_PID: dict[str, Shape] = {
    claim: partial(follows_the_ball, setting=setting)
    for claim, setting in {
        "pid-track-06": "ball-0.6",
        "pid-track-01": "ball-0.1",
        "pid-track-0018": "ball-0.018",
    }.items()
}
"""The predicates of the claims about the controller, by claim."""
