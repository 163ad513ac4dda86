"""The planar robot that looks, reaches, is bent and learns again, at a glance."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Circle
from matplotlib.quiver import Quiver
from numpy.typing import ArrayLike

from handeye.arrays import Array
from handeye.errors import InvalidInput
from handeye.reports.figures.maps import ErrorScale, draw_errors, draw_scale, spread
from handeye.reports.figures.parts import vectors
from handeye.reports.style import WIDE, color, length, new_figure, styled


@dataclass(frozen=True)
class PlanarArm:
    """The arm as drawn: link lengths [m] with the base at the origin, and where the eye is [m]."""

    links: tuple[float, float]
    eye: tuple[float, float]

    def elbow_and_hand(self, hand: Array) -> tuple[Array, Array]:
        """Where elbow and hand are when the arm reaches for `hand`, as far as it can."""
        a, b = self.links
        asked = float(np.linalg.norm(hand))
        reach = float(np.clip(asked, abs(a - b) + 1e-6, a + b - 1e-6))
        direction = hand / asked if asked else np.array([1.0, 0.0])
        along = (reach**2 + a**2 - b**2) / (2 * reach)
        aside = float(np.sqrt(max(a**2 - along**2, 0.0)))
        elbow = along * direction + aside * np.array([direction[1], -direction[0]])
        return elbow, reach * direction


@dataclass(frozen=True)
class Stage:
    """One moment of the story: where the hand lands when it is sent to each test point.

    positions (K, 2) test points [m]; errors (K, 2) hand minus test point [m]; K and the order of
    the points are the same at every stage. `mean` is the error to state [m], such as one measured
    over more points than are drawn; that of `errors` when None.
    """

    title: str
    positions: ArrayLike
    errors: ArrayLike
    mean: float | None = None


class _Drawn(NamedTuple):
    title: str
    places: Array
    errors: Array
    lengths: Array
    mean: float


@styled
def robot_story(stages: Sequence[Stage], arm: PlanarArm) -> Figure:
    """The robot at each stage: what the eye sees, where the hand goes, how far apart they are.

    Arrows lead from test points to where the hand lands, on one scale for all stages; the arm is
    drawn as it misses its ringed target, a typical one, by an error magnified like the arrows.
    Raises InvalidInput for no stages, empty arrays, values that are not finite or shapes that
    differ.
    """
    figure = new_figure(WIDE, 340)
    draw_stages(
        figure, list(figure.subplots(1, max(len(stages), 1), squeeze=False)[0]), stages, arm
    )
    return figure


def draw_stages(
    figure: Figure | SubFigure, panels: Sequence[Axes], stages: Sequence[Stage], arm: PlanarArm
) -> None:
    """Draw each stage into its panel, and their common scale below them."""
    if not stages:
        raise InvalidInput("a story needs at least one stage, got none")
    drawn = _checked(stages)
    scale = ErrorScale.of(
        np.concatenate([stage.lengths for stage in drawn]), 2 * sum(arm.links), arrow=0.2
    )
    rows = spread(drawn[0].places[:, :2], cells=9)
    ringed = _typical(drawn, sum(arm.links))
    middle = np.sqrt(drawn[0].mean * min(stage.mean for stage in drawn))
    largest = max(stage.mean for stage in drawn)
    arrows: list[Quiver] = []
    for axes, stage in zip(panels, drawn, strict=True):
        shade = color("after" if stage.mean < middle else "before")
        target = stage.places[ringed, :2]
        hand = target + scale.magnification * stage.errors[ringed, :2]
        _draw_robot(axes, arm, target, hand, shade, words=axes is panels[0])
        arrows.append(draw_errors(axes, stage.places[rows], stage.errors[rows], (0, 1), scale))
        axes.set_title(stage.title, fontsize=13, fontweight="normal", color=color("soft"), pad=34)
        axes.annotate(
            length(stage.mean, beside=largest),
            (0.0, 1.0),
            xycoords="axes fraction",
            xytext=(0, 6),
            textcoords="offset points",
            fontsize=22,
            fontweight="bold",
            color=shade,
        )
    draw_scale(figure, list(panels), arrows[0], scale)


def _checked(stages: Sequence[Stage]) -> list[_Drawn]:
    drawn: list[_Drawn] = []
    for stage in stages:
        count = len(drawn[0].places) if drawn else None
        places = vectors(stage.positions, f"positions of {stage.title!r}", count)
        errors = vectors(stage.errors, f"errors of {stage.title!r}", len(places))
        lengths = np.linalg.norm(errors, axis=1)
        mean = float(lengths.mean()) if stage.mean is None else stage.mean
        drawn.append(_Drawn(stage.title, places, errors, lengths, mean))
    return drawn


def _typical(stages: Sequence[_Drawn], reach: float) -> int:
    """The row in front of the robot, if there is one, whose errors are most like the means."""
    x, y, _ = stages[0].places.T
    radius = np.hypot(x, y) / reach
    ahead = (x > 0) & (y > 0.3 * x) & (y < 2.5 * x) & (radius > 0.5) & (radius < 0.9)
    unlike = sum(np.abs(stage.lengths / max(stage.mean, 1e-12) - 1.0) for stage in stages)
    return int(np.argmin(unlike + np.where(ahead, 0.0, 1e9)))


def _draw_robot(
    axes: Axes, arm: PlanarArm, target: Array, hand: Array, shade: str, *, words: bool
) -> None:
    reach = sum(arm.links)
    eye = np.array(arm.eye)
    elbow, hand = arm.elbow_and_hand(hand)
    sight = (target - eye) / max(float(np.linalg.norm(target - eye)), 1e-12)
    axes.add_patch(Circle((0.0, 0.0), reach, color=color("line"), alpha=0.4, lw=0, zorder=0))
    axes.plot(*np.stack([eye, target]).T, color=color("axis"), lw=1.3, ls=(0, (4, 3)), zorder=4)
    bones = np.stack([np.zeros(2), elbow, hand]).T
    axes.plot(*bones, color=color("ink"), lw=5.0, solid_joinstyle="round", zorder=5)
    axes.plot(*bones[:, :2], "o", color=color("ink"), ms=10, zorder=6)
    axes.plot(*bones[:, :2], "o", color=color("card"), ms=4, zorder=7)
    axes.plot(*target, "o", mfc="none", mec=color("ink"), mew=1.8, ms=17, zorder=6)
    axes.plot(*hand, "o", color=shade, ms=10, zorder=8)
    axes.plot(*eye, "o", mfc=color("card"), mec=color("ink"), mew=1.8, ms=15, zorder=6)
    axes.plot(*(eye + 0.03 * reach * sight), "o", color=color("ink"), ms=6, zorder=7)
    if words:
        for place, text, below in ((eye, "eye", -13), (target, "target", 22)):
            axes.annotate(
                text,
                (float(place[0]), float(place[1])),
                xytext=(0, below),
                textcoords="offset points",
                ha="center",
                va="center_baseline" if below > 0 else "top",
                fontsize=12,
                color=color("soft"),
                bbox={"facecolor": color("card"), "alpha": 0.8, "linewidth": 0, "pad": 1.5},
                zorder=9,
            )
    margin = 0.15 * reach
    axes.set_xlim(min(-reach, eye[0]) - margin, max(reach, eye[0]) + margin)
    axes.set_ylim(min(-reach, eye[1]) - margin, max(reach, eye[1]) + margin)
    axes.set_aspect("equal")
    axes.set_axis_off()
