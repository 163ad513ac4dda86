"""The scene as a picture, drawn with Pillow."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from handeye.arrays import Booleans
from handeye.catching.ball import BALLS
from handeye.catching.layout import Layout
from handeye.catching.state import CAUGHT, FLYING, KNOCKED_OUT, MISSED, State

WIDTH = 640
"""Of a frame [px]; the height follows from the layout."""

_FINE = 3  # drawn larger and shrunk, so that edges are smooth
_MARGIN = 0.3  # beside and above what can be reached [m]
_BELOW = 0.22  # for the rail and the scale [m]
_WORDS = {FLYING: "", CAUGHT: "caught", MISSED: "missed", KNOCKED_OUT: "out of bounds"}

_SKY, _GROUND, _LINE = "#f5f7f9", "#e3e7ec", "#aab4c0"
_INK, _SOFT, _CUP = "#1c2530", "#566373", "#1263a3"
_BALLS = ("#f0a268", "#b4500e")
_TRAIL = np.array([180, 80, 14])
_PAPER = np.array([245, 247, 249])


class Picture:
    """Pictures of N trials that leave the trail of each ball.

    Args:
        layout: where everything is; the picture shows all of arm travel and flight.
    """

    def __init__(self, layout: Layout = Layout()) -> None:
        self._layout = layout
        reach = (*layout.arm_travel, *layout.launch_x, *layout.crossing_x)
        self._left, self._right = min(reach) - _MARGIN, max(reach) + _MARGIN
        self._top = layout.apex[1] + _MARGIN
        self._scale = _FINE * WIDTH / (self._right - self._left)
        self._height = round(WIDTH * (self._top + _BELOW) / (self._right - self._left))
        self._radii = [ball.radius for ball in BALLS]
        self.begin(1)

    def begin(self, n: int) -> None:
        """Forget all trails; n trials follow."""
        self._trails: list[list[tuple[float, float]]] = [[] for _ in range(n)]

    def forget(self, which: Booleans) -> None:
        """Forget the trails of some trials (N,)."""
        for i in np.flatnonzero(which):
            self._trails[i] = []

    def see(self, state: State) -> None:
        """Remember where the balls are now."""
        for trail, x, z in zip(self._trails, state.x.tolist(), state.z.tolist(), strict=True):
            trail.append((x, z))

    def draw(self, state: State, i: int) -> NDArray[np.uint8]:
        """Trial i now, (height, width, 3)."""
        image = Image.new("RGB", (_FINE * WIDTH, _FINE * self._height), _SKY)
        draw = ImageDraw.Draw(image)
        self._draw_place(draw)
        self._draw_trail(draw, self._trails[i])
        self._draw_cup(draw, float(state.arm_x[i]), heavy=bool(state.arm[i]))
        ball = int(state.ball[i])
        x, z, radius = float(state.x[i]), float(state.z[i]), self._radii[ball]
        self._disc(draw, x, z, radius, _BALLS[ball % 2])
        self._write(draw, state, i)
        small = image.resize((WIDTH, self._height), Image.Resampling.BOX)
        return np.array(small, np.uint8)

    def _at(self, x: float, z: float) -> tuple[float, float]:
        """Pixel of a place."""
        return (x - self._left) * self._scale, (self._top - z) * self._scale

    def _draw_place(self, draw: Any) -> None:
        """Ground with a scale in metres, the rail with its stops, and where balls are launched."""
        right, bottom = _FINE * WIDTH, _FINE * self._height
        level = self._at(0.0, 0.0)[1]
        draw.rectangle((0, level, right, bottom), fill=_GROUND)
        draw.line((0, level, right, level), fill=_LINE, width=_FINE)
        rail = self._at(0.0, -0.05)[1]
        low, high = (self._at(x, 0.0)[0] for x in self._layout.arm_travel)
        half = 0.5 * self._layout.cup.width * self._scale
        draw.line((low - half, rail, high + half, rail), fill=_SOFT, width=2 * _FINE)
        for x in (low - half, high + half):
            draw.line((x, level, x, rail + 3 * _FINE), fill=_SOFT, width=3 * _FINE)
        for metre in range(int(np.ceil(self._left)), int(np.floor(self._right)) + 1):
            x = self._at(metre, 0.0)[0]
            draw.line((x, rail + 6 * _FINE, x, rail + 10 * _FINE), fill=_LINE, width=_FINE)
            draw.text((x, rail + 12 * _FINE), f"{metre} m", fill=_SOFT, font=_font(10), anchor="ma")
        (x0, x1), (z0, z1) = self._layout.launch_x, self._layout.launch_z
        draw.rounded_rectangle(
            (*self._at(x0, z1), *self._at(x1, z0)), 2 * _FINE, outline=_LINE, width=_FINE
        )

    def _draw_trail(self, draw: Any, trail: list[tuple[float, float]]) -> None:
        """Where the ball was at each tick, older ones paler."""
        for age, (x, z) in enumerate(reversed(trail)):
            strength = 0.15 + 0.6 * 0.96**age
            red, green, blue = (strength * _TRAIL + (1.0 - strength) * _PAPER).astype(int)
            self._disc(draw, x, z, 0.009, (int(red), int(green), int(blue)))

    def _draw_cup(self, draw: Any, x: float, *, heavy: bool) -> None:
        """The cup on its carriage; the heavy arm has the large one."""
        cup = self._layout.cup
        left, right = x - 0.5 * cup.width, x + 0.5 * cup.width
        depth = 0.07 if heavy else 0.035
        draw.rectangle((*self._at(left, 0.0), *self._at(right, -depth)), fill=_CUP)
        for side in (left, right):
            draw.line((*self._at(side, 0.0), *self._at(side, cup.height)), fill=_CUP, width=8)

    def _disc(self, draw: Any, x: float, z: float, radius: float, fill: Any) -> None:
        draw.ellipse((*self._at(x - radius, z + radius), *self._at(x + radius, z - radius)), fill)

    def _write(self, draw: Any, state: State, i: int) -> None:
        """What is thrown at what, the time, and how it ended."""
        edge, far = 12 * _FINE, _FINE * (WIDTH - 12)
        ball, arm = (("light", "heavy")[int(which[i]) % 2] for which in (state.ball, state.arm))
        draw.text((edge, edge), f"{ball} ball, {arm} arm", fill=_INK, font=_font(14))
        time = f"{state.time[i]:.3f} s"
        draw.text((far, edge), time, fill=_INK, font=_font(14), anchor="ra")
        word = _WORDS[int(state.outcome[i])]
        draw.text((far, 2.6 * edge), word, fill=_CUP, font=_font(14), anchor="ra")


@lru_cache
def _font(size: int) -> Any:
    load: Callable[..., Any] = ImageFont.load_default
    return load(size * _FINE)
