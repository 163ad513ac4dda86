"""The animation of catching: true to the throws, small, in light and dark."""

from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from PIL import Image, ImageSequence
from tests.reports.made_up_catching import LAYOUT, made_up_recording

from handeye.catching.results import Take
from handeye.errors import InvalidInput
from handeye.reports.animation import FRAMES_PER_SECOND, catching_animation
from handeye.reports.pixels import SHARPNESS, Painter, as_indices, shades
from handeye.reports.style import PALETTE

TAKES = [Take(title, made_up_recording(2, skill)) for title, skill in (("10", 0.0), ("all", 1.0))]


@pytest.fixture(scope="module")
def animation():
    return catching_animation(TAKES, LAYOUT)


def frames_of(content):
    """Every frame with its duration [ms]."""
    frames = ImageSequence.Iterator(Image.open(BytesIO(content)))
    return [(np.asarray(frame.convert("RGB")), frame.info["duration"]) for frame in frames]


def rgb(name, scheme):
    return tuple(int(PALETTE[name][scheme][i : i + 2], 16) for i in (1, 3, 5))


def test_the_animation_lasts_as_long_as_the_throws(animation):
    watched = [np.isfinite(TAKES[0].recording.sensed.time[:, i]).sum() for i in range(2)]
    shown = sum(-(-int(ticks) // 2) for ticks in watched) + 2 * round(0.4 * FRAMES_PER_SECOND)
    assert sum(duration for _, duration in frames_of(animation.light)) == shown * 50
    assert Image.open(BytesIO(animation.light)).info["loop"] == 0


def test_the_animation_is_small_the_same_every_time_and_tells_its_progress(animation):
    assert len(animation.light) < 300_000
    done = []
    again = catching_animation(TAKES, LAYOUT, done.append)
    assert done == [1, 2]
    assert (again.light, again.dark, again.still) == (
        animation.light,
        animation.dark,
        animation.still,
    )


def test_ground_and_marks_follow_the_scheme(animation):
    for content, scheme in ((animation.light, 0), (animation.dark, 1)):
        last = frames_of(content)[-1][0]
        assert tuple(last[0, 0]) == rgb("card", scheme)
        for name in ("after", "before"):
            assert (last == rgb(name, scheme)).all(axis=-1).any()


@pytest.mark.parametrize(
    ("take", "shown", "absent"), [(0, "before", "after"), (1, "after", "before")]
)
def test_catches_and_misses_end_in_their_own_colours(take, shown, absent):
    recording = TAKES[take].recording[[0]]
    assert recording.caught.tolist() == [take == 1]
    last = frames_of(catching_animation([Take("a", recording)], LAYOUT).light)[-1][0]
    assert (last == rgb(shown, 0)).all(axis=-1).any()
    assert not (last == rgb(absent, 0)).all(axis=-1).any()


def test_the_still_is_the_last_frame(animation):
    still = np.asarray(Image.open(BytesIO(animation.still)).convert("RGB"))
    np.testing.assert_array_equal(still, frames_of(animation.light)[-1][0])
    assert still.shape[:2][::-1] == tuple(round(SHARPNESS * side) for side in animation.size)


def test_balls_and_cups_are_where_they_were_recorded():
    """One take of one throw: what changes between two frames is around the ball and the cup."""
    take = Take("a", made_up_recording(1, 1.0))
    first, second = (frame for frame, _ in frames_of(catching_animation([take], LAYOUT).light)[4:6])
    _, columns = np.nonzero((first != second).any(axis=-1))
    width = first.shape[1]
    sensed = take.recording.sensed
    places = [*sensed.ball_x[8:11, 0], *sensed.arm_x[8:11, 0]]
    gap, view = 26 * SHARPNESS, (-0.1, 2.7)
    scale = (width - 2 * gap) / (view[1] - view[0])
    expected = gap + (np.array(places) - view[0]) * scale
    away = np.abs(columns[:, None] - expected).min(axis=1)
    assert away.max() < (LAYOUT.cup.width / 2 + 0.03) * scale


def test_a_ball_out_of_sight_is_not_drawn():
    take = TAKES[1].recording[[0]]
    hidden = replace(take, sensed=take.sensed._replace(ball_x=take.sensed.ball_x * np.nan))
    assert catching_animation([Take("a", hidden)], LAYOUT).light.startswith(b"GIF89a")


@pytest.mark.parametrize(
    ("takes", "complaint"),
    [
        ([], "at least one take"),
        ([Take("a", made_up_recording(2)[:0])], "'a' has no throws"),
        ([TAKES[0], Take("b", made_up_recording(2, seed=9))], "'b' shows other throws than '10'"),
        ([TAKES[0], Take("b", made_up_recording(3))], "'b' shows other throws"),
    ],
)
def test_takes_that_do_not_fit_are_refused(takes, complaint):
    with pytest.raises(InvalidInput, match=complaint):
        catching_animation(takes, LAYOUT)


def test_each_colour_keeps_its_number_and_the_ground_is_the_first():
    painter = Painter((30, 30))
    painter.disc((15, 15), 12, "after")
    painter.disc((15, 15), 6, "before", hollow=True)
    indices = np.asarray(as_indices(painter.finish()))
    light, dark = (np.reshape(shades(scheme), (-1, 3)) for scheme in (0, 1))
    assert len(light) == len(dark) <= 256
    middle = indices.shape[0] // 2
    assert indices[0, 0] == indices[middle, middle] == 0
    ring = indices[middle, middle + round(9 * SHARPNESS)]
    assert tuple(light[ring]) == rgb("after", 0)
    assert tuple(dark[ring]) == rgb("after", 1)
