"""The pictures of catching: what they say, what they hold, and what they refuse."""

from dataclasses import replace

import numpy as np
import pytest
from tests.reports.made_up_catching import (
    LAYOUT,
    made_up_marks,
    made_up_recording,
    made_up_result,
)
from tests.reports.test_figures import panels, words

from handeye.catching.results import Mark, Score, Take
from handeye.errors import InvalidInput
from handeye.reports.figures.catching_cup import early_and_late, seen_from_the_cup
from handeye.reports.figures.catching_layout import catching_layout
from handeye.reports.figures.catching_parts import events_of, relative_path, view_of
from handeye.reports.figures.catching_results import catching_curve, prediction_error
from handeye.reports.figures.catching_still import catching_still
from handeye.reports.figures.catching_trial import TRACES, one_throw
from handeye.reports.style import color
from handeye.reports.svg import inline_svg, png

SURE = made_up_recording(8, skill=1.0)
UNSURE = made_up_recording(40, skill=0.5)
RESULT = made_up_result(40)

FIGURES = {
    "layout": lambda: catching_layout(LAYOUT, SURE),
    "seen from the cup": lambda: seen_from_the_cup(UNSURE, LAYOUT),
    "early and late": lambda: early_and_late(RESULT.takes, 0, LAYOUT),
    "one throw": lambda: one_throw(SURE, 0),
    "prediction error": lambda: prediction_error(UNSURE),
    "learning curve": lambda: catching_curve(RESULT.marks),
    "still": lambda: catching_still(RESULT.marks[:4], RESULT.takes, LAYOUT),
}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("layout", ["apex", "1.25 to 1.5 m", "launch: 0 to 0.2 m", "crossing: 0.8 to 2.2 m",
                    "travel of the cup's centre: 0.5 to 2.5 m", "cup 20 × 8 cm, ball 6 cm",
                    "x [m]"]),
        ("seen from the cup", ["light ball, light arm", "heavy ball, heavy arm", "of 10 caught",
                               "Ahead of the cup's centre [cm]"]),
        ("early and late", ["10 pursuits", "300 pursuits", "Command voltage [V]", "caught",
                            "Time since launch [s]"]),
        ("one throw", ["Position along the rail [m]", "predicted crossing", "cup", "ball",
                       "Command voltage [V]", "Surprise", "heavy ball", "light arm", "?",
                       "caught", "Time since launch [s]"]),
        ("prediction error", ["Error of the predicted place [cm]", "light ball", "heavy ball",
                              "Error of the predicted time [ms]", "Time since launch [s]"]),
        ("still", ["nothing", "300 pursuits", "0\N{NO-BREAK SPACE}% caught",
                   "95\N{NO-BREAK SPACE}% caught", "no", "pursuits",
                   "Caught [% of 200 test throws, with 95 % interval]"]),
        ("learning curve", ["Caught [% of the test throws]", "Cup off the crossing, rms [cm]",
                            "heavy ball, light arm", "pursuits", "300 and", "mentor"]),
    ],
)  # fmt: skip
def test_a_picture_of_catching_says_in_words_and_units_what_it_shows(name, expected):
    text = words(FIGURES[name]())
    assert [part for part in expected if part not in text] == []


@pytest.mark.parametrize("name", FIGURES)
def test_a_picture_of_catching_is_the_same_every_time(name):
    assert inline_svg(FIGURES[name](), "a", "x") == inline_svg(FIGURES[name](), "a", "x")


def test_balls_are_drawn_as_the_cup_sees_them():
    x, z = relative_path(UNSURE, 3)
    sensed = UNSURE.sensed
    watched = np.isfinite(sensed.time[:, 3])
    np.testing.assert_allclose(x, (sensed.ball_x - sensed.arm_x)[watched, 3])
    np.testing.assert_allclose(z, sensed.ball_z[watched, 3])
    drawn = panels(seen_from_the_cup(SURE[[5]], LAYOUT))[0].lines[0]
    x, z = relative_path(SURE, 5)
    np.testing.assert_allclose(drawn.get_xdata(), 100 * x)
    np.testing.assert_allclose(drawn.get_ydata(), 100 * z)


def test_catches_and_misses_differ_in_colour_and_are_counted_for_each_pair():
    figure = seen_from_the_cup(UNSURE, LAYOUT)
    throws = UNSURE.throws
    for axes, (ball, arm) in zip(panels(figure), ((0, 0), (0, 1), (1, 0), (1, 1)), strict=True):
        rows = (throws.ball == ball) & (throws.arm == arm)
        caught = int(np.count_nonzero(UNSURE.caught[rows]))
        colours = [line.get_color() for line in axes.lines]
        assert colours.count(color("after")) == caught
        assert colours.count(color("before")) == 10 - caught
        assert f"{caught} of 10 caught" in [text.get_text() for text in axes.texts]


