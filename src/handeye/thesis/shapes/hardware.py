"""What appendix B says of its rules on a chip."""

from collections.abc import Iterable

import numpy as np

from handeye.arrays import Array
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import plateau
from handeye.thesis.shapes.finding import Finding, Limits, Shape, in_every_replicate
from handeye.thesis.units import show

RULES = ("virtual-neuron", "cmac")
NAMES = ("virtual neuron", "CMAC")
NOISES = ("clean", "noisy")


def rules(records: Records, limits: Limits) -> Finding:
    """One division a trial, what a chip learns is as good, and a grid with one width suffices.

    As good: with words of `word_length` bits the error ends at most `loss` above that of double
    precision. Suffices: on a grid of neurons, and in these words, one fixed virtual width ends at
    most `loss` above the width that follows the nearest neuron. In all of this learning leaves at
    most the part `left` of the uncorrected error.
    """
    bits = f"{limits['word_length']:g}"
    loss = 1.0 + limits["loss"]
    chips = [s for s in records.settings("hardware") if not s.endswith("float")]
    divisions = [records.values(f"hardware/{chip}/divide") for chip in chips]
    costs: list[Array] = []
    learned: list[Array] = []
    for noise in NOISES:
        for rule in RULES:
            chip, floating = (_level(records, f"{rule}-{noise}-{a}") for a in (bits, "float"))
            costs.append(chip / floating)
            learned.append(chip / _uncorrected(records, f"{rule}-{noise}-{bits}"))
        nearest, one = (
            _level(records, f"grid-{w}-{noise}-{bits}") for w in ("nearest", "one-width")
        )
        costs.append(one / nearest)
        learned.append(one / _uncorrected(records, f"grid-one-width-{noise}-{bits}"))
    held = (
        np.all(np.equal(divisions, 1.0), axis=0)
        & (np.max(costs, axis=0) <= loss)
        & (np.max(learned, axis=0) <= limits["left"])
    )
    return in_every_replicate(tuple(held.tolist()), _note(records, bits, loss))


def _note(records: Records, bits: str, loss: float) -> str:
    parts = [
        f"{name} {noise}: {bits} bits "
        f"{_shown(records, f'{rule}-{noise}-{bits}')}, double precision "
        f"{_shown(records, f'{rule}-{noise}-float')}"
        for rule, name in zip(RULES, NAMES, strict=True)
        for noise in NOISES
    ]
    parts += [
        f"grid {noise}: one width {_shown(records, f'grid-one-width-{noise}-{bits}')}, "
        f"by the nearest {_shown(records, f'grid-nearest-{noise}-{bits}')}"
        for noise in NOISES
    ]
    single, paired = (
        records.values(f"hardware/virtual-neuron-clean-{bits}/{name}").mean()
        for name in ("phases_single", "phases")
    )
    shortest = ", ".join(
        f"{name}{words} {_shortest(records, rule, suffix, loss)}"
        for rule, name in zip(RULES, NAMES, strict=True)
        for suffix, words in (("", ""), ("-random", " rounded at random"))
    )
    return (
        f"{_sentence(parts)} Bits that suffice for an error within {100.0 * (loss - 1.0):.0f} % of "
        f"double precision, with noise and without: {shortest}. Phases in a row of a "
        f"virtual-neuron trial: {paired:g} with paired neurons, {single:g} with single ones. What "
        "is counted are products, sums, comparisons, shifts, table reads and divisions: the rules "
        "have nothing else."
    )


def _shortest(records: Records, rule: str, rounding: str, loss: float) -> str:
    """The shortest words that are as good as double precision, all longer ones included."""
    lengths = sorted(
        int(setting.rpartition("-")[2])
        for setting in records.settings("hardware")
        if setting.startswith(f"{rule}{rounding}-clean-") and not setting.endswith("float")
    )
    enough = "more than there are"
    for length in reversed(lengths):
        costs = [
            _level(records, f"{rule}{rounding}-{noise}-{length}").mean()
            / _level(records, f"{rule}-{noise}-float").mean()
            for noise in NOISES
        ]
        if max(costs) > loss:
            break
        enough = str(length)
    return enough


def _sentence(parts: Iterable[str]) -> str:
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}."


def _shown(records: Records, setting: str) -> str:
    return show(float(_level(records, setting).mean()), "m")


def _level(records: Records, setting: str) -> Array:
    return plateau(records, f"hardware/{setting}/error")


def _uncorrected(records: Records, setting: str) -> Array:
    return plateau(records, f"hardware/{setting}/uncorrected")


HARDWARE: dict[str, Shape] = {"hardware-rules": rules}
"""The predicate of the claim about hardware."""
