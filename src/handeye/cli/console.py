"""What every command prints with: one console for results, one for everything else."""

import json
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table
from typer import Exit
from typer.core import TyperGroup

from handeye.errors import HandeyeError, InvalidInput, MissingExtra
from handeye.io.files import replace_file

MISUSE = 2
"""Exit code when the input cannot be used."""


def out() -> Console:
    """Results: standard output as it is at this moment."""
    return Console()


def err() -> Console:
    """Progress, notes and errors: standard error."""
    return Console(stderr=True)


class ErrorsForPeople(TyperGroup):
    """Commands whose deliberate errors end in a message, not a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command; a HandeyeError or a file error is printed and ends it with code 2."""
        try:
            return super().invoke(ctx)
        except HandeyeError as error:
            message = str(error)
        except OSError as error:
            if error.filename is None:
                raise
            message = f"{error.filename}: cannot be read or written ({error.strerror})"
        err().print(f"[bold red]error[/] {escape(message)}", soft_wrap=True, highlight=False)
        raise Exit(MISUSE)


def no_page(missing: MissingExtra) -> None:
    """Say why there is no report page; everything else is done without it."""
    err().print(f"[yellow]no page[/] {escape(str(missing))}", highlight=False, soft_wrap=True)


@contextmanager
def progress_bar(description: str, total: int) -> Generator[tuple[Progress, Any]]:
    """A bar on standard error that leaves nothing behind."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=err(), transient=True) as progress:
        yield progress, progress.add_task(description, total=total)


def table(title: str, *columns: str, left: int = 1) -> Table:
    """An empty table: the first `left` columns are text, the others numbers."""
    made = Table(title=title, title_justify="left", title_style="bold", header_style="dim")
    for i, column in enumerate(columns):
        made.add_column(column, justify="left" if i < left else "right", no_wrap=i >= left)
    return made


def check_places(folder: Path | None, *files: str | None) -> None:
    """Before any work: whether results can go where they are wanted.

    A folder for results is made when they are written; a file must lie in a folder that exists.

    Raises:
        InvalidInput: naming the place and what is wrong with it.
    """
    if folder is not None:
        above = next(place for place in (folder, *folder.absolute().parents) if place.exists())
        if not above.is_dir():
            raise InvalidInput(
                f"{folder}: cannot be read or written ({above} is a file): choose another folder"
            )
    for file in files:
        if file is None or file == "-":
            continue
        place = Path(file)
        if place.is_dir():
            raise InvalidInput(f"{file}: is a folder: give the name of a file")
        if not place.absolute().parent.is_dir():
            raise InvalidInput(
                f"{file}: there is no folder {place.parent}: make it, or choose another place"
            )


def write_json(data: Any, where: str) -> None:
    """JSON to a file, or to standard output for "-"."""
    text = json.dumps(data, indent=2)
    if where == "-":
        print(text)  # noqa: T201 (the result itself, which rich would wrap and colour)
        return
    replace_file(where, (text + "\n").encode())
    err().print(f"wrote {escape(str(Path(where)))}")
