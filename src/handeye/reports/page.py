"""A report page from a few building blocks: tiles, tables, figures, paragraphs and notes.

One file with its style and pictures inside: it asks nothing from the network and runs no script.
"""

import os
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import ClassVar, Literal

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from handeye.errors import InvalidInput
from handeye.reports.files import write_file
from handeye.reports.style import PALETTE
from handeye.reports.svg import inline_svg

Tone = Literal["good", "bad", "neutral"]


@dataclass(frozen=True)
class Tile:
    """One number that matters: "Mean error after", "0.39", "mm", "495 rows held out"."""

    label: str
    value: str
    unit: str = ""
    note: str = ""
    tone: Tone = "neutral"


@dataclass(frozen=True)
class StatTiles:
    """A row of tiles."""

    tiles: Sequence[Tile]
    kind: ClassVar[str] = "tiles"


@dataclass(frozen=True)
class Badge:
    """A verdict in a table cell; the tone colours what the words already say."""

    text: str
    tone: Tone = "neutral"


@dataclass(frozen=True)
class Table:
    """Rows under column heads. Columns of `words` (by number) are set left, all others right.

    `emphasis` names the rows (by number) that carry the result.
    """

    columns: Sequence[str]
    rows: Sequence[Sequence[str | Badge]]
    caption: str = ""
    words: frozenset[int] = frozenset({0})
    emphasis: frozenset[int] = frozenset()
    kind: ClassVar[str] = "table"

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise InvalidInput(
                    f"a table row has {len(row)} cells for {len(self.columns)} columns: {row!r}"
                )


@dataclass(frozen=True)
class FigureBlock:
    """A figure with a caption that says what to see and `alt`, what the picture shows."""

    figure: Figure
    caption: str
    alt: str
    kind: ClassVar[str] = "figure"


@dataclass(frozen=True)
class AnimationBlock:
    """A moving picture with a caption and `alt`, as for a figure.

    light, dark  GIF files for light and for dark ground
    still        PNG file for readers who want no motion, and for paper
    width        of the picture on the page, at most [px]
    """

    light: bytes
    dark: bytes
    still: bytes
    width: int
    caption: str
    alt: str
    kind: ClassVar[str] = "animation"

    @property
    def urls(self) -> dict[str, str]:
        """The pictures as addresses that hold them."""
        kinds = {"light": "gif", "dark": "gif", "still": "png"}
        return {
            name: f"data:image/{kind};base64,{b64encode(getattr(self, name)).decode()}"
            for name, kind in kinds.items()
        }


@dataclass(frozen=True)
class Prose:
    """Paragraphs, separated by empty lines."""

    text: str
    kind: ClassVar[str] = "prose"

    @property
    def paragraphs(self) -> list[str]:
        """The text between empty lines."""
        return [part.strip() for part in self.text.split("\n\n") if part.strip()]


@dataclass(frozen=True)
class Notes:
    """A list of remarks that can be long, such as rejected rows; folded when `folded`."""

    title: str
    items: Sequence[str]
    folded: bool = False
    kind: ClassVar[str] = "notes"


Block = StatTiles | Table | FigureBlock | AnimationBlock | Prose | Notes


@dataclass(frozen=True)
class Section:
    """Blocks under a heading; the first section of a page may go without one."""

    heading: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Page:
    """A page whose `headline` says the result in words.

    title     what it is, for the browser's tab and the line above the headline
    subtitle  the circumstances: robot, log, method
    settings  everything needed to make the page again, for the footer
    date      shown as given; left out by default, so that the same run gives the same file
    """

    title: str
    headline: str
    subtitle: str
    sections: Sequence[Section]
    settings: Mapping[str, str] = field(default_factory=dict[str, str])
    date: str = ""

    def html(self) -> str:
        """The page as text, the same for the same content."""
        figures = [
            block
            for section in self.sections
            for block in section.blocks
            if isinstance(block, FigureBlock)
        ]
        drawings = {
            id(block): Markup(inline_svg(block.figure, f"figure{i}", block.alt))
            for i, block in enumerate(figures, start=1)
        }
        environment = Environment(
            loader=PackageLoader("handeye.reports"),
            autoescape=True,
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
        )
        template = environment.get_template("page.html.j2")
        return template.render(
            page=self, drawings=drawings, id=id, palette=PALETTE, version=version("handeye")
        )

    def write(self, path: str | os.PathLike[str]) -> Path:
        """Write the page and return its path; folders are made, an older page is replaced.

        Raises InvalidInput with the reason when the place cannot be written to.
        """
        target = Path(path)
        write_file(target, self.html().encode("utf-8"))
        return target
