"""Every figure draws what it is given and says in words and units what it shows."""

import re
from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

from handeye.errors import InvalidInput
from handeye.reports.figures import (
    Curve,
    PlanarArm,
    Stage,
    error_distribution,
    error_in_space,
    error_map,
    learning_curve,
    residuals_by_joint,
    robot_story,
    running_error,
)
from handeye.reports.figures.maps import ErrorScale, spread
from handeye.reports.svg import inline_svg, png

RNG = np.random.default_rng(11)
N = 200
PLACES = RNG.uniform(-1.0, 1.0, (N, 3))
BEFORE = RNG.normal(0.0, 2e-3, (N, 3))
AFTER = 0.25 * BEFORE
JOINTS = RNG.uniform(-np.pi, np.pi, (N, 2))
ARM = PlanarArm(links=(1.0, 0.8), eye=(-1.0, 0.0))
CURVE = Curve("with learning", [0, 100, 200], [0.045, 0.02, 0.012], low=[0.04, 0.01, 0.0],
              high=[0.05, 0.03, 0.02])  # fmt: skip

FIGURES = {
    "learning curve": lambda: learning_curve(
        [CURVE, Curve("without learning", [0, 200], [0.045, 0.046])],
        marks=[(100, "bent by 2 degrees")],
        references=[(0.009, "sensor noise alone")],
        neurons=([0, 100, 200], [0, 60, 90]),
    ),
    "running error": lambda: running_error(BEFORE, AFTER, neurons=np.arange(N)),
    "error map": lambda: error_map(PLACES, BEFORE, AFTER),
    "error in space": lambda: error_in_space(PLACES, BEFORE, AFTER),
    "residuals by joint": lambda: residuals_by_joint(("pan", "tilt"), JOINTS, BEFORE, AFTER),
    "error distribution": lambda: error_distribution(BEFORE, AFTER),
    "robot story": lambda: robot_story([Stage("Before", PLACES[:, :2], BEFORE[:, :2])], ARM),
}


def words(figure):
    """Every word that a reader sees, in the order of drawing."""
    return " | ".join(re.findall(r"<text[^>]*>([^<]*)</text>", inline_svg(figure, "a", "x")))


def panels(figure) -> list[Any]:
    """The axes of a figure; what was drawn in them is looked at in detail."""
    return figure.axes


def line(axes, label):
    return next(one for one in axes.lines if one.get_label() == label)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("learning curve", ["Mean position error [cm]", "Trials", "with learning",
                            "without learning", "bent by 2 degrees", "sensor noise alone",
                            "Neurons in use", "90 neurons"]),
        ("running error", ["Position error [mm]", "Observations", "with learning",
                           "without learning", "199 neurons"]),
        ("error map", ["x [m]", "y [m]", "z [m]", "Before, seen from the top",
                       "After, from the side", "Position error [mm]", "× as long"]),
        ("residuals by joint", ["pan", "tilt", "Angle [°]", "Position error [mm]",
                                "Before learning", "After learning"]),
        ("error distribution", ["Position error [mm]", "Share of observations", "[%]", "Before",
                                "After"]),
        ("robot story", ["Before", "eye", "target", "Position error [mm]", "× as long"]),
    ],
)  # fmt: skip
def test_a_figure_says_in_words_and_units_what_it_shows(name, expected):
    text = words(FIGURES[name]())
    assert [part for part in expected if part not in text] == []


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_draws_the_same_every_time(name):
    first, second = FIGURES[name](), FIGURES[name]()
    assert inline_svg(first, "a", "x") == inline_svg(second, "a", "x")
    assert png(first) == png(second)


@pytest.mark.parametrize("name", FIGURES)
def test_the_callers_settings_neither_change_nor_matter(name):
    plain = inline_svg(FIGURES[name](), "a", "x")
    with mpl.rc_context({"font.size": 30, "lines.linewidth": 9, "text.usetex": False}):
        before = dict(mpl.rcParams)
        assert inline_svg(FIGURES[name](), "a", "x") == plain
        assert dict(mpl.rcParams) == before


