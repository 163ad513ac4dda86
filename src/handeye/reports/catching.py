"""The page that tells how a robot learned to catch, and how well it does."""

from collections.abc import Sequence

import numpy as np

from handeye.catching.layout import Layout
from handeye.catching.play import Recording
from handeye.catching.results import CatchingResult, Score, Take, network_name, sum_of, total_of
from handeye.reports.animation import Animation
from handeye.reports.figures.catching_cup import early_and_late, seen_from_the_cup
from handeye.reports.figures.catching_layout import catching_layout
from handeye.reports.figures.catching_parts import percent, undisturbed
from handeye.reports.figures.catching_results import catching_curve, prediction_error
from handeye.reports.figures.catching_trial import one_throw
from handeye.reports.figures.parts import thinned
from handeye.reports.page import (
    AnimationBlock,
    Block,
    FigureBlock,
    Page,
    Section,
    StatTiles,
    Table,
    Tile,
)
from handeye.reports.style import length, significant

_MOVING, _BESIDE_EACH_OTHER = 3, 4
_MIDDLING, _FAR = 0.6, 100.0


def catching_page(
    result: CatchingResult, animation: Animation, *, layout: Layout, date: str = ""
) -> Page:
    """Headline, numbers, the animation, and what happened in flight, in mind and in training.

    animation  of `moving_takes`
    Raises InvalidInput for a result without test throws.
    """
    total = total_of(result.test)
    return Page(
        title="Learning to catch",
        headline=_headline(result, total),
        subtitle=_subtitle(result),
        sections=[
            Section("", [_tiles(result, total), _moving(result, animation)]),
            Section("In numbers", [_scores(result)]),
            Section("How balls come in", [_from_the_cup(result, layout)]),
            Section("Tick by tick", _throws(result)),
            Section("Where the ball will come down", [_prediction(result)]),
            *_training(result, layout),
            Section("The place", [_place(result, layout)]),
            Section("What it keeps in mind", [_neurons(result)]),
        ],
        settings=result.settings,
        date=date,
    )


def _subtitle(result: CatchingResult) -> str:
    mentored = any(mark.mentored for mark in result.marks)
    practice = (
        "practised pursuits with its arm, watched balls fly, and took advice from a mentor"
        if mentored
        else "practised pursuits with its arm and watched balls fly"
    )
    return (
        "A cup on a rail and a tossed ball. The robot is told neither masses nor laws of motion: "
        f"it {practice}."
    )


def _headline(result: CatchingResult, total: Score) -> str:
    now = f"catches {total.caught:,} of {total.n:,} throws"
    first = result.marks[0] if result.marks else None
    if first is None or first.pursuits or first.mentored:
        return f"The robot {now}."
    before = sum_of(first.scores)
    if total.share <= before.share:
        return f"The robot {now}: practice has not helped yet."
    return (
        f"The robot learned to catch: it {now}; before practice it caught {before.caught} of "
        f"{before.n}."
    )


def _tiles(result: CatchingResult, total: Score) -> StatTiles:
    low, high = total.interval
    share, unit = percent(total.share).rsplit("\N{NO-BREAK SPACE}", 1)
    error, error_unit = length(total.rms).split()
    tiles = [
        Tile("Caught", share, unit, f"of {total.n:,} test throws; 95 % interval from "
             f"{percent(low)} to {percent(high)}", "good" if total.share > 0.5 else "bad"),
        Tile("Cup off the crossing", error, error_unit, "root mean square"),
        Tile("Neurons", f"{sum(result.neurons.values()):,}",
             note=f"in {np.count_nonzero(list(result.neurons.values()))} networks"),
        Tile("Practice", significant(result.cpu_seconds, 2) if result.cpu_seconds else "0", "s",
             "of processor time"),
    ]  # fmt: skip
    return StatTiles(tiles)


def _moving(result: CatchingResult, animation: Animation) -> AnimationBlock:
    titles = ", ".join(take.title for take in result.takes)
    return AnimationBlock(
        animation.light,
        animation.dark,
        animation.still,
        animation.size[0],
        "The same throws at different moments of training, in real time. A ring is the light ball, "
        "a disc the heavy one; the heavy arm has a weight below its cup. Marks on top count: a dot "
        "for a catch, a cross for a miss.",
        f"An arm moves a cup along a rail to catch balls, side by side at moments of training: "
        f"{titles}.",
    )


def _scores(result: CatchingResult) -> Table:
    rows: list[list[str]] = []
    for score in result.scores:
        low, high = score.interval
        rows.append(
            [score.name, f"{score.caught:,} of {score.n:,}", percent(score.share),
             f"{percent(low)} to {percent(high)}", significant(100.0 * score.rms, 2)]
        )  # fmt: skip
    return Table(
        ("Throws", "Caught", "Share", "95 % interval", "Off the crossing, rms [cm]"),
        rows,
        "Fresh throws that had no part in training. The interval is Wilson's.",
    )


