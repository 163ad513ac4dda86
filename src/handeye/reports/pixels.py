"""Small smooth pictures drawn pixel by pixel in the colours of the page.

Their pixels are numbers of blends between the ground and one of the colours, so that the same
drawing serves light and dark ground: only the palette differs.
"""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from handeye.arrays import Array
from handeye.reports.style import PALETTE

Place = tuple[float, float]
"""Across and down from the upper left corner [px]."""

SHARPNESS = 1.5
"""Pixels of the finished picture for each pixel of the page, for screens that are finer."""

_REDUCED = 2
_FINER = SHARPNESS * _REDUCED
_INKS = ("ink", "soft", "line", "axis", "before", "after")
_BLENDS = 9
_DROPPED = 2


class Painter:
    """Draws on a picture several times finer, whose reduction smooths every edge.

    size  width and height on the page [px]; all lengths are in pixels of the page
    """

    def __init__(self, size: tuple[int, int]) -> None:
        self.size = size
        self.start()

    def start(self) -> None:
        """Begin a new picture with the ground alone."""
        width, height = self.size
        fine = (_REDUCED * round(SHARPNESS * width), _REDUCED * round(SHARPNESS * height))
        self._image = Image.new("RGB", fine, PALETTE["card"][0])
        self._pen = ImageDraw.Draw(self._image)

    def finish(self) -> Image.Image:
        """The finished picture."""
        return self._image.reduce(_REDUCED)

    def line(self, places: Sequence[Place], shade: str, width: float) -> None:
        """A line with round ends and corners through `places`."""
        fine = [(_FINER * x, _FINER * y) for x, y in places]
        self._pen.line(fine, PALETTE[shade][0], round(_FINER * width), joint="curve")
        for x, y in places:
            self.disc((x, y), width / 2.0, shade)

    def disc(self, place: Place, radius: float, shade: str, *, hollow: bool = False) -> None:
        """A disc, or a ring whose inside shows the ground."""
        self._disc(place, radius, shade)
        if hollow:
            self._disc(place, radius - 1.5, "card")

    def cross(self, place: Place, radius: float, shade: str) -> None:
        """Two crossed lines."""
        x, y = place
        for side in (-radius, radius):
            self.line([(x - radius, y - side), (x + radius, y + side)], shade, 2.2)

    def words(
        self, place: Place, text: str, shade: str, size: int, anchor: str, *, bold: bool = False
    ) -> None:
        """`text` of a height of `size` px; `anchor` as in Pillow, such as "ls": left, baseline."""
        x, y = place
        font = _font(round(_FINER * size), bold)
        self._pen.text((_FINER * x, _FINER * y), text, PALETTE[shade][0], font, anchor)

    def _disc(self, place: Place, radius: float, shade: str) -> None:
        x, y, r = (_FINER * value for value in (*place, radius))
        self._pen.ellipse((x - r, y - r, x + r, y + r), PALETTE[shade][0])


def as_indices(image: Image.Image) -> Image.Image:
    """Each pixel of a picture for light ground as the number of the nearest blend."""
    red, green, blue = np.moveaxis(np.asarray(image) >> _DROPPED, -1, 0)
    indices = Image.fromarray(_nearest()[red, green, blue])
    indices.putpalette(shades(0))
    return indices


@cache
def _nearest() -> NDArray[np.uint8]:
    """The number of the blend nearest to each colour, by the upper bits of red, green and blue."""
    kept = 256 >> _DROPPED
    middles = (np.arange(kept, dtype=np.float32) + 0.5) * (1 << _DROPPED) - 0.5
    least = np.full((kept, kept, kept), np.inf, np.float32)
    nearest = np.zeros(least.shape, np.uint8)
    for number, blend in enumerate(np.reshape(shades(0), (-1, 3))):
        red, green, blue = ((middles - part) ** 2 for part in blend.astype(np.float32))
        away = red[:, None, None] + green[:, None] + blue
        nearer = away < least
        least[nearer], nearest[nearer] = away[nearer], number
    return nearest


def shades(scheme: int) -> list[int]:
    """Red, green and blue of every blend: for light ground with `scheme` 0, for dark with 1.

    The ground comes first, then each colour in steps of equal size from the ground to itself.
    """
    ground = _rgb(PALETTE["card"][scheme])
    steps = np.arange(1, _BLENDS + 1)[:, None] / _BLENDS
    blends = [ground + steps * (_rgb(PALETTE[ink][scheme]) - ground) for ink in _INKS]
    return np.concatenate([ground[None], *blends]).round().astype(int).ravel().tolist()


def _rgb(shade: str) -> Array:
    return np.array([int(shade[i : i + 2], 16) for i in (1, 3, 5)], dtype=np.float64)


@cache
def _font(size: int, bold: bool) -> ImageFont.FreeTypeFont:
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(mpl.get_data_path()) / "fonts" / "ttf" / name), size)