def test_a_learning_curve_holds_the_given_numbers_in_centimetres():
    axes = panels(FIGURES["learning curve"]())[0]
    np.testing.assert_allclose(line(axes, "with learning").get_xdata(), [0, 100, 200])
    np.testing.assert_allclose(line(axes, "with learning").get_ydata(), [4.5, 2.0, 1.2])
    assert axes.get_yscale() == "linear"
    assert axes.get_ylim()[0] == 0.0


def test_errors_of_very_different_size_get_a_logarithmic_axis():
    axes = panels(learning_curve([Curve("learned", [0, 1], [2.0, 0.003])]))[0]
    assert axes.get_yscale() == "log"
    low, high = axes.get_ylim()
    assert low < 0.3
    assert high > 200.0


def test_labels_of_curves_that_end_together_do_not_overlap():
    curves = [Curve(f"curve {i}", [0, 1], [0.02, 0.01 + 1e-5 * i]) for i in range(5)]
    figure = learning_curve(curves)
    figure.draw_without_rendering()
    boxes = [t.get_window_extent() for t in panels(figure)[0].texts]
    tops = sorted((box.y0, box.y1) for box in boxes)
    assert len(tops) == 5
    assert all(a[1] <= b[0] + 1 for a, b in pairwise(tops))


def test_running_means_use_every_observation_and_dots_are_thinned():
    errors = np.full(5000, 0.002)
    errors[::2] = 0.004
    axes = panels(running_error(errors, 0.5 * errors))[0]
    mean = line(axes, "without learning").get_ydata()
    np.testing.assert_allclose(mean, 3.0, rtol=0.01)
    assert max(len(dots.get_xdata()) for dots in axes.lines) < 1000


def test_the_distribution_marks_median_and_95_percent():
    errors = np.arange(1, 101) * 1e-4
    axes = panels(error_distribution(errors, errors / 2))[0]
    marks = {tuple(m.get_xydata()[0]) for m in axes.lines if len(m.get_xdata()) == 1}
    np.testing.assert_allclose(
        sorted(marks), sorted({(5.05, 50), (9.505, 95), (2.525, 50), (4.7525, 95)})
    )


def test_residuals_are_drawn_over_the_joint_in_degrees():
    joints = np.linspace(-1.0, 1.0, N)[:, None]
    errors = np.pad(3e-3 * joints, ((0, 0), (0, 1)))
    figure = residuals_by_joint(("pan",), joints, errors, 0 * errors, component="x")
    dots, median = panels(figure)[0].lines[:2]
    np.testing.assert_allclose(dots.get_ydata(), 3.0 * np.radians(dots.get_xdata()), atol=1e-12)
    np.testing.assert_allclose(median.get_ydata(), 3.0 * np.radians(median.get_xdata()), atol=1e-12)
    assert "Error along x [mm]" in words(figure)


def test_a_map_in_a_plane_has_one_view_and_one_scale_for_both_panels():
    figure = error_map(PLACES[:, :2], BEFORE[:, :2], AFTER[:, :2])
    before, after = (axes.collections[0] for axes in panels(figure)[:2])
    assert len(panels(figure)) == 3
    np.testing.assert_array_equal(before.get_offsets(), after.get_offsets())
    assert before.scale == after.scale
    np.testing.assert_array_equal(before.norm.boundaries, after.norm.boundaries)
    np.testing.assert_allclose(np.c_[after.U, after.V], 0.25 * np.c_[before.U, before.V])


def test_the_key_tells_the_true_magnification():
    scale = ErrorScale.of(np.full(50, 0.004), extent=2.0, arrow=0.1)
    assert scale.magnification == 50.0
    assert scale.sample == 0.004
    figure = error_map(PLACES, BEFORE, AFTER)
    assert f"drawn {1 / panels(figure)[0].collections[0].scale:g}× as long" in words(figure)


def test_a_large_map_draws_single_observations_spread_over_the_workspace():
    places = RNG.uniform(0.0, 1.0, (10_000, 2))
    rows = spread(places, cells=10)
    assert len(rows) == len(set(rows.tolist())) == 100
    assert len(spread(places[:20], cells=10)) == 20


