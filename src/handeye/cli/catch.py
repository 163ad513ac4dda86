"""`handeye catch`: a robot learns to catch balls, is tested, and shows how it went."""

import signal
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from handeye.catching.course import Course, Plan, Practice, Step
from handeye.catching.course_file import load_course, save_course
from handeye.catching.learner import Learner
from handeye.catching.results import IDENTITIES
from handeye.catching.settings import IMPROVED, SMOOTH, THESIS
from handeye.catching.world import World
from handeye.cli.catch_results import as_data, print_result, tested, write_page
from handeye.cli.console import err, out, progress_bar, write_json
from handeye.errors import InvalidInput

INTERRUPTED = 130
"""Exit code when the user stopped the course, as shells have it."""


class SettingsName(StrEnum):
    """Which learner."""

    thesis = "thesis"
    improved = "improved"
    smooth = "smooth"


class Which(StrEnum):
    """Which arms or balls."""

    light = "light"
    heavy = "heavy"
    both = "both"


class Identities(StrEnum):
    """What the learner believes when a test throw begins."""

    known = "known"
    unknown = "unknown"
    wrong = "wrong"


_SETTINGS = {"thesis": THESIS, "improved": IMPROVED, "smooth": SMOOTH}
_WHICH = {Which.light: (0,), Which.heavy: (1,), Which.both: (0, 1)}


def catch(
    settings: Annotated[
        SettingsName | None,
        typer.Option(
            help="The learner: as in the thesis, improved (the default), or improved with smooth "
            "movements.",
            show_default=False,
        ),
    ] = None,
    pursuits: Annotated[
        int | None,
        typer.Option(min=0, help="Pursuits practised with each arm; 300 by default."),
    ] = None,
    tosses: Annotated[
        int | None, typer.Option(min=0, help="Tosses watched of each ball; 100 by default.")
    ] = None,
    mentored: Annotated[
        int | None,
        typer.Option(
            min=0,
            help="Throws with the mentor in all; 50 by default, if the learner takes advice.",
        ),
    ] = None,
    throws: Annotated[
        int, typer.Option("--test", min=1, help="Test throws of each ball to each arm.")
    ] = 200,
    arm: Annotated[Which | None, typer.Option(help="Arms; both by default.")] = None,
    ball: Annotated[Which | None, typer.Option(help="Balls; both by default.")] = None,
    identities: Annotated[
        Identities,
        typer.Option(help="What it believes of ball and arm when a test throw begins."),
    ] = Identities.known,
    learner: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Go on with a saved learner.", show_default=False),
    ] = None,
    save: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Keep what is learned, during practice too; Ctrl-C then loses nothing.",
            show_default=False,
        ),
    ] = None,
    folder: Annotated[
        Path, typer.Option("--out", help="Folder for the report page and the animation.")
    ] = Path("out"),
    json_file: Annotated[
        str | None, typer.Option("--json", help="Also write the results as JSON; - prints them.")
    ] = None,
    replicate: Annotated[
        int | None, typer.Option(min=0, help="Another number, other random throws; 0 by default.")
    ] = None,
    still: Annotated[
        Path | None, typer.Option(help="Also write the story as one PNG picture.", hidden=True)
    ] = None,
) -> None:
    """Watch a robot learn to catch balls, from nothing.

    Its arm makes random pursuits, it watches balls fly, and with --settings thesis, a mentor
    tells it after each throw how much farther or earlier to go (chapter 4 of Ruoff 1993). Then it
    is tested on fresh throws.
    Writes a page with the whole story and an animation.
    """
    changes: dict[str, Any] = {
        "pursuits": pursuits, "tosses": tosses, "mentored": mentored, "replicate": replicate,
        "arms": None if arm is None else _WHICH[arm],
        "balls": None if ball is None else _WHICH[ball],
    }  # fmt: skip
    changes = {name: value for name, value in changes.items() if value is not None}
    _require_places(folder, json_file)
    course = _new(settings, changes) if learner is None else _saved(learner, settings, changes)
    if not _practise(course, save):
        raise typer.Exit(INTERRUPTED)
    result = tested(course, throws, identities.value, _name_of(course))
    files = write_page(result, course.world.layout, folder, still)
    if save is not None:
        files["learner"] = save
    if json_file is not None:
        write_json(as_data(result, files), json_file)
    if json_file != "-":
        print_result(result)
        for name, path in files.items():
            out().print(f"{name:<10} {escape(str(path))}", highlight=False, soft_wrap=True)


def _require_places(folder: Path, json_file: str | None) -> None:
    """Find out before practice whether results can be written after it."""
    folder.mkdir(parents=True, exist_ok=True)
    if json_file in {None, "-"}:
        return
    target = Path(str(json_file))
    if target.is_dir():
        raise InvalidInput(f"{target} is a folder: --json needs a file name, or - to print")
    target.parent.mkdir(parents=True, exist_ok=True)


def _name_of(course: Course) -> str:
    known = [name for name, each in _SETTINGS.items() if each == course.learner.settings]
    return known[0] if known else "its own"


def _new(settings: SettingsName | None, changes: dict[str, Any]) -> Course:
    chosen = _SETTINGS[settings or SettingsName.improved]
    return Course(Learner(chosen), World(), Plan(**changes))


def _saved(path: Path, settings: SettingsName | None, changes: dict[str, Any]) -> Course:
    """The course in a file, with the changes to its plan that were asked for."""
    course = load_course(path, World())
    if settings is not None and course.learner.settings != _SETTINGS[settings]:
        raise InvalidInput(f"the learner in {path} has other settings: leave out --settings")
    replicate = course.plan.replicate
    if course.has_begun and changes.get("replicate", replicate) != replicate:
        raise InvalidInput(
            f"the learner in {path} practises with replicate {replicate}: leave out --replicate"
        )
    course.plan = replace(course.plan, **changes)
    return course


def _practise(course: Course, save: Path | None) -> bool:
    """Run the course with a bar and checkpoints; False if the user stopped it before its end."""
    total = course.trials_left
    with _stoppable() as stopped, progress_bar("practising", max(total, 1)) as (progress, task):

        def before_each(step: Step) -> bool:
            progress.update(task, completed=total - course.trials_left, description=_said(step))
            if save is not None:
                save_course(save, course)
            return not stopped()

        ended = course.run(before_each)
    if save is not None:
        save_course(save, course)
    if not ended:
        _say_how_to_go_on(course.trials_left, save)
    return ended


def _said(step: Step) -> str:
    if not isinstance(step, Practice):
        return "testing"
    if step.kind == "mentored":
        return "throws with the mentor"
    name = IDENTITIES[step.identity]
    return f"watching the {name} ball" if step.kind == "tosses" else f"moving the {name} arm"


def _say_how_to_go_on(left: int, save: Path | None) -> None:
    how = "nothing is kept without --save FILE"
    if save is not None:
        how = f"go on with: handeye catch --learner {save} --save {save}"
    said = escape(f"with {left:,} trials left to practise; {how}")
    err().print(f"[yellow]stopped[/] {said}", highlight=False, soft_wrap=True)


@contextmanager
def _stoppable() -> Generator[Callable[[], bool]]:
    """Says whether Ctrl-C was pressed: the portion under way is finished, unless pressed again."""
    pressed: list[int] = []

    def remember(number: int, _frame: Any) -> None:
        pressed.append(number)
        signal.signal(signal.SIGINT, before)

    before = signal.signal(signal.SIGINT, remember)
    try:
        yield lambda: bool(pressed)
    finally:
        signal.signal(signal.SIGINT, before)
