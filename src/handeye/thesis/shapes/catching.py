"""What is said of learning to catch."""

import numpy as np

from handeye.arrays import Array, Booleans
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import clearly_below
from handeye.thesis.shapes.finding import Finding, Limits, Shape, in_every_replicate
from handeye.thesis.units import Scale, digits, show

LEARNED = "catching/thesis"
BALLS = ("light", "heavy")
SURPRISES = {
    "bounce": "a bounce off the ground",
    "collision": "a collision with the cup",
    "changed_arm": "an arm that is not the one believed",
}
_CENTIMETRES = Scale("cm", 1e2)


def neurons(records: Records, limits: Limits) -> Finding:
    """Every network has as many neurons as is stated, within a factor of `factor`.

    The other limits are the stated numbers by network. The verdict is on the means over replicates.
    """
    stated = {name: number for name, number in limits.items() if name != "factor"}
    found = {name: records.values(f"{LEARNED}/{name}_neurons") for name in stated}
    ratios = np.array([found[name] / number for name, number in stated.items()])

    def near(ratio: Array) -> Booleans:
        return (ratio <= limits["factor"]) & (ratio >= 1.0 / limits["factor"])

    told = ", ".join(
        f"{name.replace('_', ' ')} {show(values.mean(), 'neurons')}"
        for name, values in found.items()
    )
    return Finding(
        tuple(np.all(near(ratios), axis=0).tolist()),
        bool(np.all(near(ratios.mean(axis=1)))),
        f"Measured: {told}.",
    )


def predicts_the_crossing(records: Records, limits: Limits) -> Finding:
    """From `soon` of the flight on, place and time are well predicted, and better towards its end.

    For both balls the rms errors at each tested moment from then on are at most `place` and
    `time`, and smaller at the last moment than at the first from which the memory suffices. The
    verdict is on the means over replicates.
    """
    curves = {
        (ball, what): records.curve(f"{LEARNED}/{ball}_{what}_error")
        for ball in BALLS
        for what in ("place", "time")
    }

    def good(what: str, at: Array, error: Array) -> Booleans:
        """Over replicates, from errors (replicates, M)."""
        late = error[:, at >= limits["soon"]]
        return (late.max(axis=1) <= limits[what]) & (error[:, -1] < error[:, 0])

    held = [good(what, at, error) for (_, what), (at, error) in curves.items()]
    means = [
        good(what, at, error.mean(axis=0, keepdims=True))[0]
        for (_, what), (at, error) in curves.items()
    ]
    told = "; ".join(
        f"{ball} ball: {_course(curves[ball, 'place'], limits, 'm')}, "
        f"{_course(curves[ball, 'time'], limits, 's')}"
        for ball in BALLS
    )
    return Finding(
        tuple(np.all(held, axis=0).tolist()),
        all(means),
        f"Rms errors of place and time at first, after {show(limits['soon'], 'fraction')} of the "
        f"flight and last, {told}.",
    )


def another_pursuit_helps(records: Records, limits: Limits) -> Finding:
    """While the arm knows little, more is caught if one pursuit may follow another.

    The mean share of fresh throws caught after up to `few` pursuits of practice is clearly higher:
    the whole 95 % interval of its differences over replicates is above zero.
    """
    at, single = records.curve(f"{LEARNED}/pursuits_caught")
    _, repeated = records.curve(f"{LEARNED}/repeated_caught")
    little = at <= limits["few"] * at[-1]
    once, again = (caught[:, little].mean(axis=1) for caught in (single, repeated))
    told = ", ".join(
        f"{show(after, 'trials')}: {show(one, 'fraction')} and {show(more, 'fraction')}"
        for after, one, more in zip(at, single.mean(axis=0), repeated.mean(axis=0), strict=True)
    )
    return Finding(
        tuple((again > once).tolist()),
        clearly_below(once, again),
        f"Caught with one pursuit and with more, after {told}.",
    )


