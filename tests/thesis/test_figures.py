import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from handeye.errors import InvalidInput
from handeye.reports.svg import inline_svg, png
from handeye.thesis.claims import claims_by_id
from handeye.thesis.experiments import EXPERIMENTS
from handeye.thesis.figures import FIGURES, TOPICS, Drawn, NotDrawn, drawable, find_figure
from handeye.thesis.figures.layout import beside, single, stacked
from handeye.thesis.figures.lines import STATED, Line, Panel, band, ends, function, line, until
from handeye.thesis.judge import t_interval
from handeye.thesis.records import Record, Records
from handeye.thesis.reproduce import figure_number
from handeye.thesis.storage import Stored

DRAWN = [figure for figure in FIGURES.values() if isinstance(figure, Drawn)]


def shown(axes: Axes) -> bool:
    return axes.axison and bool(axes.lines or axes.collections)


def upright_name(axes: Axes) -> str:
    """What stands above an axis, where its y is named."""
    return axes.get_title(loc="left").splitlines()[-1] if axes.get_title(loc="left") else ""


def all_text(figure: Figure) -> str:
    return re.sub(r"<[^>]*>", "\n", inline_svg(figure, "f", "a figure"))


def test_every_figure_of_the_chapters_is_drawn_or_listed_with_a_reason():
    assert list(FIGURES) == [
        f"{c}.{n}" for c, most in ((3, 53), (4, 18), ("A", 8), (6, 14)) for n in range(1, most + 1)
    ]
    listed = [figure for figure in FIGURES.values() if isinstance(figure, NotDrawn)]
    assert {figure.number for figure in listed} == {
        "3.1", "3.2", "3.3", "3.4", "3.5", "3.6", "3.7", "3.17", "3.19", "3.50",
        "4.2", "4.5", "4.6", "4.17", "4.18", "A.1", "A.2", "A.3", "A.4", "A.5",
    }  # fmt: skip
    assert all(len(figure.reason) > 20 for figure in listed)
    assert Counter(f.number for topic in TOPICS.values() for f in topic) == Counter(
        figure.number for figure in DRAWN
    )


def test_figures_name_experiments_and_claims_that_there_are():
    for figure in DRAWN:
        assert set(figure.experiments) <= set(EXPERIMENTS), figure.number
        assert set(figure.shows) <= set(claims_by_id()), figure.number
        assert figure.caption.endswith("."), figure.number
        assert not figure.title.endswith("."), figure.number


def test_a_figure_shows_the_claims_that_name_it_and_those_that_it_declares():
    assert find_figure("3.22").shows == (
        "preferred-200-noisy", "preferred-free-noisy", "preferred-free-noisy-neurons",
        "preferred-free-clean", "preferred-free-clean-neurons",
    )  # fmt: skip
    assert "plant-perturbation-size" in find_figure("3.8").shows
    assert set(find_figure("3.33").shows) == {
        "step-time-constant", "step-initial-error", "step-final-error",
    }  # fmt: skip
    shown = {claim for figure in DRAWN for claim in figure.shows}
    in_chapters = [c.id for c in claims_by_id().values() if re.search("figures? [34A]", c.where)]
    assert shown.issuperset(in_chapters)
    for figure in DRAWN:
        alone = replace(figure, claims=()).shows
        assert set(alone).isdisjoint(figure.claims), f"{figure.number} declares what names it"


@pytest.mark.parametrize("figure", DRAWN, ids=lambda figure: figure.number)
def test_a_figure_is_drawn_from_records_with_names_and_units(smoke_run: Stored, figure: Drawn):
    if not all(EXPERIMENTS[name].can_run for name in figure.experiments):
        pytest.skip("the folder of real measurements is absent")
    needed = [row for row in smoke_run.records.rows if row.experiment in figure.experiments]
    made = figure.draw(Records(needed))
    axes = [one for one in made.axes if shown(one)]
    assert axes
    for one in axes:
        named = upright_name(one)
        assert named, "the upright axis has no name"
        assert "[" in named or "of its amplitude" in named, named
        across = [other.get_xlabel() for other in axes if other is one or _below(other, one)]
        assert any(across), "the level axis has no name"
    text = all_text(made)
    assert not re.search(r"\(([a-j])\)", text), "legends are in words"
    assert "nan" not in text.lower().split()


def _below(other: Axes, one: Axes) -> bool:
    return other in one.get_shared_x_axes().get_siblings(one)


def test_a_figure_is_the_same_each_time(smoke_run: Stored):
    figure = find_figure("3.22")
    first, again = (png(figure.draw(smoke_run.records)) for _ in range(2))
    assert first == again


def test_figures_are_found_by_number():
    assert find_figure("3.22").number == "3.22"
    with pytest.raises(InvalidInput, match=r"no figure 3\.54: figures go from 3\.1 to 6\.14"):
        find_figure("3.54")
    with pytest.raises(InvalidInput, match=r"figure 3\.17 shows no result: a sketch"):
        find_figure("3.17")


@pytest.mark.parametrize(
    "name", ["3.22", "figure-3.22", "fig 3.22", "Figure 3.22", "fig.3.22", "fig. 3.22"]
)
def test_ways_to_name_a_figure(name: str):
    assert figure_number(name) == "3.22"
    assert figure_number(name.replace("3.22", "a.7")) == "A.7"


