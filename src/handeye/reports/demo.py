"""The page and the still of the demonstration: a robot learns to reach where it looks."""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees

import numpy as np
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from handeye.arrays import Array, Integers, shaped
from handeye.errors import InvalidInput
from handeye.reports.figures import Curve, PlanarArm, Stage, learning_curve, robot_story
from handeye.reports.figures.curves import draw_curves
from handeye.reports.figures.parts import thousands
from handeye.reports.figures.story import draw_stages
from handeye.reports.page import FigureBlock, Page, Prose, Section, StatTiles, Tile
from handeye.reports.style import length, new_figure, styled


@dataclass(frozen=True)
class DemoRun:
    """What the demonstration measured at M checkpoints, as plain arrays.

    trials (M,)           trials learned from so far, increasing
    corrected (M,)        mean error over the test points with learning [m]
    corrected_std (M,)    sample standard deviation of the same [m]
    uncorrected (M,)      mean error with nominal kinematics [m]
    network (M,)          mean error of a network alone that saw the same reaches [m]
    bend_trial, bend      when the arm was bent, and by how much [rad]; `trials` holds bend_trial
                          twice, measured just before and just after
    noticed               what the robot made of the bend, in words; empty for nothing
    noise_floor           mean error that sensor noise alone would leave [m]
    before, learned, bent, relearned
                          the test points and the hand's errors there at the four moments
    """

    trials: Array | Integers
    corrected: Array
    corrected_std: Array
    uncorrected: Array
    network: Array
    bend_trial: int
    bend: float
    noticed: str
    noise_floor: float
    before: Stage
    learned: Stage
    bent: Stage
    relearned: Stage
    arm: PlanarArm

    def __post_init__(self) -> None:
        m = len(shaped(self.trials, (None,), "trials"))
        if m == 0:
            raise InvalidInput("trials is empty: the demonstration measured nothing")
        for name in ("corrected", "corrected_std", "uncorrected", "network"):
            shaped(getattr(self, name), (m,), name)
        if np.count_nonzero(np.asarray(self.trials) == self.bend_trial) != 2:
            raise InvalidInput(
                f"trials must hold the trial of the bend ({self.bend_trial}) twice: "
                "measure once just before and once just after it"
            )

    @property
    def means(self) -> tuple[float, float, float, float]:
        """The corrected mean error at the four moments [m]."""
        learned, bent = np.flatnonzero(np.asarray(self.trials) == self.bend_trial)
        first, learned, bent, last = (float(self.corrected[i]) for i in (0, learned, bent, -1))
        return first, learned, bent, last

    @property
    def stages(self) -> list[Stage]:
        """The four moments in order, each with its measured mean."""
        drawn = (self.before, self.learned, self.bent, self.relearned)
        return [replace(stage, mean=m) for stage, m in zip(drawn, self.means, strict=True)]


def demo_page(run: DemoRun, *, settings: Mapping[str, str], date: str = "") -> Page:
    """The demonstration as a page: the story in four pictures, the curve, the numbers.

    Raises InvalidInput for arrays that are empty, not finite or of lengths that differ.
    """
    return Page(
        title="handeye demonstration",
        headline=_headline(run),
        subtitle="A planar arm reaches for what its stereo eye sees. Its model of itself is "
        "slightly wrong, and its eye is noisy. Every reach shows where the hand really went; "
        "from that it learns what is wrong with itself, one reach at a time.",
        sections=[
            Section("", [_tiles(run)]),
            Section("Four moments", [_story(run)]),
            Section("Learning, reach by reach", [_curve(run), _explanation(run)]),
        ],
        settings=settings,
        date=date,
    )


@styled
def demo_still(run: DemoRun) -> Figure:
    """The story in one picture, twice as wide as high: four moments above, the curve below."""
    figure = new_figure(1000, 500)
    figure.set_layout_engine("constrained", rect=(0.012, 0.015, 0.976, 0.97))
    grid = GridSpec(2, 1, figure=figure, height_ratios=(1.45, 1.0))
    upper, lower = figure.add_subfigure(grid[0]), figure.add_subfigure(grid[1])
    draw_stages(upper, list(upper.subplots(1, 4)), run.stages, run.arm)
    below = lower.add_subplot()
    draw_curves(below, *_drawn(run), 140.0)
    below.set_xlabel("Reaches learned from")
    thousands(below)
    return figure