def test_the_picture_of_a_throw_holds_its_numbers():
    here = np.isfinite(SURE.sensed.time[:, 2])
    position, voltage, surprise, beliefs = panels(one_throw(SURE, 2))
    np.testing.assert_allclose(position.lines[0].get_ydata(), SURE.sensed.arm_x[here, 2])
    np.testing.assert_allclose(position.lines[1].get_ydata(), SURE.sensed.ball_x[here, 2])
    steps = voltage.lines[1]
    np.testing.assert_allclose(steps.get_ydata(), SURE.voltage[here, 2])
    assert steps.get_drawstyle() == "steps-post"
    np.testing.assert_allclose(
        surprise.lines[0].get_ydata(), np.minimum(SURE.traces["ball_surprise"][here, 2], 4.0)
    )
    # The made-up ball is taken for the other one, then for none, then for itself.
    said = [text.get_text() for text in beliefs.texts]
    assert [word for word in said if "ball" in word or word == "?"] == [
        "heavy ball",
        "?",
        "light ball",
    ]


def test_events_are_named_at_their_times_and_near_ones_once():
    caught = events_of(SURE, 0)
    assert [event.words for event in caught] == ["caught"]  # the contact is just before
    assert caught[0].time == SURE.final.time[0]
    throw = int(np.flatnonzero(~UNSURE.caught)[0])
    assert [event.words for event in events_of(UNSURE, throw)] == ["missed"]
    touched = replace(UNSURE, contact_time=UNSURE.final.time - 0.2)
    first, second = events_of(touched, throw)
    assert (first.words, second.words) == ("touches the cup", "missed")
    assert first.time == touched.contact_time[throw]


def test_prediction_errors_are_medians_in_centimetres_and_milliseconds():
    throws, nothing = UNSURE.throws, 0.0 * UNSURE.sensed.time
    exact = {
        "crossing_x": nothing + throws.crossing_x + 0.02,
        "crossing_time": nothing + throws.crossing_time - 0.003,
    }
    place, time = panels(prediction_error(replace(UNSURE, traces=exact)))
    np.testing.assert_allclose(place.lines[0].get_ydata(), 2.0)
    np.testing.assert_allclose(time.lines[0].get_ydata(), 3.0)
    last = place.lines[0].get_xdata()[-1]
    assert last <= UNSURE.final.time.max()


def test_a_learning_curve_holds_shares_intervals_and_errors():
    share, error = panels(FIGURES["learning curve"]())
    first = made_up_marks()[2].scores[0]
    points = share.containers[0].lines[0].get_ydata()
    assert points[2] == pytest.approx(100 * first.share)
    low, high = share.containers[0].lines[2][0].get_segments()[2][:, 1]
    np.testing.assert_allclose((low, high), 100 * np.array(first.interval))
    assert error.lines[0].get_ydata()[2] == pytest.approx(100 * first.rms)


def test_a_mark_may_lack_a_pair_of_ball_and_arm():
    marks = [Mark(0, 0, (Score(0, 0, 5, 0, 0.3),)), Mark(10, 0, (Score(0, 1, 5, 4, 0.1),))]
    assert "light ball, heavy arm" in words(catching_curve(marks))


def test_the_still_is_small_and_shows_the_cup_where_it_was_at_the_end():
    figure = catching_still(RESULT.marks[:4], RESULT.takes, LAYOUT)
    assert len(png(figure)) < 150_000
    recording = RESULT.takes[0].recording
    first = panels(figure)[0]
    cups = [line.get_xdata() for line in first.lines if len(line.get_xdata()) == 4]
    middles = [(cup[0] + cup[-1]) / 2 for cup in cups]
    np.testing.assert_allclose(middles, recording.final.arm_x)
    np.testing.assert_allclose([cup[2] - cup[1] for cup in cups], LAYOUT.cup.width)


def test_the_view_holds_launch_and_every_place_of_the_cup():
    left, right = view_of(LAYOUT)
    assert left < LAYOUT.launch_x[0]
    assert right > LAYOUT.arm_travel[1] + LAYOUT.cup.width / 2
    assert view_of(replace(LAYOUT, launch_x=(3.0, 3.5)))[1] > 3.5


def test_the_cup_is_drawn_to_scale():
    figure = seen_from_the_cup(SURE, LAYOUT)
    walls = panels(figure)[0].lines[-1].get_xydata()
    np.testing.assert_allclose(walls, [[-10, 8], [-10, 0], [10, 0], [10, 8]])


@pytest.mark.parametrize(
    ("draw", "complaint"),
    [
        (lambda: one_throw(SURE, 8), "throw 8 is not there: the recording has 8"),
        (lambda: one_throw(SURE, -1), "throw -1 is not there"),
        (lambda: one_throw(replace(SURE, traces={}), 0), f"did not record {TRACES[0]}, "),
        (lambda: seen_from_the_cup(SURE[:0], LAYOUT), "no throws"),
        (lambda: early_and_late([], 0, LAYOUT), "nothing to compare"),
        (lambda: early_and_late([Take("a", SURE)], 9, LAYOUT), "throw 9 is not there"),
        (lambda: prediction_error(replace(SURE, traces={})), "did not record crossing_x"),
        (
            lambda: prediction_error(
                replace(SURE, traces={name: np.nan * t for name, t in SURE.traces.items()})
            ),
            "no crossing was predicted",
        ),
        (lambda: catching_curve([]), "at least one mark"),
        (lambda: catching_still([], [], LAYOUT), "0 marks and 0 takes"),
        (lambda: catching_still(RESULT.marks, RESULT.takes, LAYOUT), "5 marks and 4 takes"),
    ],
)
def test_throws_that_cannot_be_drawn_are_refused(draw, complaint):
    with pytest.raises(InvalidInput, match=complaint):
        draw()