def mentor_helps(records: Records, limits: Limits) -> Finding:
    """After the mentor's throws the arm stops nearer, catches no less, and comes when it should.

    In fresh throws: the rms error is clearly lower than before, by the whole 95 % interval of its
    differences over replicates; the mean share caught is no lower; and the arm arrives `early`
    before the ball, give or take `room`, on average.
    """
    before, after = (
        {name: records.values(f"{LEARNED}/{way}_{name}") for name in ("rms", "caught", "early")}
        for way in ("pursuits", "mentored")
    )
    nearer, as_many = after["rms"] < before["rms"], after["caught"] >= before["caught"]
    early = after["early"]
    in_time = np.abs(early - limits["early"]) <= limits["room"]
    on_average = abs(float(early.mean()) - limits["early"]) <= limits["room"]
    told = "; ".join(
        f"{words} " + " and ".join(show(way[name].mean(), unit, scale) for way in (before, after))
        for words, name, unit, scale in (
            ("rms error", "rms", "m", _CENTIMETRES),
            ("caught", "caught", "fraction", None),
            ("arrival before the ball by", "early", "s", None),
        )
    )
    return Finding(
        tuple((nearer & as_many & in_time).tolist()),
        clearly_below(after["rms"], before["rms"])
        and bool(after["caught"].mean() >= before["caught"].mean())
        and on_average,
        f"In fresh throws before the mentor's and after them, {told}.",
    )


def notices(records: Records, limits: Limits) -> Finding:
    """Bounce, collision and changed arm are each noticed within `ticks` in `share` of the cases."""
    within = {
        name: records.values(f"{LEARNED}/{name}_noticed@{limits['ticks']:g}") for name in SURPRISES
    }
    held = np.all([values >= limits["share"] for values in within.values()], axis=0)
    holds = all(float(values.mean()) >= limits["share"] for values in within.values())
    told = "; ".join(
        f"{words}: {show(within[name].mean(), 'fraction')}" for name, words in SURPRISES.items()
    )
    return Finding(
        tuple(held.tolist()),
        holds,
        f"Noticed within {limits['ticks']:g} ticks, {told}. Without cause the flag for the ball is "
        f"lowered in {show(records.values(f'{LEARNED}/false_alarms').mean(), 'fraction')} of the "
        "flights.",
    )


def does_not_move(records: Records, limits: Limits) -> Finding:
    """A learner without experience issues no voltage above `voltage`, and its arm stays."""
    voltage, travel = (records.values(f"{LEARNED}/fresh_{n}") for n in ("voltage", "travel"))
    return in_every_replicate(
        tuple(((voltage <= limits["voltage"]) & (travel <= limits["travel"])).tolist()),
        f"Largest voltage {digits(float(voltage.max()), 2)} V, largest movement "
        f"{show(float(travel.max()), 'm')}.",
    )


def smoother(records: Records, limits: Limits) -> Finding:
    """The profile generator's voltages are smoother, and as much is caught within `loss`.

    Over all four combinations the mean change of voltage from tick to tick is smaller in each
    replicate; the share caught is lower by `loss` at most, on the mean over replicates.
    """
    rough, smooth, spiky_caught, smooth_caught = (
        records.values(f"catch-improved/{setting}/mean_{name}")
        for name in ("roughness", "caught")
        for setting in ("improved", "smooth")
    )
    kept = smooth_caught - spiky_caught + limits["loss"]
    return Finding(
        tuple(((smooth < rough) & (kept >= 0.0)).tolist()),
        bool(np.all(smooth < rough)) and bool(kept.mean() >= 0.0),
        f"Change of voltage from tick to tick {digits(float(smooth.mean()), 2)} V, with the "
        f"networks' own voltages {digits(float(rough.mean()), 2)} V; caught "
        f"{show(smooth_caught.mean(), 'fraction')} and {show(spiky_caught.mean(), 'fraction')}.",
    )


def _course(curve: tuple[Array, Array], limits: Limits, unit: str) -> str:
    """First, early and last of errors (replicates, M) over the flight."""
    at, values = curve
    mean = values.mean(axis=0)
    soon = float(mean[at >= limits["soon"]][0])
    scale = _CENTIMETRES if unit == "m" else Scale("ms", 1e3)
    return ", ".join(show(value, unit, scale) for value in (mean[0], soon, mean[-1]))


CATCHING: dict[str, Shape] = {
    "ball-nets": neurons,
    "crossing-prediction": predicts_the_crossing,
    "mentor": mentor_helps,
    "repeated-pursuit": another_pursuit_helps,
    "surprise": notices,
    "before-learning": does_not_move,
    "smooth-commands": smoother,
}
"""The predicates of the claims about catching, by claim."""
