from html.parser import HTMLParser

import pytest

from handeye.errors import InvalidInput
from handeye.thesis.comparison import (
    METHODS,
    WORDS,
    comparison_html,
    comparison_markdown,
    comparison_table,
)
from handeye.thesis.experiments.comparison import COMPARISON, SCENARIOS
from handeye.thesis.records import Record, Records

COLUMNS = 1 + sum(len(method.moments) for method in METHODS.values())


@pytest.fixture(scope="module")
def records() -> Records:
    """Two replicates of a centimetre, but for the thesis's estimator, which is exact."""
    return Records(
        Record("comparison", setting, replicate, name, None, value)
        for setting in COMPARISON.settings
        for replicate, error in enumerate((0.0099, 0.0101))
        for name in ("uncorrected", "few", "soon", "late")
        for value in [1e-13 if setting.endswith("forward") else error]
    )


def test_every_scenario_and_method_has_its_place(records: Records):
    assert set(WORDS) == set(SCENARIOS)
    named = {
        f"{scenario}-{method}"
        for scenario, work in SCENARIOS.items()
        for method in METHODS
        if work.kinematics or method.startswith("network")
    }
    assert named == set(COMPARISON.settings)
    table = comparison_table(records)
    assert len(table.columns) == COLUMNS
    assert all(len(cells) == COLUMNS for _, cells in table.rows)


def test_cells_have_an_interval_and_an_end_of_precision(records: Records):
    rows = dict(comparison_table(records).rows)
    assert rows["with both"] == (
        "10 ± 1 mm",
        *["10 ± 1 mm"] * 3,
        *["< 0.1 µm"] * 2,
        *["10 ± 1 mm"] * 3,
    )


def test_without_kinematics_there_is_no_estimator(records: Records):
    rows = dict(comparison_table(records).rows)
    cells = rows["no kinematics known, with both"]
    assert cells == ("–", *["10 ± 1 mm"] * 3, *["–"] * 5)


def test_one_replicate_has_no_interval():
    first = [r for r in _one_replicate() if r.replicate == 0]
    rows = dict(comparison_table(Records(first)).rows)
    assert rows["with both"][0] == "9.00 mm"


def _one_replicate() -> list[Record]:
    return [
        Record("comparison", setting, 0, name, None, 0.009)
        for setting in COMPARISON.settings
        for name in ("uncorrected", "few", "soon", "late")
    ]


def test_markdown_has_as_many_cells_in_every_line(records: Records):
    lines = [line for line in comparison_markdown(records).splitlines() if line.startswith("|")]
    assert len(lines) == 2 + len(WORDS)
    assert {line.count("|") for line in lines} == {COLUMNS + 2}


class _Cells(HTMLParser):
    """Counts the columns of every row."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[int] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        if tag == "tr":
            self.rows.append(0)
        elif tag in {"td", "th"}:
            self.rows[-1] += int(dict(attrs).get("colspan") or 1)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_html_is_well_formed_and_full(records: Records):
    parser = _Cells()
    parser.feed(comparison_html(records))
    assert parser.open == []
    assert parser.rows == [COLUMNS + 1, COLUMNS - 1, *[COLUMNS + 1] * len(WORDS)]


def test_no_records_no_table():
    with pytest.raises(InvalidInput, match="no records of comparison/kinematic"):
        comparison_table(Records([]))
