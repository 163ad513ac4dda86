"""Earlier hand-eye learners and today's by the trials that they need, as a table."""

import numpy as np

from handeye.arrays import Array
from handeye.thesis.experiments.earlier import PLANTS, TRIALS
from handeye.thesis.judge import t_interval
from handeye.thesis.reaching import trials_to
from handeye.thesis.records import Records
from handeye.thesis.units import show, show_interval

LEVELS = (0.05, 0.02, 0.01)
"""Mean position errors [m] to be reached."""

WORDS = {
    "kuperstein": "Kuperstein-type map",
    "murphy": "MURPHY-type table",
    "albus": "Correction by Albus's CMAC",
    "network": "Correction by the preferred network",
    "estimator": "Parameter estimator",
    "combined": "Combined",
}
"""What a reader should call the learners; the first two learn the whole map."""

CAPTION = (
    "Normal plant. Trials after which the mean position error stays within so much: the median "
    "over replicates, with the range of their middle half, and in how many of them it happens, "
    "where not in all; a dash where in none. 0 means that nominal kinematics suffice. Last, the "
    "error after all trials with its 95 % interval."
)

Rows = tuple[tuple[str, ...], ...]


def earlier_table(records: Records) -> tuple[tuple[str, ...], Rows]:
    """Heads and rows, from the records of the experiment `earlier`.

    Raises:
        InvalidInput: there are none.
    """
    levels = (f"Trials to {100 * level:g} cm" for level in LEVELS)
    heads = ("Learner", "Noise", *levels, "Error at the end", "after trials")
    noises = zip(PLANTS, ("with", "without"), strict=True)
    rows = tuple(
        (WORDS[learner], word, *_cells(records, f"earlier/{learner}-{noise}/error"))
        for noise, word in noises
        for learner in TRIALS
    )
    return heads, rows


def earlier_markdown(records: Records) -> str:
    """The table in Markdown, with its caption below."""
    heads, rows = earlier_table(records)
    aligned = ["---"] * 2 + ["---:"] * (len(heads) - 2)
    text = "\n".join(f"| {' | '.join(line)} |" for line in (heads, aligned, *rows))
    return f"{text}\n\n{CAPTION}\n"


def _cells(records: Records, path: str) -> tuple[str, ...]:
    at, values = records.curve(path)
    reached = tuple(_trials(trials_to(at, values, level)) for level in LEVELS)
    last, interval = float(values[:, -1].mean()), t_interval(values[:, -1])
    error = show(last, "m") if interval is None else show_interval(last, last - interval[0], "m")
    return (*reached, error, f"{at[-1]:,.0f}")


def _trials(needed: Array) -> str:
    """Trials needed in each replicate, infinite where they did not suffice, in words."""
    there = needed[np.isfinite(needed)]
    if not there.size:
        return "–"
    low, middle, high = np.quantile(there, (0.25, 0.5, 0.75), method="nearest")
    spread = f" ({low:,.0f}–{high:,.0f})" if high > low else ""
    share = "" if there.size == needed.size else f", in {there.size} of {needed.size}"
    return f"{middle:,.0f}{spread}{share}"