@pytest.mark.parametrize("name", ["preferred", "3", "3.22b", "claim-3.22", "3.2.2", ""])
def test_names_of_something_else(name: str):
    assert figure_number(name) is None


def test_what_can_be_drawn_depends_on_the_records():
    assert drawable([]) == []
    assert [figure.number for figure in drawable(["distortions"])] == ["3.8", "3.9", "3.46", "3.47"]
    assert drawable(EXPERIMENTS) == DRAWN


def made_up(curves: dict[str, list[list[float]]]) -> Records:
    return Records(
        Record("e", setting, i, "error", 1000.0 * k, value)
        for setting, replicates in curves.items()
        for i, values in enumerate(replicates)
        for k, value in enumerate(values)
    )


RECORDS = made_up({"a": [[0.05, 0.02, 0.01], [0.04, 0.03, 0.012], [0.06, 0.01, 0.008]]})


def test_a_line_is_the_mean_with_its_95_percent_band():
    drawn = line(RECORDS, "e/a/error", "a", "after")
    np.testing.assert_allclose(drawn.mean, [0.05, 0.02, 0.01])
    low, high = t_interval(np.array([0.05, 0.04, 0.06])) or (0.0, 0.0)
    assert (drawn.low[0], drawn.high[0]) == pytest.approx((low, high))


def test_one_replicate_has_no_band():
    mean, low, high = band(np.array([[1.0, 2.0]]))
    np.testing.assert_array_equal(mean, low)
    np.testing.assert_array_equal(mean, high)


def test_ends_over_a_number():
    two = made_up({"a": [[9.0, 1.0]] * 2, "b": [[9.0, 2.0]] * 2})
    drawn = ends(two, {10.0: "e/a/error", 20.0: "e/b/error"}, "", "after")
    np.testing.assert_array_equal(drawn.x, [10.0, 20.0])
    np.testing.assert_array_equal(drawn.mean, [1.0, 2.0])


def test_a_line_until_somewhere():
    np.testing.assert_array_equal(
        until(line(RECORDS, "e/a/error", "", "after"), 1500).x, [0.0, 1000.0]
    )


def test_stated_values_are_marked_where_they_are():
    drawn = line(RECORDS, "e/a/error", "a", "after")
    made = single([drawn], Panel(stated=[(2000.0, 0.013, "after")]))
    (axes,) = made.axes
    (diamond,) = [one for one in axes.lines if one.get_label() == STATED]
    np.testing.assert_allclose(np.asarray(diamond.get_xydata()), [[2000.0, 1.3]])
    assert STATED in all_text(made)


def test_a_stated_value_beyond_a_shortened_run_is_left_out():
    drawn = line(RECORDS, "e/a/error", "a", "after")
    made = single([drawn], Panel(stated=[(5000.0, 0.013, "after")]))
    assert STATED not in all_text(made)


def test_a_stated_value_off_the_lines_is_within_the_axis():
    made = single([line(RECORDS, "e/a/error", "a", "after")], Panel(stated=[(0.0, 0.5, "after")]))
    assert made.axes[0].get_ylim()[1] > 50.0


@pytest.mark.parametrize(("high", "top"), [(1.0, 1.12), (1.8, 1.8), (9.0, 2.0)])
def test_a_band_is_in_view_unless_it_would_press_the_line_down(high, top):
    x, mean = np.array([0.0, 1.0]), np.array([0.5, 1.0])
    drawn = Line("", x, mean, mean - 0.1, np.array([0.6, high]), "after")
    made = single([drawn], Panel(unit="%", scale="zero"))
    assert made.axes[0].get_ylim() == pytest.approx((0.0, top))


def test_less_than_nothing_has_a_minus_sign():
    x = np.array([0.0, 1.0])
    made = single([function("", x, np.array([-1.0, 1.0]), "after")], Panel(unit="", scale="zero"))
    ticks = {tick.get_text() for tick in made.axes[0].get_yticklabels()}
    assert "\N{MINUS SIGN}1" in ticks
    assert not any("-" in text for text in ticks)


def test_lengths_of_very_different_size_have_their_own_units():
    x = np.array([0.0, 1.0])
    tiny = function("tiny", x, np.array([0.04, 1e-14]), "before")
    made = single([tiny], Panel(scale="decades"))
    text = all_text(made)
    assert "1 nm" in text
    assert "1 mm" in text


def test_rounding_errors_are_drawn_as_nothing():
    x = np.array([0.0, 1.0])
    made = single([function("none", x, np.full(2, 1e-16), "before"),
                   function("some", x, np.array([0.01, 0.02]), "after")])  # fmt: skip
    assert made.axes[0].get_yscale() == "linear"


def test_panels_share_what_they_say_they_share():
    drawn = line(RECORDS, "e/a/error", "a", "after")
    low = function("b", drawn.x, drawn.mean / 4.0, "before")
    pair = beside([("One", [drawn], Panel()), ("Two", [low], Panel())])
    assert pair.axes[0].get_ylim() == pair.axes[1].get_ylim()
    pile = stacked([([drawn], Panel()), ([low], Panel())], (1.0, 1.0))
    assert pile.axes[0].get_xlim() == pile.axes[1].get_xlim()
    assert pile.axes[0].get_xlabel() == ""