def _headline(run: DemoRun) -> str:
    first, learned, bent, last = run.means
    if not (learned < 0.9 * first and last < 0.9 * bent):
        return (
            f"The hand lands {length(last, beside=first)} from where the eye looks; it was "
            f"{length(first)} before learning."
        )
    return (
        f"The robot learned to reach where it looks: {length(learned, beside=first)} off instead "
        f"of {length(first)}. Bent by {_angle(run)}, it learned again."
    )


def _angle(run: DemoRun) -> str:
    angle = f"{abs(degrees(run.bend)):.3g}"
    return f"{angle} degree{'' if angle == '1' else 's'}"


def _drawn(
    run: DemoRun,
) -> tuple[list[Curve], list[tuple[float, str]], list[tuple[float, str]]]:
    low, high = run.corrected - run.corrected_std, run.corrected + run.corrected_std
    curves = [
        Curve("with learning", run.trials, run.corrected, low, high, color="after"),
        Curve("network alone", run.trials, run.network, color="third"),
        Curve("without learning", run.trials, run.uncorrected, color="before"),
    ]
    marks = [(float(run.bend_trial), f"the arm is bent by {_angle(run)}")]
    return curves, marks, [(run.noise_floor, "sensor noise alone")]


def _tiles(run: DemoRun) -> StatTiles:
    first, learned, bent, last = run.means

    def tile(label: str, value: float, note: str, good: bool) -> Tile:
        number, unit = length(value, beside=max(run.means)).split()
        return Tile(label, number, unit, note, "good" if good else "bad")

    return StatTiles(
        [
            tile("Before learning", first, "mean error of the hand", False),
            tile(
                f"After {run.bend_trial:,} reaches",
                learned,
                _times(first, learned),
                learned < first,
            ),
            tile("Just bent", bent, f"by {_angle(run)}", False),
            tile(
                f"After {int(run.trials[-1]) - run.bend_trial:,} more",
                last,
                f"noise alone: {length(run.noise_floor, beside=max(run.means))}",
                last < bent,
            ),
        ]
    )


def _times(before: float, after: float) -> str:
    return f"{before / after:.1f} times closer" if 0 < after < before else "no closer"


def _story(run: DemoRun) -> FigureBlock:
    return FigureBlock(
        robot_story(run.stages, run.arm),
        "The eye (left) looks at a target (ring) and the arm reaches for it. Arrows lead from "
        "other test points to where the hand lands; arrows and the arm's own miss are magnified "
        "alike. Learning shortens them, the bend brings them back, learning shortens "
        "them again.",
        "Four drawings of a two-link arm: before learning, after learning, right after it is bent, "
        "and after learning again, each with error arrows over the workspace.",
    )


def _curve(run: DemoRun) -> FigureBlock:
    curves, marks, references = _drawn(run)
    return FigureBlock(
        learning_curve(
            curves,
            x_label="Reaches learned from",
            marks=marks,
            references=references,
        ),
        "Mean error over fresh test points; the band is one standard deviation of single reaches "
        "to either side. Nobody tells the robot that it was bent: the surprise is the signal"
        f"{f', and it says: {run.noticed}' if run.noticed else ''}.",
        "Mean position error over the number of reaches, with learning, by a network alone, and "
        "without learning.",
    )


def _explanation(run: DemoRun) -> Prose:
    floor = length(run.noise_floor, beside=max(run.means))
    learned, bent = np.flatnonzero(np.asarray(run.trials) == run.bend_trial)
    luck = (
        "\n\nThis bend happens to cancel part of the arm's old errors, so without learning the "
        "hand now lands closer. With learning it first lands further off, because what was learned "
        "fitted the old arm."
        if run.uncorrected[bent] < run.uncorrected[learned]
        else ""
    )
    return Prose(
        "Without learning, the arm goes where its data sheet says. With learning, the lengths, "
        "offsets and error curves of the whole chain from shoulder to eye are estimated together, "
        "and a run of surprises is traced to the part that explains it. The network alone, the "
        "thesis's learner, knows nothing of that chain and has to learn each corner of the "
        "workspace by itself: it needs thousands of reaches."
        f"{luck}\n\nThe dotted line is the limit: even with perfect kinematics, the noise of the "
        f"eye alone would leave {floor}."
    )
