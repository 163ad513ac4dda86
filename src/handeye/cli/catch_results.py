"""What `handeye catch` says in the end: tables, JSON, and a page with an animation."""

from pathlib import Path
from typing import Any

from handeye.catching.course import Beginning, Course
from handeye.catching.layout import Layout
from handeye.catching.results import (
    CatchingResult,
    network_name,
    total_of,
)
from handeye.cli.console import no_page, out, progress_bar, table
from handeye.errors import MissingExtra
from handeye.io.files import replace_file


def tested(course: Course, throws: int, beginning: Beginning, settings: str) -> CatchingResult:
    """Test a course's learner on `throws` fresh throws of each ball to each arm.

    settings  what those of the learner are called
    """
    learner, plan = course.learner, course.plan
    return CatchingResult(
        test=course.test(throws, beginning),
        surprised=course.surprise(),
        takes=course.takes,
        marks=course.marks,
        neurons=learner.neurons,
        cpu_seconds=course.cpu_seconds,
        settings={
            "settings": settings,
            "pursuits with each arm": f"{min(learner.pursuits[arm] for arm in plan.arms):,}",
            "tosses of each ball": f"{min(learner.tosses[ball] for ball in plan.balls):,}",
            "throws with the mentor": f"{learner.mentored:,}",
            "ball and arm at the start of a test throw": beginning,
            "replicate": str(plan.replicate),
        },
    )


def write_page(
    result: CatchingResult, layout: Layout, folder: Path, still: Path | None
) -> dict[str, Path]:
    """Write the page and the animation, if what draws them is installed; returns where they are."""
    try:
        from handeye.reports.animation import catching_animation  # noqa: PLC0415 (an extra)
        from handeye.reports.catching import catching_page, moving_takes  # noqa: PLC0415
        from handeye.reports.figures.catching_still import catching_still  # noqa: PLC0415
        from handeye.reports.svg import write_png  # noqa: PLC0415
    except MissingExtra as missing:
        no_page(missing)
        return {}
    takes = moving_takes(result)
    with progress_bar("drawing", len(takes[0].recording) + 1) as (progress, task):
        animation = catching_animation(
            takes, layout, lambda drawn: progress.update(task, completed=drawn)
        )
        page = catching_page(result, animation, layout=layout).write(folder / "catch.html")
        if still is not None:
            write_png(catching_still(result.marks, result.takes, layout), still)
    moving = folder / "catch.gif"
    replace_file(moving, animation.light)
    return {"page": page, "animation": moving}


def as_data(result: CatchingResult, files: dict[str, Path]) -> dict[str, Any]:
    """Everything that was measured; lengths in metres."""
    return {
        "settings": dict(result.settings),
        "scores": [score.to_json() for score in result.scores],
        "total": total_of(result.test).to_json(),
        "marks": [
            {"pursuits": mark.pursuits, "mentored": mark.mentored,
             "scores": [score.to_json() for score in mark.scores]}
            for mark in result.marks
        ],
        "neurons": dict(result.neurons),
        "cpu_seconds": result.cpu_seconds,
        "files": {name: str(path) for name, path in files.items()},
    }  # fmt: skip


def print_result(result: CatchingResult) -> None:
    """Catches and neurons as tables."""
    total = total_of(result.test)
    shown = table(
        f"Caught {total.caught:,} of {total.n:,} test throws",
        "", "caught", "share", "95 % interval", "rms error",
    )  # fmt: skip
    for score in result.scores:
        low, high = score.interval
        shown.add_row(
            score.name, f"{score.caught} of {score.n}", f"{100 * score.share:.1f} %",
            f"{100 * low:.1f} to {100 * high:.1f} %", f"{100 * score.rms:.1f} cm",
        )  # fmt: skip
    console = out()
    console.print(shown)
    networks = table("What it learned", "network", "neurons")
    for key, count in result.neurons.items():
        if count:
            networks.add_row(network_name(key), f"{count:,}")
    console.print(networks)
    console.print(f"practice   {result.cpu_seconds:.1f} s of processor time", highlight=False)
