"""How a network is said to follow a plant that changes."""

import numpy as np

from handeye.arrays import Array
from handeye.thesis.analysis.first_order import amplitude_ratio, phase_lead
from handeye.thesis.records import Records
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import digits, show


def noisy_fixed_point(records: Records, limits: Limits) -> Finding:
    """The output follows the recursion, and ends at the target less the mean noise.

    With and without a bias in the noise its rms distance from the recursion is at most `follows` of
    the way that it goes. With a bias its mean in the end is at most `share` of the mean noise away
    from the target less the mean noise. The verdict is on the means over replicates.
    """

    def found(setting: str, name: str) -> Array:
        return records.values(f"fixed-point/{setting}/{name}")

    misfits = np.stack([found(setting, "misfit") for setting in ("centered", "biased")])
    noise, gap = found("biased", "mean_noise"), found("biased", "mean_gap")
    held = np.all(misfits <= limits["follows"], axis=0) & (gap <= limits["share"] * noise)
    misfit, away = float(misfits.mean(axis=1).max()), float(gap.mean() / noise.mean())
    curved = float(found("biased", "curved_gap").mean() / noise.mean())
    below = float(found("threshold", "misfit").mean())
    return Finding(
        tuple(held.tolist()),
        misfit <= limits["follows"] and away <= limits["share"],
        f"Recursion and output differ by {show(misfit, 'fraction')} of the way to the target, and "
        f"the end from the target less the mean noise by {show(away, 'fraction')} of the mean "
        f"noise (at most {show((gap / noise).max(), 'fraction')}; {show(curved, 'fraction')} if "
        "the output's curvature is counted, which the model leaves out). With the preferred "
        f"network's learning threshold, left out too, they differ by {show(below, 'fraction')} "
        "of the way.",
    )


def first_order_bode(records: Records, limits: Limits) -> Finding:
    """At every period the measured response is that of a first-order model, within limits.

    The amplitude ratio is within `decibels` and the lead within `degrees` of eq 3.104 and 3.105
    with the time constant of the step response. Both are of the signed share of the displacement
    that is left; the verdict is on the means over replicates.
    """
    taus = records.values("step/virtual-200/share_time_constant")
    periods, ratios = records.curve("periodic/200/share_ratio")
    _, leads = records.curve("periodic/200/share_lead")
    responses = ratios * np.exp(1j * leads)

    def off(response: Array, tau: float) -> tuple[Array, Array]:
        level = 20.0 * np.log10(np.abs(response) / amplitude_ratio(periods, tau))
        turn = np.angle(response * np.exp(-1j * phase_lead(periods, tau)), deg=True)
        return level, turn

    def holds(level: Array, turn: Array) -> bool:
        near = (np.abs(level) <= limits["decibels"]) & (np.abs(turn) <= limits["degrees"])
        return bool(near.all())

    held = tuple(holds(*off(r, t)) for r, t in zip(responses, taus, strict=True))
    mean, tau = responses.mean(axis=0), float(taus.mean())
    level, turn = off(mean, tau)
    decibels = 20.0 * np.log10(np.abs(mean))
    slope = (decibels[-1] - decibels[-2]) / np.log10(periods[-1] / periods[-2])
    _, plain = records.curve("periodic/200/ratio")
    plain_tau = float(records.values("step/virtual-200/time_constant").mean())
    plain_off = 20.0 * np.log10(plain.mean(axis=0) / amplitude_ratio(periods, plain_tau))
    each = "; ".join(
        f"period {p:.0f}: {a:+z.1f} dB, {b:+z.0f} degrees"
        for p, a, b in zip(periods, level, turn, strict=True)
    )
    return Finding(
        held,
        holds(level, turn),
        f"Measured minus predicted with the step's time constant, {show(tau, 'trials')}: {each}. "
        f"Between the longest periods it falls by {-slope:.0f} dB per decade. Of the mean error's "
        f"length (eq 3.106, {show(plain_tau, 'trials')}) the amplitude differs by "
        + ", ".join(f"{a:+z.1f}" for a in plain_off)
        + " dB.",
    )


def time_constant_by_neurons(records: Records, limits: Limits) -> Finding:
    """More neurons make the virtual-neuron rule slower, and gradient descent hardly change.

    The time constant of the position error grows from each number of neurons to the next under the
    first, and stays within `hardly` of that of the smallest network under the second. The verdict
    is on the means over replicates.
    """

    def taus(rule: str) -> tuple[list[int], Array]:
        names = [s for s in records.settings("step") if s.startswith(f"{rule}-")]
        sizes = sorted(int(name.split("-")[1]) for name in names)
        values = [records.values(f"step/{rule}-{size}/time_constant") for size in sizes]
        return sizes, np.array(values)

    def holds(virtual: Array, gradient: Array) -> bool:
        change = np.abs(gradient / gradient[0] - 1.0)
        return bool(np.all(np.diff(virtual) > 0.0) and np.all(change <= limits["hardly"]))

    def listed(sizes: list[int], values: Array) -> str:
        means = zip(sizes, values.mean(axis=1), strict=True)
        return ", ".join(f"{digits(tau, 3)} ({size})" for size, tau in means)

    (v_sizes, virtual), (g_sizes, gradient) = taus("virtual"), taus("gradient")
    return Finding(
        tuple(holds(v, g) for v, g in zip(virtual.T, gradient.T, strict=True)),
        holds(virtual.mean(axis=1), gradient.mean(axis=1)),
        f"Trials (neurons): virtual neuron {listed(v_sizes, virtual)}; gradient descent "
        f"{listed(g_sizes, gradient)}.",
    )


DRIFT: dict[str, Shape] = {
    "noisy-fixed-point": noisy_fixed_point,
    "bode-first-order": first_order_bode,
    "time-constant-neurons": time_constant_by_neurons,
}
"""The predicates of the claims about drift and noise, by claim."""
