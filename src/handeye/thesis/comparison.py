"""Section 3.7.1 with numbers: network and estimators in every scenario of chapter 3, as a table."""

from html import escape
from typing import NamedTuple

import numpy as np

from handeye.thesis.experiments.comparison import FEW, LATE, SCENARIOS, SOON
from handeye.thesis.judge import t_interval
from handeye.thesis.records import Records
from handeye.thesis.units import Scale, scale_for, show, show_interval

WORDS = {
    "kinematic": "parameters in error, nothing else",
    "noise": "with noise",
    "perturbations": "with perturbations",
    "both": "with both",
    "heat": "with heat, period 500 trials",
    "heat-both": "with heat and both",
    "slip-both": "with both, after alpha slips by 2 degrees",
    "local": "in a region of 20 cm",
    "local-both": "in a region of 20 cm, with both",
    "large": "large errors of the parameters",
    "large-both": "large errors with noise and large perturbations",
    "scale": "range scale 0.9",
    "scale-both": "range scale 0.9, with both",
    "no-kinematics": "no kinematics known, with both",
}
"""What is wrong with the robot, by scenario."""

_AFTER = {"few": f"{FEW}", "soon": f"{SOON}", "late": "end"}
_SMALLEST = 1e-7
_MILLIMETRES = Scale("mm", 1e3)


class Method(NamedTuple):
    """A calibrator of the comparison, and the moments to tell of."""

    words: str
    moments: tuple[str, ...]


METHODS = {
    "network-200": Method("Network, 200 neurons", ("soon", "late")),
    "network-free": Method("Network, no limit", ("late",)),
    "forward": Method("Estimator, thesis (forward)", ("few", "soon")),
    "modern": Method("Estimator, today's", ("few", "soon", "late")),
}

CAPTION = (
    'Mean position error with its 95 % interval over replicates; "both" are noise and '
    "perturbations. After so many trials: after "
    f"{FEW}; over trials {SOON // 2} to {SOON}; and at the end, over the last {LATE:,} of 5,000 "
    "with a network, of 2,000 with today's estimator. Trials count from the slip where there is "
    "one. The thesis's estimator solves over all trials so far, and an estimator needs kinematics."
)


class Table(NamedTuple):
    """Columns as (method, moment), and rows of as many cells behind the name of a scenario."""

    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, tuple[str, ...]], ...]


def comparison_table(records: Records) -> Table:
    """From the records of the experiment `comparison`.

    Raises:
        InvalidInput: there are none.
    """
    moments = [(name, moment) for name, method in METHODS.items() for moment in method.moments]

    def cells(scenario: str) -> tuple[str, ...]:
        knows = SCENARIOS[scenario].kinematics
        wanted = [("network-200", "uncorrected"), *moments]
        return tuple(
            _cell(records, f"{scenario}-{name}/{moment}")
            if knows or (name.startswith("network") and moment != "uncorrected")
            else "–"
            for name, moment in wanted
        )

    heads = [(METHODS[name].words, _AFTER[moment]) for name, moment in moments]
    return Table(
        (("Uncorrected", ""), *heads),
        tuple((words, cells(scenario)) for scenario, words in WORDS.items()),
    )


def comparison_markdown(records: Records) -> str:
    """The table in Markdown, with its caption below."""
    table = comparison_table(records)
    lines = [
        ["Scenario", *(", ".join(filter(None, column)) for column in table.columns)],
        ["---"] + ["---:"] * len(table.columns),
        *([_sentence(words), *cells] for words, cells in table.rows),
    ]
    text = "\n".join(f"| {' | '.join(line)} |" for line in lines)
    return f"{text}\n\n{CAPTION}\n"


def comparison_html(records: Records) -> str:
    """The table in HTML, one head over all moments of a method."""
    table = comparison_table(records)
    methods = "".join(
        f'<th colspan="{len(method.moments)}" scope="colgroup">{escape(method.words)}</th>'
        for method in METHODS.values()
    )
    moments = "".join(f'<th scope="col">{escape(after)}</th>' for _, after in table.columns[1:])
    rows = "".join(_row(words, cells) for words, cells in table.rows)
    return (
        f'<table class="comparison">\n<caption>{escape(CAPTION)}</caption>\n<thead>\n'
        '<tr><th rowspan="2" scope="col">Scenario</th><th rowspan="2" scope="col">Uncorrected</th>'
        f"{methods}</tr>\n<tr>{moments}</tr>\n"
        f"</thead>\n<tbody>\n{rows}</tbody>\n</table>\n"
    )


def _cell(records: Records, path: str) -> str:
    values = records.values(f"comparison/{path}")
    mean = float(np.mean(values))
    if mean < _SMALLEST:
        return "< 0.1 µm"
    scale = scale_for(mean, "m") if mean < 1e-4 else _MILLIMETRES
    interval = t_interval(values)
    if interval is None:
        return show(mean, "m", scale)
    return show_interval(mean, mean - interval[0], "m", scale)


def _row(words: str, cells: tuple[str, ...]) -> str:
    data = "".join(f"<td>{escape(cell)}</td>" for cell in cells)
    return f'<tr><th scope="row">{escape(_sentence(words))}</th>{data}</tr>\n'


def _sentence(words: str) -> str:
    return words[0].upper() + words[1:]