def _from_the_cup(result: CatchingResult, layout: Layout) -> FigureBlock:
    return FigureBlock(
        seen_from_the_cup(result.test, layout),
        "Paths of the ball's centre relative to the cup: blue ends in it, orange does not. Up to "
        "60 catches and as many misses are drawn for each pair of ball and arm.",
        "Paths of balls near the cup, for each pair of ball and arm.",
    )


def _throws(result: CatchingResult) -> list[Block]:
    usual, surprised = _typical(result.test, sure=True), _typical(result.surprised)
    reading = (
        "Top: the ball, the cup (its width shaded) and where the ball is predicted to come down; "
        "the ring is where it does. Below: what the arm is told, how far predictions are off in "
        "units of what is tolerated, and what ball and arm are taken for."
    )
    alt = "Position, command voltage, surprise and believed identities over the time of one throw."
    return [
        FigureBlock(one_throw(result.test, usual), f"A throw as it should be. {reading}", alt),
        FigureBlock(
            one_throw(result.surprised, surprised),
            "A throw at which it believed in the wrong ball and the wrong arm at first. "
            "Predictions fail, surprise rises, and recognition says in mid-flight what it is.",
            f"{alt} The first beliefs are wrong.",
        ),
    ]


def _typical(recording: Recording, *, sure: bool = False) -> int:
    """A throw to show: caught if any is, with a middling way for the arm.

    sure  rather one in which ball and arm were never taken for anything else
    """
    throws, traces = recording.throws, recording.traces
    wanted = recording.caught.astype(np.float64)
    if sure:
        over = ~undisturbed(recording)
        right = (traces["ball"] == throws.ball) & (traces["arm"] == throws.arm)
        wanted += (right | over).all(axis=0)
    way = np.abs(throws.crossing_x - throws.arm_x)
    return int(np.argmin(np.abs(way - _MIDDLING) - _FAR * wanted))


def _prediction(result: CatchingResult) -> FigureBlock:
    return FigureBlock(
        prediction_error(result.test),
        "Lines are medians over the test throws; 95 % of the errors lie below the upper edge of "
        "the band. Nothing is predicted until enough of the flight has been seen.",
        "Error of the predicted crossing in place and in time over the time of flight.",
    )


def _training(result: CatchingResult, layout: Layout) -> list[Section]:
    blocks: list[Block] = []
    if len(result.marks) > 1:
        n = result.marks[0].scores[0].n
        blocks.append(
            FigureBlock(
                catching_curve(result.marks),
                f"Tested on the same {n} throws of each kind at every mark; bars are 95 % "
                "intervals. Balls had been watched before the first pursuit.",
                "Share of throws caught and position error over the practice so far.",
            )
        )
    if len(result.takes) > 1:
        takes = _spread(_able(result.takes), _BESIDE_EACH_OTHER)
        blocks.append(
            FigureBlock(
                early_and_late(takes, _telling(takes), layout),
                "One throw at different moments of training: the voltage that the arm was told, "
                "and the ball's path as seen from the cup.",
                "Command voltage and path relative to the cup, early and late in training.",
            )
        )
    return [Section("Early and late", blocks)] if blocks else []


def _place(result: CatchingResult, layout: Layout) -> FigureBlock:
    return FigureBlock(
        catching_layout(layout, result.test),
        "To scale, with some of the test throws. The learner is not told any of these numbers.",
        "The catching place: launch region, apexes, crossings, travel of the cup.",
    )


def moving_takes(result: CatchingResult) -> list[Take]:
    """The takes for the animation: early, midway and late, without the arm that cannot move yet."""
    return _spread(_able(result.takes), _MOVING)


def _able(takes: Sequence[Take]) -> list[Take]:
    """The takes in which the arm was told to move at all; if there are none, those there are."""
    return [take for take in takes if np.any(take.recording.voltage > 0.0)] or list(takes)


def _telling(takes: Sequence[Take]) -> int:
    """The throw that was missed most often before it was caught in the last take."""
    missed = np.sum([~take.recording.caught for take in takes], axis=0)
    return int(np.argmax(np.where(takes[-1].recording.caught, missed, -1)))


def _spread(takes: Sequence[Take], most: int) -> list[Take]:
    """At most so many takes, the first, the last and some evenly between."""
    return [takes[i] for i in thinned(len(takes), most).tolist()]


def _neurons(result: CatchingResult) -> Table:
    rows = [[network_name(key), f"{count:,}"] for key, count in result.neurons.items() if count]
    return Table(("Network", "Neurons"), rows, "Each network grows with what surprises it.")
