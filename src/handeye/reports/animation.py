"""Catches early and late in training side by side, as an animation in GIF."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO

import numpy as np
from PIL import Image

from handeye.arrays import Array
from handeye.catching.ball import BALLS
from handeye.catching.layout import Layout
from handeye.catching.play import Recording
from handeye.catching.results import IDENTITIES, Take
from handeye.errors import InvalidInput
from handeye.reports.figures.catching_parts import chosen, view_of
from handeye.reports.pixels import Painter, as_indices, shades

FRAMES_PER_SECOND = 20
"""As fast as every viewer of GIF can follow: each second tick of a clock of 40 Hz."""

_WIDTH, _GAP, _HEAD, _FOOT = 960, 26, 62, 40
_PANEL = 452
_ROOM_ABOVE = 0.08
_HOLD = 0.4


@dataclass(frozen=True)
class Animation:
    """The animation as GIF for light and for dark ground, and its last frame as PNG.

    size  width and height [px]
    """

    light: bytes
    dark: bytes
    still: bytes
    size: tuple[int, int]


def ignore(done: int) -> None:
    """Shows nothing."""


def catching_animation(
    takes: Sequence[Take], layout: Layout, after_each: Callable[[int], None] = ignore
) -> Animation:
    """Takes of the same throws beside each other, throw after throw, in real time.

    after_each  called after each throw with how many are drawn

    Raises InvalidInput for no takes, no throws, or takes of different throws.
    """
    _check(takes)
    scenes = _Scenes(takes, layout)
    frames: list[Image.Image] = []
    for throw in range(len(scenes.throws)):
        frames += [as_indices(image) for image in scenes.images(throw)]
        frames += [frames[-1]] * round(_HOLD * FRAMES_PER_SECOND)
        after_each(throw + 1)
    still = BytesIO()
    _coloured(frames[-1], 0).convert("RGB").save(still, format="PNG", optimize=True)
    return Animation(_gif(frames, 0), _gif(frames, 1), still.getvalue(), scenes.painter.size)


def _check(takes: Sequence[Take]) -> None:
    if not takes:
        raise InvalidInput("an animation needs at least one take, got none")
    first = takes[0].recording.throws
    if not len(first):
        raise InvalidInput(f"the take {takes[0].title!r} has no throws")
    for take in takes:
        if not np.array_equal(take.recording.throws.crossing_x, first.crossing_x):
            raise InvalidInput(f"{take.title!r} shows other throws than {takes[0].title!r}")


class _Scenes:
    """Where everything stands in the picture, and what changes from frame to frame."""

    def __init__(self, takes: Sequence[Take], layout: Layout) -> None:
        self.takes = takes
        self.layout = layout
        self.throws = takes[0].recording.throws
        n = len(takes)
        wide = min((_WIDTH - _GAP * (n + 1)) // n, _PANEL)
        left, right = view_of(layout)
        self.origin = left
        self.scale = wide / (right - left)
        self.lefts = [_GAP + i * (wide + _GAP) for i in range(n)]
        self.floor = round(_HEAD + (layout.apex[1] + _ROOM_ABOVE) * self.scale)
        size = (self.lefts[-1] + wide + _GAP, self.floor + _FOOT)
        self.wide = wide
        self.painter = Painter(size)
        self.every = max(round(1.0 / (FRAMES_PER_SECOND * layout.tick)), 1)

    def images(self, throw: int) -> Iterator[Image.Image]:
        """The frames of one throw."""
        last = max(_last_tick(take.recording, throw) for take in self.takes)
        for tick in range(0, last + 1, self.every):
            yield self._image(throw, tick)

    def _image(self, throw: int, tick: int) -> Image.Image:
        self.painter.start()
        for left, take in zip(self.lefts, self.takes, strict=True):
            self._panel(left, take, throw, tick)
        both = (self.throws.ball, self.throws.arm)
        ball, arm = (IDENTITIES[int(which[throw])] for which in both)
        said = f"throw {throw + 1} of {len(self.throws)}: {ball} ball, {arm} arm"
        width, height = self.painter.size
        self.painter.words((width / 2, height - 11), said, "soft", 13, "ms")
        return self.painter.finish()

    def _panel(self, left: float, take: Take, throw: int, tick: int) -> None:
        recording = take.recording
        at = min(tick, _last_tick(recording, throw))
        over = bool(recording.sensed.time[at, throw] >= recording.final.time[throw])
        self.painter.words((left, 25), take.title, "ink", 17, "ls", bold=True)
        self._score(left, recording, throw + over)
        self._stage(left)
        verdict = ("before", "after")[int(recording.caught[throw])]
        self._trail(left, recording, throw, at, verdict if over else "axis")
        self._cup(left, float(recording.sensed.arm_x[at, throw]), int(self.throws.arm[throw]))
        place = self._place(left, *(float(a[at, throw]) for a in _ball(recording)))
        radius = max(BALLS[0].radius * self.scale, 3.5)
        self.painter.disc(place, radius, verdict if over else "ink",
                          hollow=self.throws.ball[throw] == 0)  # fmt: skip
        if over:
            said = "caught" if recording.caught[throw] else "missed"
            self.painter.words((left + self.wide, 25), said, verdict, 15, "rs", bold=True)

    def _score(self, left: float, recording: Recording, done: int) -> None:
        """One mark for each throw: a disc for a catch, a cross for a miss, else a dot."""
        for i in range(len(self.throws)):
            place = (left + 6 + 17 * i, 42.0)
            if i >= done:
                self.painter.disc(place, 2.0, "axis")
            elif recording.caught[i]:
                self.painter.disc(place, 5.0, "after")
            else:
                self.painter.cross(place, 4.0, "before")

    def _stage(self, left: float) -> None:
        self.painter.line([(left, self.floor), (left + self.wide, self.floor)], "axis", 1.4)
        ends = [self._place(left, x, 0.0) for x in self.layout.arm_travel]
        self.painter.line([(x, y + 5.0) for x, y in ends], "line", 4.0)

    def _trail(self, left: float, recording: Recording, throw: int, at: int, shade: str) -> None:
        x, z = (column[: at + 1, throw].tolist() for column in _ball(recording))
        places = [self._place(left, *point) for point in zip(x, z, strict=True)]
        for place in places[:-1]:
            self.painter.disc(place, 1.3, shade)

    def _cup(self, left: float, x: float, arm: int) -> None:
        half = self.layout.cup.width / 2.0
        corners = ((-half, self.layout.cup.height), (-half, 0), (half, 0),
                   (half, self.layout.cup.height))  # fmt: skip
        walls = [self._place(left, x + dx, z) for dx, z in corners]
        self.painter.line(walls, "ink", 2.4)
        if arm:
            bottom = [(walls[1][0], walls[1][1] + 5.0), (walls[2][0], walls[2][1] + 5.0)]
            self.painter.line(bottom, "ink", 7.0)

    def _place(self, left: float, x: float, z: float) -> tuple[float, float]:
        return left + (x - self.origin) * self.scale, self.floor - z * self.scale


def _last_tick(recording: Recording, throw: int) -> int:
    return int(np.flatnonzero(chosen(recording, throw))[-1])


def _ball(recording: Recording) -> tuple[Array, Array]:
    return recording.sensed.ball_x, recording.sensed.ball_z


def _coloured(indices: Image.Image, scheme: int) -> Image.Image:
    image = indices.copy()
    image.putpalette(shades(scheme))
    return image


def _gif(frames: Sequence[Image.Image], scheme: int) -> bytes:
    first, *rest = (_coloured(frame, scheme) for frame in frames)
    file = BytesIO()
    first.save(
        file,
        format="GIF",
        save_all=True,
        append_images=rest,
        duration=1000 // FRAMES_PER_SECOND,
        loop=0,
        optimize=False,
        disposal=1,
    )
    return file.getvalue()
