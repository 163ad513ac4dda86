"""What adaptation rules and their rates are said to do."""

from handeye.arrays import Array
from handeye.thesis.records import Records
from handeye.thesis.shapes.comparing import clearly_below, plateau
from handeye.thesis.shapes.finding import Finding, Limits, Shape
from handeye.thesis.units import show

RULES = ("gradient", "virtual-neuron", "cmac")
OTHER_READING = "-h-0.8"

Levels = dict[float, Array]


def best(records: Records, limits: Limits) -> Finding:
    """With the rate that suits each rule best, virtual neurons err least, by `within` at most."""
    held, holds = _best(records, limits, "")
    return Finding(
        held,
        holds,
        f"{_best_listed(records, '')}. With h = 0.8: {_best_listed(records, OTHER_READING)}.",
    )


def _best(records: Records, limits: Limits, reading: str) -> tuple[tuple[bool, ...], bool]:
    gradient, virtual, cmac = (_lowest(_levels(records, rule, reading))[1] for rule in RULES)
    first = clearly_below(virtual, gradient) and clearly_below(virtual, cmac)
    behind = max(gradient.mean(), cmac.mean()) - virtual.mean()
    held = (
        (virtual < gradient)
        & (virtual < cmac)
        & (gradient - virtual <= limits["within"])
        & (cmac - virtual <= limits["within"])
    )
    return tuple(held.tolist()), bool(first and behind <= limits["within"])


def _best_listed(records: Records, reading: str) -> str:
    lowest = {rule: _lowest(_levels(records, rule, reading)) for rule in RULES}
    return ", ".join(
        f"{_words(rule)} {show(level.mean(), 'm')} (rate {rate:g})"
        for rule, (rate, level) in lowest.items()
    )


def rates(records: Records, limits: Limits) -> Finding:
    """No rate is better than the one stated for its rule, and CMAC suffers most from `large`.

    Better: by more than chance gives. Suffers: at the large rate its error is above the others'.
    """
    stated = {rule: limits[rule.replace("-", "_")] for rule in RULES}
    large = limits["large"]
    held, holds = _rates(records, stated, large, "")
    also_holds = _rates(records, stated, large, OTHER_READING)[1]
    levels = {rule: _levels(records, rule, "")[large] for rule in RULES}
    suffers = ", ".join(f"{_words(rule)} {show(v.mean(), 'm')}" for rule, v in levels.items())
    return Finding(
        held,
        holds,
        f"Best: {_best_listed(records, '')}. At rate {large:g}: {suffers}. With h = 0.8 "
        f"{'all of it holds' if also_holds else 'it does not hold either'}: best are "
        f"{_best_listed(records, OTHER_READING)}.",
    )


def _rates(
    records: Records, stated: dict[str, float], large: float, reading: str
) -> tuple[tuple[bool, ...], bool]:
    levels = {rule: _levels(records, rule, reading) for rule in RULES}
    cmac = levels["cmac"][large]
    others = [levels[rule][large] for rule in RULES if rule != "cmac"]
    holds = all(clearly_below(other, cmac) for other in others)
    held = (others[0] < cmac) & (others[1] < cmac)
    for rule, of_rate in levels.items():
        chosen = of_rate[stated[rule]]
        rest = [level for rate, level in of_rate.items() if rate != stated[rule]]
        holds = holds and not any(clearly_below(level, chosen) for level in rest)
        for level in rest:
            held = held & (chosen <= level)
    return tuple(held.tolist()), holds


def _levels(records: Records, rule: str, reading: str) -> Levels:
    """What every rate ends with."""
    settings = records.settings("adaptation")
    names = [s for s in settings if s.startswith(f"{rule}-")]
    names = [s for s in names if s.endswith(OTHER_READING) == bool(reading)]
    return {
        float(s.removeprefix(f"{rule}-").removesuffix(reading)): plateau(
            records, f"adaptation/{s}/error"
        )
        for s in names
    }


def _lowest(levels: Levels) -> tuple[float, Array]:
    return min(levels.items(), key=lambda item: item[1].mean())


def _words(rule: str) -> str:
    return {"cmac": "CMAC"}.get(rule, rule.replace("-", " "))


ADAPTATION: dict[str, Shape] = {"adapt-best": best, "adapt-rates": rates}
"""The predicates of the claims about adaptation, by claim."""