def test_the_arm_reaches_where_it_can_and_stretches_where_it_cannot():
    for hand in ([1.2, 0.5], [-0.4, 0.9]):
        elbow, reached = ARM.elbow_and_hand(np.array(hand))
        np.testing.assert_allclose(reached, hand, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(elbow), 1.0)
        np.testing.assert_allclose(np.linalg.norm(reached - elbow), 0.8)
    _, far = ARM.elbow_and_hand(np.array([3.0, 4.0]))
    np.testing.assert_allclose(far, 1.8 * np.array([0.6, 0.8]), rtol=1e-5)


def test_the_story_states_each_stage_in_one_unit():
    points = PLACES[:, :2]
    stages = [
        Stage("Before", points, np.full((N, 2), 0.03)),
        Stage("After", points, np.full((N, 2), 0.005), mean=0.0071),
    ]
    text = words(robot_story(stages, ARM))
    assert "4.2\N{NO-BREAK SPACE}cm" in text
    assert "0.71\N{NO-BREAK SPACE}cm" in text


@pytest.mark.parametrize("n", [1, 7])
@pytest.mark.parametrize("size", [0.0, 1e-7, 2.0])
def test_few_observations_and_errors_of_any_size_can_be_drawn(n, size):
    errors = np.full((n, 3), size)
    for figure in (
        running_error(errors, errors, neurons=np.zeros(n)),
        error_map(PLACES[:n], errors, errors),
        residuals_by_joint(("pan", "tilt"), JOINTS[:n], errors, errors),
        error_distribution(errors, errors),
        learning_curve([Curve("a", np.arange(n), errors[:, 0])]),
        robot_story([Stage("a", PLACES[:n, :2], errors[:, :2])], ARM),
    ):
        inline_svg(figure, "a", "x")


EMPTY = np.zeros((0, 3))
NAN = np.full((N, 3), np.nan)


@pytest.mark.parametrize(
    ("draw", "complaint"),
    [
        (lambda: learning_curve([]), "at least one curve"),
        (lambda: learning_curve([Curve("a", [], [])]), "x of 'a' is empty"),
        (lambda: learning_curve([Curve("a", [0, 1], [1.0])]), "mean of 'a' must have 2 rows"),
        (lambda: learning_curve([Curve("a", [0], [np.nan])]), "mean of 'a' must be finite"),
        (lambda: running_error(EMPTY, EMPTY), "before is empty"),
        (lambda: running_error(BEFORE, AFTER[:-1]), "online must have 200 rows"),
        (lambda: running_error(BEFORE, NAN), "online must be finite"),
        (lambda: error_map(EMPTY, EMPTY, EMPTY), "positions is empty"),
        (lambda: error_map(PLACES[:, 0], BEFORE, AFTER), "positions must have shape"),
        (lambda: error_map(PLACES, NAN, AFTER), "before must be finite"),
        (lambda: residuals_by_joint(("pan",), JOINTS, BEFORE, AFTER), "joints must have shape"),
        (lambda: residuals_by_joint(("a", "b"), JOINTS[:0], EMPTY, EMPTY), "joints is empty"),
        (lambda: error_distribution(BEFORE, EMPTY), "after is empty"),
        (lambda: robot_story([], ARM), "at least one stage"),
        (lambda: robot_story([Stage("a", PLACES, BEFORE[:3])], ARM), "errors of 'a' must have"),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_refused_with_its_name(draw, complaint):
    with pytest.raises(InvalidInput, match=complaint):
        draw()


def test_readings_of_sliding_joints_are_in_millimetres():
    errors = np.ones((len(JOINTS), 3)) * 1e-3
    figure = residuals_by_joint(("rail", "tilt"), JOINTS, errors, errors, sliding=("rail",))
    rail, tilt = figure.axes[:2]
    assert (rail.get_xlabel(), tilt.get_xlabel()) == ("Position [mm]", "Angle [°]")
    drawn = np.concatenate([line.get_xdata() for line in rail.lines if line.get_marker() == "o"])
    assert drawn.max() == pytest.approx(1e3 * JOINTS[:, 0].max(), rel=0.1)
